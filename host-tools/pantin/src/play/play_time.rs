//! Which frame is due: by the time since an anchor, so that it never drifts, at any speed, forward or back.

use std::time::Duration;

/// Speeds are powers of two, from an 8th to 8.
const SPEEDS: std::ops::RangeInclusive<i32> = -3..=3;

/// A clip's own time, driven by the time since the program began. Counts on over the clip's end: loops are the caller's.
#[derive(Clone, Debug)]
pub struct PlayTime {
    /// Nanoseconds of a frame.
    frame_time: i128,
    /// Speed is 2 to this power.
    speed: i32,
    reversed: bool,
    paused: bool,
    /// The clip's time in nanoseconds at a time of the program.
    anchor: (i128, Duration),
}

impl PlayTime {
    /// Begins at frame 0, at the clip's own rate.
    pub fn new(frame_time_ns: u32, now: Duration) -> PlayTime {
        PlayTime { frame_time: i128::from(frame_time_ns.max(1)), speed: 0, reversed: false, paused: false, anchor: (0, now) }
    }

    /// The same for another clip: from its begin, at the same speed.
    pub fn restart(&mut self, frame_time_ns: u32, now: Duration) {
        self.frame_time = i128::from(frame_time_ns.max(1));
        self.anchor = (if self.reversed { -1 } else { 0 }, now);
    }

    fn time(&self, now: Duration) -> i128 {
        let (time, since) = self.anchor;
        let passed = now.saturating_sub(since).as_nanos() as i128;
        let passed = if self.paused { 0 } else { (passed << (self.speed + 3)) >> 3 };
        if self.reversed { time - passed } else { time + passed }
    }

    /// The frame that is due, counted on over ends: negative before the first one.
    pub fn frame(&self, now: Duration) -> i64 {
        self.time(now).div_euclid(self.frame_time) as i64
    }

    /// Time until another frame is due, at most 7 ns too long; none while it is paused.
    pub fn until_next(&self, now: Duration) -> Option<Duration> {
        let place = self.time(now).rem_euclid(self.frame_time);
        // Backwards a frame ends before its first nanosecond.
        let left = if self.reversed { place + 1 } else { self.frame_time - place };
        let nanoseconds = ((left << 3) + (1 << (self.speed + 3)) - 1) >> (self.speed + 3);
        (!self.paused).then(|| Duration::from_nanos(nanoseconds as u64))
    }

    fn hold(&mut self, now: Duration) {
        self.anchor = (self.time(now), now);
    }

    /// Pauses, or goes on.
    pub fn pause(&mut self, now: Duration) {
        self.hold(now);
        self.paused = !self.paused;
    }

    /// Pauses, and moves by a number of frames.
    pub fn step(&mut self, frames: i64, now: Duration) {
        // In the frame's middle, so that going on shows it for a while in either direction.
        let time = (i128::from(self.frame(now) + frames) * 2 + 1) * self.frame_time / 2;
        self.anchor = (time, now);
        self.paused = true;
    }

    /// Turns the direction.
    pub fn reverse(&mut self, now: Duration) {
        self.hold(now);
        self.reversed = !self.reversed;
    }

    /// Doubles the speed N times; negative halves it.
    pub fn change_speed(&mut self, doublings: i32, now: Duration) {
        self.hold(now);
        self.speed = (self.speed + doublings).clamp(*SPEEDS.start(), *SPEEDS.end());
    }

    /// Whether it is paused.
    pub fn paused(&self) -> bool {
        self.paused
    }

    /// Whether it runs backwards.
    pub fn reversed(&self) -> bool {
        self.reversed
    }

    /// As in `x1/2`.
    pub fn speed(&self) -> String {
        let times = 1 << self.speed.abs();
        if self.speed < 0 { format!("x1/{times}") } else { format!("x{times}") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: u32 = 8_333_333;

    fn ms(milliseconds: u64) -> Duration {
        Duration::from_millis(milliseconds)
    }

    #[test]
    fn a_frame_is_due_by_the_clips_rate_however_often_it_is_asked() {
        let mut clock = PlayTime::new(FRAME, ms(5));
        assert_eq!([5, 13, 14, 1005].map(|now| clock.frame(ms(now))), [0, 0, 1, 120]);
        // An hour of questions and of changes that cancel each other: not a frame off.
        for second in 1..3600 {
            clock.change_speed(1, ms(5 + second * 1000));
            clock.change_speed(-1, ms(5 + second * 1000));
        }
        assert_eq!(clock.frame(Duration::from_secs(3600) + ms(5)), 3_600_000_000_000 / i64::from(FRAME));
    }

    #[test]
    fn the_next_frame_is_due_when_it_says_so() {
        for (speed, reversed) in [(0, false), (3, false), (-3, false), (0, true), (-2, true), (2, true)] {
            let mut clock = PlayTime::new(FRAME, ms(0));
            clock.change_speed(speed, ms(0));
            if reversed {
                clock.reverse(ms(0));
            }
            let mut now = Duration::from_nanos(1);
            for _ in 0..50 {
                let left = clock.until_next(now).unwrap();
                let frame = clock.frame(now);
                assert_eq!(clock.frame(now + left), if reversed { frame - 1 } else { frame + 1 });
                let before = (now + left).saturating_sub(Duration::from_nanos(8)).max(now);
                assert_eq!(clock.frame(before), frame, "{speed} {reversed}");
                now += left;
            }
        }
    }

    #[test]
    fn pausing_stepping_and_reversing_keep_the_place() {
        let mut clock = PlayTime::new(10_000_000, ms(0));
        clock.pause(ms(25));
        assert_eq!((clock.frame(ms(900)), clock.until_next(ms(900))), (2, None));
        clock.step(-1, ms(900));
        assert_eq!(clock.frame(ms(900)), 1);
        clock.step(-3, ms(900));
        assert_eq!(clock.frame(ms(900)), -2);
        clock.pause(ms(1000));
        assert_eq!((clock.frame(ms(1004)), clock.frame(ms(1006))), (-2, -1));
        clock.reverse(ms(1006));
        assert_eq!((clock.frame(ms(1006)), clock.frame(ms(1008))), (-1, -2));
    }

    #[test]
    fn speed_has_ends() {
        let mut clock = PlayTime::new(FRAME, ms(0));
        assert_eq!(clock.speed(), "x1");
        (0..9).for_each(|_| clock.change_speed(1, ms(0)));
        assert_eq!(clock.speed(), "x8");
        (0..9).for_each(|_| clock.change_speed(-1, ms(0)));
        assert_eq!(clock.speed(), "x1/8");
    }
}
