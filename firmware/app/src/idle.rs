//! What a board shows while nobody gives commands: one clip after the other, the name of each at its beginning, and a dark display after ten minutes.

/// A clip is left at the end of the round in which this time is over.
const STAY_MS: u32 = 10_000;
/// A clip that a person looks at is not left before this time without a command.
const PRESENCE_MS: u32 = 60_000;
/// Name and size of a clip are on the display for this time.
const CAPTION_MS: u32 = 2_000;
/// The display is dark from this time without a command on.
const DARK_MS: u32 = 600_000;

const NS_PER_MS: u32 = 1_000_000;

/// The time since the last command, and since the clip began.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Idle {
    /// Milliseconds since the last command, or since the start; they stop at the greatest number.
    quiet: u32,
    /// Milliseconds since the clip began.
    playing: u32,
    /// Nanoseconds of a millisecond that is not over.
    rest: u32,
    /// Whether there was a command.
    touched: bool,
    /// Whether another clip played before.
    moved_on: bool,
    /// Whether the display stays lit.
    pub awake: bool,
    /// Whether there is another clip, which follows while nobody gives commands.
    pub several: bool,
}

impl Idle {
    /// At the start of the program. `awake` keeps the display lit.
    pub const fn new(awake: bool) -> Idle {
        Idle { quiet: 0, playing: 0, rest: 0, touched: false, moved_on: false, awake, several: false }
    }

    /// Another clip begins, or the same one again.
    pub fn begin_clip(&mut self) {
        self.playing = 0;
        self.moved_on = true;
    }

    /// Time passes.
    pub fn pass(&mut self, ticks: u32, tick_ns: u32) {
        for _ in 0..ticks {
            // Below 2^32: a tick is at most 4.29 seconds, and is cut by less than a millisecond.
            let ns = (tick_ns.min(u32::MAX - NS_PER_MS)) + self.rest;
            self.rest = ns % NS_PER_MS;
            let ms = ns / NS_PER_MS;
            self.quiet = self.quiet.saturating_add(ms);
            self.playing = self.playing.saturating_add(ms);
        }
    }

    /// A person gives a command. Returns whether it is carried out: with a dark display it only lights it.
    pub fn touch(&mut self) -> bool {
        let carried_out = !self.is_dark();
        self.quiet = 0;
        self.touched = true;
        carried_out
    }

    /// Whether the person who gave the last command has left.
    pub fn is_alone(&self) -> bool {
        self.quiet >= PRESENCE_MS
    }

    /// Whether the display is dark.
    pub fn is_dark(&self) -> bool {
        !self.awake && self.quiet >= DARK_MS
    }

    /// Whether the clip, which has come to its end, is left for the next one.
    pub fn is_over(&self) -> bool {
        self.several && self.playing >= STAY_MS && (!self.touched || self.is_alone())
    }

    /// Whether name and size are shown: not of the first clip, with which a program begins that may have no other.
    pub fn has_caption(&self) -> bool {
        self.moved_on && self.playing < CAPTION_MS
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME_NS: u32 = 33_333_333;

    #[test]
    fn clips_follow_one_another_unless_somebody_is_there() {
        let mut idle = Idle { several: true, ..Idle::new(false) };
        assert!(!idle.has_caption());
        idle.pass(299, FRAME_NS);
        assert!(!idle.is_over());
        idle.pass(2, FRAME_NS);
        assert!(idle.is_over());
        idle.begin_clip();
        assert!(!idle.is_over() && idle.has_caption());
        idle.pass(61, FRAME_NS);
        assert!(!idle.has_caption());
        assert!(idle.touch());
        idle.pass(1799, FRAME_NS);
        assert!(!idle.is_over());
        idle.pass(2, FRAME_NS);
        assert!(idle.is_over());
    }

    #[test]
    fn the_display_gets_dark_and_the_first_command_lights_it() {
        let (mut idle, mut awake) = (Idle { several: true, ..Idle::new(false) }, Idle::new(true));
        for idle in [&mut idle, &mut awake] {
            idle.pass(18_001, FRAME_NS);
        }
        assert!(idle.is_dark() && !awake.is_dark());
        assert!(!idle.touch() && awake.touch());
        assert!(!idle.is_dark() && idle.touch());
        // No time is too long.
        idle.pass(3, u32::MAX);
        (idle.quiet, idle.playing) = (u32::MAX - 1, u32::MAX - 1);
        idle.pass(1, u32::MAX);
        assert!(idle.is_dark() && idle.is_over());
    }
}
