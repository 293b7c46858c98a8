//! What is on: which clip, from where it is seen, how fast it plays.

use crate::keys::Key;
use crate::options::Options;
use pantin_figure::{Look, Track, View};

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
pub(crate) struct Scene {
    pub view: View,
    /// The view from which a face is seen straight ahead: the usual one, but where degrees were asked for, those of the face are meant.
    #[cfg(feature = "face")]
    pub ahead: View,
    pub look: Look,
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
pub(crate) enum Wish {
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

impl Scene {
    pub fn new(options: &Options) -> Scene {
        let view = View { orbit: options.orbit.unwrap_or(View::default().orbit), ..View::default() };
        let look = Look { smooth: options.smooth, ..Look::default() };
        Scene {
            view,
            #[cfg(feature = "face")]
            ahead: View { orbit: options.orbit.map_or(View::default().orbit, |_| 0), ..View::default() },
            look,
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
    pub fn take(&mut self, key: Key) -> Wish {
        match key {
            Key::Pause => self.paused = !self.paused,
            Key::Step | Key::Back => {
                self.paused = true;
                return Wish::Move(if key == Key::Step { 1 } else { -1 });
            }
            Key::Reverse => self.backwards = !self.backwards,
            Key::NextClip => return Wish::Clip(1),
            Key::PreviousClip => return Wish::Clip(-1),
            Key::Faster | Key::Slower => {
                let change = if key == Key::Faster { 1 } else { -1 };
                self.pace = (self.pace + change).clamp(*PACES.start(), *PACES.end());
                return Wish::Pace;
            }
            Key::OrbitLeft | Key::OrbitRight => {
                let change = if key == Key::OrbitRight { 15 } else { -15 };
                self.view.orbit = turned(self.view.orbit + change);
                return Wish::Aim;
            }
            Key::TiltUp | Key::TiltDown => {
                let change = if key == Key::TiltUp { 5 } else { -5 };
                self.view.tilt = (self.view.tilt + change).clamp(-30, 85);
                return Wish::Aim;
            }
            Key::View => {
                let at = VIEWS.iter().position(|orbit| *orbit == self.view.orbit);
                self.view.orbit = VIEWS[at.map_or(0, |at| (at + 1) % VIEWS.len())];
                return Wish::Aim;
            }
            Key::Track => {
                self.view.track = if self.view.track == Track::Follow { Track::Fixed } else { Track::Follow };
                return Wish::Aim;
            }
            Key::Ground => self.look.ground = !self.look.ground,
            Key::Smooth => self.look.smooth = !self.look.smooth,
            Key::Hud => self.hud = !self.hud,
            Key::Help => return Wish::Help,
        }
        Wish::Nothing
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
        let mut scene = Scene::new(&Options::parse([]));
        let start = scene.view.orbit;
        for _ in 0..24 {
            assert_eq!(scene.take(Key::OrbitLeft), Wish::Aim);
            assert!((-180..180).contains(&scene.view.orbit));
        }
        assert_eq!(scene.view.orbit, start);
        for _ in 0..VIEWS.len() {
            scene.take(Key::View);
        }
        assert_eq!(scene.view.orbit, start);
        (0..9).for_each(|_| assert_eq!(scene.take(Key::Slower), Wish::Pace));
        assert_eq!(scene.tick_ns(1000), 8000);
        (0..9).for_each(|_| assert_eq!(scene.take(Key::Faster), Wish::Pace));
        assert_eq!(scene.tick_ns(1000), 125);
        scene.take(Key::Reverse);
        assert_eq!(scene.frames(3), -3);
        assert_eq!(scene.take(Key::Back), Wish::Move(-1));
        assert_eq!(scene.frames(3), 0);
    }
}
