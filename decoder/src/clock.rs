//! Playing by time: which frame is due, at any display rate and speed.

use crate::Clip;
use fixed::types::{I16F16, U0F16};

/// Turns elapsed time into frames of a clip, at any display rate and at speeds of -16 to 16, without drift: it counts in
/// 2^-16 ns.
///
/// A loop continues for ever (`ended` never becomes true), each time from its first frame's place. Another clip stops after its last frame, or backwards before frame 0, and [`Clock::ended`] says so.
///
/// ```
/// # fn show(_: pantin::Pose) {}
/// # fn play(player: &mut pantin::Player, elapsed_us: impl Fn() -> u32) {
/// let mut clock = pantin::Clock::new(player.clip());
/// while !clock.ended() {
///     show(player.pose());
///     player.advance(&mut clock, elapsed_us());
/// }
/// # }
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clock {
    /// Nanoseconds after frame 0, and 2^-16 of them.
    at_ns: i64,
    rest: u16,
    speed: I16F16,
    frame_time_ns: u32,
    frames: u32,
    looped: bool,
    ended: bool,
}

impl Clock {
    /// A clock at frame 0 of a clip, at speed 1.
    pub fn new(clip: &Clip<'_>) -> Clock {
        Clock {
            at_ns: 0,
            rest: 0,
            speed: I16F16::ONE,
            frame_time_ns: clip.frame_time_ns(),
            frames: clip.frames(),
            looped: clip.looped(),
            ended: false,
        }
    }

    /// Plays at a speed of -16 to 16 from here on (others are cut off); 1 is the clip's own, less than 0 is backwards.
    pub fn set_speed(&mut self, speed: I16F16) {
        self.speed = speed.clamp(I16F16::lit("-16"), I16F16::lit("16"));
        self.ended = false;
    }

    /// The speed.
    pub fn speed(&self) -> I16F16 {
        self.speed
    }

    /// Goes to the start of a frame, of the last one if there are fewer.
    pub fn seek(&mut self, frame: u32) {
        // Below 2^24 times 2^32.
        self.at_ns = i64::from(frame.min(self.frames - 1)) * i64::from(self.frame_time_ns);
        (self.rest, self.ended) = (0, false);
    }

    /// Goes on by a time.
    pub fn advance(&mut self, elapsed_us: u32) {
        // Below 2^42 times 2^20 in magnitude.
        let moved = i64::from(elapsed_us) * 1000 * i64::from(self.speed.to_bits()) + i64::from(self.rest);
        self.rest = moved as u16;
        // Below 2^56 + 2^46.
        let at_ns = self.at_ns + (moved >> 16);
        let frame_time_ns = i64::from(self.frame_time_ns);
        if self.looped {
            self.at_ns = at_ns.checked_rem_euclid(i64::from(self.frames) * frame_time_ns).unwrap_or(0);
        } else {
            // The last frame is shown for its time too.
            let end = i64::from(self.frames) * frame_time_ns;
            self.at_ns = at_ns.clamp(0, end - 1);
            self.ended = at_ns < 0 || at_ns >= end;
        }
    }

    /// The frame that is due.
    pub fn frame(&self) -> u32 {
        self.at_ns.checked_div(self.frame_time_ns.into()).unwrap_or(0) as u32
    }

    /// How far time is on the way from that frame to the next one: what [`crate::Player::interpolate`] takes. From the last frame
    /// of a loop it is the way to frame 0; another clip's last frame has no next one, and the part is 0.
    pub fn part(&self) -> U0F16 {
        if !self.looped && self.frame() + 1 >= self.frames {
            return U0F16::ZERO;
        }
        let within = self.at_ns.checked_rem(self.frame_time_ns.into()).unwrap_or(0);
        U0F16::from_bits((within << 16).checked_div(self.frame_time_ns.into()).unwrap_or(0) as u16)
    }

    /// Whether a clip that is no loop has come to its end.
    pub fn ended(&self) -> bool {
        self.ended
    }
}
