//! What is on: which clip, from where it is seen, how fast it plays.

use crate::commands::Command;
use crate::options::Options;
use pantin_figure::{DrawStyle, Track, View};

/// A clip and what it is called.
#[derive(Clone, Copy, Debug)]
pub struct Entry<'a> {
    /// Shown on the display.
    pub name: &'a str,
    /// The clip's file.
    pub bytes: &'a [u8],
}

/// The state that keys change and that outlives a clip.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ViewState {
    pub view: View,
    /// The view from which a face is seen straight ahead: the usual one, but where degrees were asked for, those of the face are meant.
    #[cfg(feature = "face")]
    pub ahead: View,
    pub style: DrawStyle,
    pub paused: bool,
    /// Frames run backwards.
    pub backwards: bool,
    /// 2^pace times the clip's own speed.
    pub pace: i8,
    pub hud: bool,
    /// What is played comes over the line.
    #[cfg(feature = "link")]
    pub link: bool,
    /// Its packets have parity.
    #[cfg(feature = "link")]
    pub fec: bool,
}

/// What a key asks of the player.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Effect {
    /// Nothing: the scene has changed.
    Nothing,
    /// The camera must be set up anew.
    Aim,
    /// The timer must.
    Pace,
    /// So many frames on, or back.
    Move(i32),
    /// So many clips on, or back.
    Clip(i32),
    /// The list of letters.
    Help,
}

/// Greatest and least pace.
const PACES: core::ops::RangeInclusive<i8> = -3..=3;
/// Degrees about the figure that the view key goes through: three quarters, front, side, from behind.
const VIEWS: [i16; 4] = [-50, 0, -90, 140];

impl ViewState {
    pub fn new(options: &Options) -> ViewState {
        let view = View { orbit: options.orbit.unwrap_or(View::default().orbit), ..View::default() };
        let style = DrawStyle { smooth: options.smooth, ..DrawStyle::default() };
        ViewState {
            view,
            #[cfg(feature = "face")]
            ahead: View { orbit: options.orbit.map_or(View::default().orbit, |_| 0), ..View::default() },
            style,
            paused: false,
            backwards: false,
            pace: 0,
            hud: options.hud,
            #[cfg(feature = "link")]
            link: options.link,
            #[cfg(feature = "link")]
            fec: options.fec,
        }
    }

    /// Takes a key.
    pub fn take(&mut self, key: Command) -> Effect {
        match key {
            Command::Pause => self.paused = !self.paused,
            Command::Step | Command::Back => {
                self.paused = true;
                return Effect::Move(if key == Command::Step { 1 } else { -1 });
            }
            Command::Reverse => self.backwards = !self.backwards,
            Command::NextClip => return Effect::Clip(1),
            Command::PreviousClip => return Effect::Clip(-1),
            Command::Faster | Command::Slower => {
                let change = if key == Command::Faster { 1 } else { -1 };
                self.pace = (self.pace + change).clamp(*PACES.start(), *PACES.end());
                return Effect::Pace;
            }
            Command::OrbitLeft | Command::OrbitRight => {
                let change = if key == Command::OrbitRight { 15 } else { -15 };
                self.view.orbit = turned(self.view.orbit + change);
                return Effect::Aim;
            }
            Command::TiltUp | Command::TiltDown => {
                let change = if key == Command::TiltUp { 5 } else { -5 };
                self.view.tilt = (self.view.tilt + change).clamp(-30, 85);
                return Effect::Aim;
            }
            Command::View => {
                let at = VIEWS.iter().position(|orbit| *orbit == self.view.orbit);
                self.view.orbit = VIEWS[at.map_or(0, |at| (at + 1) % VIEWS.len())];
                return Effect::Aim;
            }
            Command::Track => {
                self.view.track = if self.view.track == Track::Follow { Track::Fixed } else { Track::Follow };
                return Effect::Aim;
            }
            Command::Ground => self.style.ground = !self.style.ground,
            Command::Smooth => self.style.smooth = !self.style.smooth,
            Command::Hud => self.hud = !self.hud,
            Command::Help => return Effect::Help,
        }
        Effect::Nothing
    }

    /// Frames on for so many ticks of the timer.
    pub fn frames(&self, ticks: u32) -> i32 {
        match (self.paused, self.backwards) {
            (true, _) => 0,
            (false, false) => ticks as i32,
            (false, true) => -(ticks as i32),
        }
    }

    /// The timer's pace for a clip's.
    pub fn tick_ns(&self, frame_ns: u32) -> u32 {
        match u32::try_from(self.pace) {
            Ok(faster) => (frame_ns >> faster).max(1),
            Err(_) => frame_ns.saturating_mul(1 << -self.pace),
        }
    }
}

/// Degrees from -180 to 179.
fn turned(degrees: i16) -> i16 {
    (degrees + 540) % 360 - 180
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_go_round_and_stop_at_the_ends() {
        let mut view_state = ViewState::new(&Options::parse([]));
        let start = view_state.view.orbit;
        for _ in 0..24 {
            assert_eq!(view_state.take(Command::OrbitLeft), Effect::Aim);
            assert!((-180..180).contains(&view_state.view.orbit));
        }
        assert_eq!(view_state.view.orbit, start);
        for _ in 0..VIEWS.len() {
            view_state.take(Command::View);
        }
        assert_eq!(view_state.view.orbit, start);
        (0..9).for_each(|_| assert_eq!(view_state.take(Command::Slower), Effect::Pace));
        assert_eq!(view_state.tick_ns(1000), 8000);
        (0..9).for_each(|_| assert_eq!(view_state.take(Command::Faster), Effect::Pace));
        assert_eq!(view_state.tick_ns(1000), 125);
        view_state.take(Command::Reverse);
        assert_eq!(view_state.frames(3), -3);
        assert_eq!(view_state.take(Command::Back), Effect::Move(-1));
        assert_eq!(view_state.frames(3), 0);
    }
}
