//! What commands change, and what outlives a clip: view, drawing style and speed.

use crate::capacity::Style;
use crate::commands::Command;
use crate::idle::Idle;
use crate::options::Options;
use pantin_figure::{CameraTarget, DrawStyle, View};

/// What commands change.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ViewState {
    pub view: View,
    /// The view that shows a face from straight ahead: the default view, so that a face looks at the user at first. With
    /// [`Options::orbit`] it is 0 degrees, so that those degrees are about the face.
    #[cfg(feature = "face")]
    pub ahead: View,
    pub style: Style,
    /// That of [`Options::neck`].
    #[cfg(feature = "neck")]
    pub neck: bool,
    pub paused: bool,
    /// Frames run backwards.
    pub backwards: bool,
    /// Speed, as the power of two of the clip's own.
    pub rate_log2: i8,
    /// Name, frame and speed are on the display.
    pub hud: bool,
    /// The number of the menu's item that is shown, if the menu is open.
    pub menu: Option<usize>,
    /// Since when nobody gave a command.
    pub idle: Idle,
    /// Poses arrive over the serial line.
    #[cfg(feature = "link")]
    pub link: bool,
    /// The link's packets have parity.
    #[cfg(feature = "link")]
    pub fec: bool,
    /// The key of the link's packets.
    #[cfg(feature = "key")]
    pub key: crate::options::Key,
}

/// What is to be done for a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Effect {
    /// Nothing: the next picture shows the change.
    Nothing,
    /// Set the camera up.
    Aim,
    /// Change the timer's period.
    Rate,
    /// Move by a number of frames.
    Move(i32),
    /// Play another clip: this many places further in the list.
    Clip(i32),
    /// Send the list of letters.
    Help,
}

/// Lowest and highest speed: an eighth and eight times the clip's own.
const RATES_LOG2: core::ops::RangeInclusive<i8> = -3..=3;

impl ViewState {
    pub fn new(options: &Options) -> ViewState {
        let view = View { orbit: options.orbit.unwrap_or(View::default().orbit), ..View::default() };
        let style = Style {
            lines: DrawStyle { smooth: options.smooth, ..DrawStyle::default() },
            #[cfg(feature = "solid")]
            solid: options.solid,
            #[cfg(feature = "solid")]
            look: options.look,
        };
        ViewState {
            view,
            #[cfg(feature = "face")]
            ahead: View { orbit: options.orbit.map_or(View::default().orbit, |_| 0), ..View::default() },
            style,
            #[cfg(feature = "neck")]
            neck: options.neck,
            paused: false,
            backwards: false,
            rate_log2: 0,
            hud: options.hud,
            menu: None,
            idle: Idle::new(options.awake),
            #[cfg(feature = "link")]
            link: options.link,
            #[cfg(feature = "link")]
            fec: options.fec,
            #[cfg(feature = "key")]
            key: options.key,
        }
    }

    /// Applies a command, as it is while the menu is closed. Returns what else is to be done for it.
    pub fn apply(&mut self, command: Command) -> Effect {
        match command {
            Command::Pause => self.paused = !self.paused,
            Command::Step | Command::Back => {
                self.paused = true;
                return Effect::Move(if command == Command::Step { 1 } else { -1 });
            }
            Command::Reverse => self.backwards = !self.backwards,
            Command::NextClip => return Effect::Clip(1),
            Command::PreviousClip => return Effect::Clip(-1),
            Command::Faster | Command::Slower => {
                let change = if command == Command::Faster { 1 } else { -1 };
                self.rate_log2 = (self.rate_log2 + change).clamp(*RATES_LOG2.start(), *RATES_LOG2.end());
                return Effect::Rate;
            }
            Command::OrbitLeft | Command::OrbitRight => {
                let change = if command == Command::OrbitRight { 15 } else { -15 };
                self.view.orbit = wrap_degrees(self.view.orbit + change);
                return Effect::Aim;
            }
            Command::TiltUp | Command::TiltDown => {
                let change = if command == Command::TiltUp { 5 } else { -5 };
                self.view.tilt = (self.view.tilt + change).clamp(-30, 85);
                return Effect::Aim;
            }
            Command::View => {
                self.view.orbit = self.view.next_orbit();
                return Effect::Aim;
            }
            Command::Track => {
                self.view.track =
                    if self.view.track == CameraTarget::Follow { CameraTarget::Fixed } else { CameraTarget::Follow };
                return Effect::Aim;
            }
            Command::Ground => self.style.lines.ground = !self.style.lines.ground,
            Command::Smooth => self.style.lines.smooth = !self.style.lines.smooth,
            #[cfg(feature = "solid")]
            Command::Style => {
                self.style.solid = !self.style.solid;
                return Effect::Aim;
            }
            Command::Hud => self.hud = !self.hud,
            Command::Menu => self.menu = Some(0),
            Command::Help => return Effect::Help,
        }
        Effect::Nothing
    }

    /// Returns the frames to move by after a number of timer ticks.
    pub fn frames(&self, ticks: u32) -> i32 {
        match (self.paused, self.backwards) {
            (true, _) => 0,
            (false, false) => ticks as i32,
            (false, true) => -(ticks as i32),
        }
    }

    /// Returns the timer's period for a clip's frame time.
    pub fn tick_ns(&self, frame_ns: u32) -> u32 {
        match u32::try_from(self.rate_log2) {
            Ok(faster) => (frame_ns >> faster).max(1),
            Err(_) => frame_ns.saturating_mul(1 << -self.rate_log2),
        }
    }
}

/// Returns the same angle from -180 to 179 degrees.
fn wrap_degrees(degrees: i16) -> i16 {
    (degrees + 540) % 360 - 180
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_orbit_wraps_and_the_speed_stops_at_its_limits() {
        let mut view_state = ViewState::new(&Options::parse([]));
        let start = view_state.view.orbit;
        for _ in 0..24 {
            assert_eq!(view_state.apply(Command::OrbitLeft), Effect::Aim);
            assert!((-180..180).contains(&view_state.view.orbit));
        }
        assert_eq!(view_state.view.orbit, start);
        for _ in View::ORBITS {
            view_state.apply(Command::View);
        }
        assert_eq!(view_state.view.orbit, start);
        (0..9).for_each(|_| assert_eq!(view_state.apply(Command::Slower), Effect::Rate));
        assert_eq!(view_state.tick_ns(1000), 8000);
        (0..9).for_each(|_| assert_eq!(view_state.apply(Command::Faster), Effect::Rate));
        assert_eq!(view_state.tick_ns(1000), 125);
        view_state.apply(Command::Reverse);
        assert_eq!(view_state.frames(3), -3);
        assert_eq!(view_state.apply(Command::Back), Effect::Move(-1));
        assert_eq!(view_state.frames(3), 0);
    }
}
