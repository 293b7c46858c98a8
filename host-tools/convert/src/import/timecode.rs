//! SMPTE timecode with a fraction of a frame, as Live Link Face writes it: `19:16:29:35.273`.

/// What FF counts to, a second.
const RATES: [u32; 5] = [24, 25, 30, 50, 60];
/// The rate of a recording that is too short to tell.
pub const DEFAULT_RATE: u32 = 60;
/// NTSC runs slower than its timecode's numbers say by this.
pub const NTSC: f64 = 1.001;

/// One timecode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timecode {
    minute: u32,
    second: u32,
    frame: f64,
    /// Whether `;` stands before the frames, which marks numbers that skip some each minute.
    marked: bool,
}

impl Timecode {
    /// Reads `HH:MM:SS:FF` with a fraction behind or none; `None` for anything else.
    pub fn parse(text: &[u8]) -> Option<Timecode> {
        let text = std::str::from_utf8(text).ok()?;
        let at = text.rfind([':', ';'])?;
        let (clock, frame) = (&text[..at], &text[at + 1..]);
        let digits = |word: &str| word.bytes().all(|byte| byte.is_ascii_digit());
        let frame = frame.parse::<f64>().ok().filter(|_| digits(&frame.replacen('.', "", 1)))?;
        let mut parts = clock.split([':', ';']).map(|part| part.parse::<u32>().ok().filter(|_| digits(part)));
        let (hour, minute, second) = (parts.next()??, parts.next()??, parts.next()??);
        let real = hour < 24 && minute < 60 && second < 60 && frame < 60.0 && parts.next().is_none();
        real.then(|| Timecode { minute: hour * 60 + minute, second, frame, marked: text.as_bytes()[at] == b';' })
    }
}

/// How a recording's timecodes count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimecodeCount {
    /// What FF counts to, a second.
    pub rate: u32,
    /// Whether numbers are skipped each minute, so that they keep up with NTSC's time.
    pub drop_frame: bool,
    /// Whether the recording is too short to tell the rate.
    pub guessed: bool,
}

impl TimecodeCount {
    /// The clock that wrote `codes`: FF comes near the rate before each new second.
    pub fn of(codes: &[Timecode]) -> TimecodeCount {
        let rolls = codes.windows(2).any(|pair| pair[0].second != pair[1].second);
        let most = codes.iter().fold(0, |most, code| most.max(code.frame as u32));
        let above = RATES.into_iter().find(|&rate| rate > most).unwrap_or(DEFAULT_RATE);
        let rate = if rolls { above } else { DEFAULT_RATE };
        let clock = TimecodeCount { rate, drop_frame: false, guessed: !rolls };
        TimecodeCount { drop_frame: clock.skips(codes), ..clock }
    }

    /// Numbers that drop-frame timecode skips at each minute but the tenths.
    fn skipped(&self) -> u32 {
        self.rate / 15
    }

    /// Whether `codes` say that they skip, or skip just these numbers at each minute that they come through.
    fn skips(&self, codes: &[Timecode]) -> bool {
        if !self.rate.is_multiple_of(30) {
            return false;
        }
        let crossing = |pair: &&[Timecode]| pair[1].minute == pair[0].minute + 1 && !pair[1].minute.is_multiple_of(10);
        let mut crossings = codes.windows(2).filter(crossing).peekable();
        let usual = 1.0 + f64::from(self.skipped());
        let skips = |pair: &[Timecode]| (self.plain(&pair[1]) - self.plain(&pair[0]) - usual).abs() < 0.5;
        codes.iter().any(|code| code.marked) || (crossings.peek().is_some() && crossings.all(skips))
    }

    fn plain(&self, code: &Timecode) -> f64 {
        f64::from((code.minute * 60 + code.second) * self.rate) + code.frame
    }

    /// Frames from midnight.
    pub fn count(&self, code: &Timecode) -> f64 {
        let skipped = if self.drop_frame { self.skipped() * (code.minute - code.minute / 10) } else { 0 };
        self.plain(code) - f64::from(skipped)
    }

    /// Frames of a day.
    pub fn day(&self) -> f64 {
        let skipped = if self.drop_frame { self.skipped() * (1440 - 144) } else { 0 };
        f64::from(86400 * self.rate - skipped)
    }

    /// Frames counted a second of real time.
    pub fn real_rate(&self) -> f64 {
        f64::from(self.rate) / if self.drop_frame { NTSC } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn codes(texts: &[&str]) -> Vec<Timecode> {
        texts.iter().map(|text| Timecode::parse(text.as_bytes()).unwrap()).collect()
    }

    #[test]
    fn only_timecodes_are_read() {
        let code = Timecode::parse(b"19:16:29:35.273").unwrap();
        assert_eq!((code.minute, code.second, code.frame, code.marked), (1156, 29, 35.273, false));
        assert!(Timecode::parse(b"01:02:03;04").unwrap().marked);
        for bad in [
            "",
            "1:2:3",
            "24:00:00:00",
            "00:60:00:00",
            "00:00:60:00",
            "00:00:00:60",
            "00:00:00:-1",
            "00:00:00:1e1",
            "00:00:00:nan",
            "+1:00:00:00",
            "1:0:0:0:0",
            "0.035",
            // An hour whose minutes do not fit: found by fuzzing.
            "280100023:59:59;29",
        ] {
            assert_eq!(Timecode::parse(bad.as_bytes()), None, "{bad}");
        }
    }

    #[test]
    fn the_rate_is_what_frames_count_to() {
        assert_eq!(TimecodeCount::of(&codes(&["00:00:00:29", "00:00:01:00"])).rate, 30);
        assert_eq!(TimecodeCount::of(&codes(&["00:00:00:58.9", "00:00:01:00"])).rate, 60);
        let short = TimecodeCount::of(&codes(&["00:00:00:10", "00:00:00:11"]));
        assert!(short.guessed && short.rate == 60);
    }

    #[test]
    fn skipped_numbers_are_no_frames() {
        let codes = codes(&["00:00:58:00", "00:00:59:59", "00:01:00:04", "00:01:00:05"]);
        let clock = TimecodeCount::of(&codes);
        assert!(clock.drop_frame);
        assert_eq!(clock.count(&codes[2]) - clock.count(&codes[1]), 1.0);
        assert!((clock.day() / clock.real_rate() - 86399.9136).abs() < 1e-6);
        assert!(!TimecodeCount::of(&codes[..2]).drop_frame);
    }
}
