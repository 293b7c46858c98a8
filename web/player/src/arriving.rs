//! A clip of which only the front is there. One stream runs ahead and tells how far it can be played; the other one shows a frame.

use crate::facts::Trouble;
use crate::memory::{Who, seat};
use pantin::layout::{HAS_RIG, MAGIC, MAX_JOINTS, VERSION};
use pantin::{Rig, Step, Stream};

/// The rig at the front of a file: `None` while it has not come.
pub fn rig(file: &'static [u8]) -> Result<Option<Rig<'static>>, Trouble> {
    if !MAGIC.starts_with(file.get(..2).unwrap_or(file)) {
        return Err(Trouble::Magic);
    }
    let [_, _, version, flags, rest @ ..] = file else { return Ok(None) };
    if *version != VERSION {
        return Err(Trouble::Version);
    }
    if flags & HAS_RIG == 0 {
        return Err(Trouble::Rig);
    }
    let (mut len, mut shift) = (0, 0);
    for (at, byte) in rest.iter().enumerate() {
        if shift > 21 {
            return Err(Trouble::Malformed);
        }
        len |= usize::from(byte & 0x7f) << shift;
        shift += 7;
        if byte & 0x80 == 0 {
            let bytes = rest.get(at + 1..).and_then(|rest| rest.get(..len));
            return Ok(bytes.map(Rig::new_checked).transpose()?);
        }
    }
    Ok(None)
}

/// A stream and how much it was fed.
struct Feed {
    stream: Stream<'static, 'static>,
    fed: usize,
    /// Frames that it has shown or gone past.
    shown: u32,
}

impl Feed {
    /// # Safety
    /// As of [`seat`].
    unsafe fn new(rig: Rig<'static>, who: Who) -> Result<Feed, Trouble> {
        // SAFETY: the caller's promise.
        let seat = unsafe { seat(who) };
        Ok(Feed { stream: Stream::new(rig, &mut seat.window, &mut seat.states, &mut seat.pose)?, fed: 0, shown: 0 })
    }

    /// Goes on until `until` frames are shown, or as far as the file reaches; `opened` is called when the head has been read.
    fn run(&mut self, file: &[u8], until: u32, mut opened: impl FnMut(&Stream)) -> Result<(), Trouble> {
        while self.shown < until {
            match self.stream.step() {
                Step::Frame => self.shown += 1,
                Step::End => return Ok(()),
                Step::Opened => opened(&self.stream),
                Step::Event(_) => {}
                Step::Damaged(error) => return Err(error.into()),
                Step::TooSmall => return Err(Trouble::TooBig),
                Step::NeedMore => {
                    let taken = self.stream.feed(file.get(self.fed..).unwrap_or(&[]));
                    self.fed += taken;
                    if taken == 0 {
                        return Ok(());
                    }
                }
            }
        }
        Ok(())
    }
}

/// Both streams.
pub struct Arriving {
    pub rig: Rig<'static>,
    file: &'static [u8],
    scout: Feed,
    shown: Feed,
    /// A bit a joint: whether the clip codes it as an exponential map.
    exponentials: [u32; MAX_JOINTS.div_ceil(32)],
}

impl Arriving {
    /// To be made once.
    pub fn new(rig: Rig<'static>) -> Result<Arriving, Trouble> {
        // SAFETY: this is made once, so nobody has sat there.
        let (scout, shown) = unsafe { (Feed::new(rig, Who::Scout)?, Feed::new(rig, Who::Shown)?) };
        Ok(Arriving { rig, file: &[], scout, shown, exponentials: [0; MAX_JOINTS.div_ceil(32)] })
    }

    /// Takes a longer front of the file.
    pub fn extend(&mut self, file: &'static [u8]) -> Result<(), Trouble> {
        self.file = file;
        let (joints, exponentials) = (self.rig.joint_count(), &mut self.exponentials);
        self.scout.run(file, u32::MAX, |stream| {
            for joint in 0..joints {
                if let (Some(true), Some(word)) = (stream.is_exponential(joint), exponentials.get_mut(joint / 32)) {
                    *word |= 1 << (joint % 32);
                }
            }
        })
    }

    pub fn is_exponential(&self, joint: usize) -> bool {
        self.exponentials.get(joint / 32).is_some_and(|word| word >> (joint % 32) & 1 != 0)
    }

    /// Frames that can be shown.
    pub fn playable(&self) -> u32 {
        self.scout.shown
    }

    /// What the head says: the stream that has read it.
    pub fn head(&self) -> &Stream<'static, 'static> {
        &self.scout.stream
    }

    /// Shows a frame that is playable.
    pub fn go(&mut self, frame: u32) -> &[i32] {
        if frame + 1 < self.shown.shown {
            // SAFETY: the feed that sat there is overwritten by the new one, and not used in between. The rig fitted before.
            if let Ok(again) = unsafe { Feed::new(self.rig, Who::Shown) } {
                self.shown = again;
            }
        }
        // It was gone through once without trouble.
        let _ = self.shown.run(self.file, frame + 1, |_| {});
        self.shown.stream.pose()
    }

    /// The frame that is shown.
    pub fn frame(&self) -> u32 {
        self.shown.shown.saturating_sub(1)
    }

    pub fn pose(&self) -> &[i32] {
        self.shown.stream.pose()
    }
}
