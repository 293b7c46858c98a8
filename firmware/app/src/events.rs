//! Events of a clip (footfalls, sounds) that are heard when their frames are shown.

use pantin::Clip;

/// An event whose frame is shown, or was passed since the last picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HeardEvent<'a> {
    /// Its frame.
    pub frame: u32,
    /// Its id in the clip.
    pub id: u32,
    /// Its name, if it has one.
    pub name: Option<&'a str>,
}

impl HeardEvent<'_> {
    /// Writes it as a line of text: `event FRAME NAME`, or the id where it has no name.
    pub fn send(&self, mut send: impl FnMut(&[u8])) {
        send(b"event ");
        number(self.frame, &mut send);
        send(b" ");
        match self.name {
            Some(name) => send(name.as_bytes()),
            None => number(self.id, &mut send),
        }
        send(b"\r\n");
    }
}

/// Sends a number's digits.
fn number(value: u32, send: &mut impl FnMut(&[u8])) {
    if value >= 10 {
        number(value / 10, send);
    }
    send(&[b'0' + (value % 10) as u8]);
}

/// Where the figure was at the last picture.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Since {
    /// Nowhere: this is the first picture.
    Start,
    /// At this frame.
    Frame(u32),
}

/// Calls `heard` for the events of a clip that a move by `frames` frames, or back, passed, in the clip's order, and for those of the frame `shown` at the start.
pub(crate) fn passed(clip: &Clip, since: Since, frames: i32, shown: u32, heard: &mut dyn FnMut(HeardEvent)) {
    let count = clip.frames();
    for event in clip.events() {
        let way = match since {
            Since::Start => u32::from(event.frame != shown),
            Since::Frame(from) => ahead(from, event.frame, frames < 0, count),
        };
        let most = match since {
            Since::Start => 0,
            Since::Frame(_) => frames.unsigned_abs(),
        };
        if way <= most {
            heard(HeardEvent { frame: event.frame, id: event.id, name: clip.event_name(event.id) });
        }
    }
}

/// Frames from one frame to the next time that another is shown: 1 to `count`.
fn ahead(from: u32, to: u32, backwards: bool, count: u32) -> u32 {
    let way = if backwards { from.wrapping_sub(to) } else { to.wrapping_sub(from) } as i32;
    let way = if way <= 0 { way.wrapping_add(count as i32) } else { way };
    way as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_comes_round_again() {
        assert_eq!(ahead(3, 4, false, 10), 1);
        assert_eq!(ahead(3, 3, false, 10), 10);
        assert_eq!(ahead(9, 0, false, 10), 1);
        assert_eq!(ahead(3, 4, true, 10), 9);
        assert_eq!(ahead(0, 9, true, 10), 1);
        assert_eq!(ahead(5, 2, true, 10), 3);
    }
}
