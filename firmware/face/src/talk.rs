//! Lips for speech, in integers: from sound while it is played or recorded, or from visemes that a speech engine names with their times.
//!
//! ```
//! use pantin_face::{MODEL, Model, Weights, talk::Talk};
//!
//! let model = Model::new_checked(MODEL)?;
//! let mut talk = Talk::new(16_000).unwrap();
//! let mut weights = Weights::new();
//! # let samples = [0; 533];
//! talk.push(&samples); // all that was played since the last picture
//! talk.step(33);
//! talk.add_to(&mut weights, &model)?;
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```
//!
//! # How sound becomes weights
//!
//! Samples are averaged to 8 kHz, and six resonators measure what the sound has at 300 to 3200 Hz in hops of 10 ms. A level is the binary logarithm of
//! a band's magnitude. The jaw opens by the level at 650 or 1000 Hz, whichever is higher, against the loudest that was heard: that level is there in open
//! vowels, 9 dB lower in i and u, and 17 dB lower or gone while lips or tongue close the mouth. Which vowel it is, the levels' differences say: 300 Hz
//! against 650 Hz (i and u, or e, aa and o), 1000 against 2200 Hz (e, or aa and o), 300 against 1000 Hz (o, or aa), 1500 against 2200 Hz (u, or i).
//! What has more at 3200 Hz than below 1300 Hz is s. Other consonants close the mouth; their own visemes cannot be told from sound in this way.
//!
//! Noise is the lowest level of the last 0.8 to 1.6 s: what is less than 10.5 dB louder keeps the mouth closed. Noise that begins with the first sample may
//! move the lips for 0.9 s, and by less than a twentieth after that. Weights approach their targets by half, every 10 ms, and by five eighths where they fall.
//!
//! # Speech and emotes
//!
//! A surprised face has an open mouth, which would keep the lips of its speech apart. While it speaks, [`Talk::add_to`] takes away what else moves the units
//! of visemes, such as `open_mouth` and `pucker`, within 0.1 s of the first sound, and gives it back in 0.3 s once there was none for 0.4 s. Brows,
//! eyes and the corners of the mouth keep the emote.
//!
//! A second of 16 kHz takes about 1.6 million instructions on a Cortex-M3, and a [`Talk`] about 350 bytes. `pantin_talk.h` has the same in C, bit for bit.

use crate::error::UnknownName;
use crate::model::Model;
use crate::weights::{FULL_WEIGHT, Weight, Weights};
use heapless::Deque;

/// The names of the weights of [`Talk`], MPEG-4's visemes 1 to 14.
pub const VISEMES: [&str; 14] = [
    "viseme_pp",
    "viseme_ff",
    "viseme_th",
    "viseme_dd",
    "viseme_kk",
    "viseme_ch",
    "viseme_ss",
    "viseme_nn",
    "viseme_rr",
    "viseme_aa",
    "viseme_e",
    "viseme_i",
    "viseme_o",
    "viseme_u",
];

/// Visemes that wait for their time, at most.
pub const WAITING: usize = 16;

/// The lowest rate of sound that [`Talk::new`] takes, in Hz.
pub const LEAST_RATE: u32 = BAND_RATE;

/// The highest rate of sound that [`Talk::new`] takes, in Hz.
pub const MOST_RATE: u32 = 6 * BAND_RATE;

/// The rate of the samples that are measured, and their number in a hop of 10 ms.
const BAND_RATE: u32 = 8000;
const HOP: u8 = 80;

/// The weights go towards their targets once in this time.
const TICK_MS: u32 = 10;

/// The time without samples after which the mouth closes.
const SILENT_MS: u32 = 150;

/// Steps of 10 ms for which speech goes on without a viseme: longer than the gaps of p, b and m.
const GAP: u8 = 40;

/// Noise is the lowest level of at least this number of hops.
const LOWEST_HOPS: u8 = 80;

/// Levels are binary logarithms with 8 bits behind the point: 256 is a factor of two. What is softer than this is silence, a mean magnitude of 11.
const SOFTEST: i32 = 2500;
const LOUDEST: i32 = 8192;
const ABOVE_NOISE: i32 = 448;
const SPEECH_ABOVE_NOISE: i32 = 1200;

/// Each band's resonator: twice the radius of its pole times the cosine of the angle, and the square of the radius, in 512ths. Their middles are at
/// 300, 650, 1000, 1500, 2200 and 3200 Hz.
const RESONATORS: [[i32; 2]; 6] = [[862, 384], [774, 384], [627, 384], [339, 384], [-139, 384], [-655, 320]];

/// 4096 / n.
const RECIPROCALS: [i32; 7] = [0, 4096, 2048, 1365, 1024, 819, 683];

/// Why [`Talk::viseme`] takes no viseme.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum VisemeError {
    /// There are visemes 1 to 14, and 0 for none.
    Unknown,
    /// A viseme that waits begins later.
    Early,
    /// [`WAITING`] visemes wait already.
    Full,
}

impl core::fmt::Display for VisemeError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            VisemeError::Unknown => "visemes are 1 to 14, and 0 for none",
            VisemeError::Early => "a viseme that waits begins later",
            VisemeError::Full => "16 visemes wait already",
        })
    }
}

impl core::error::Error for VisemeError {}

/// A mouth that speaks.
#[derive(Clone, Debug)]
pub struct Talk {
    weights: [u16; 14],
    targets: [u16; 14],
    /// How far speech has the mouth to itself, and the steps for which it goes on if no viseme follows.
    speaking: u16,
    gap: u8,
    rate: u32,
    /// [`BAND_RATE`] times the samples since the last one at 8 kHz, less `rate` for each of those.
    phase: u32,
    /// The sum of the samples since then, and their number.
    sum: i32,
    count: usize,
    /// The mean of the sound, and the last two samples without it: sixteenths.
    mean: i32,
    before: [i32; 2],
    /// What each band made of them, in sixteenths.
    bands: [[i32; 2]; 6],
    /// Sums of magnitudes in each band since the last hop, and the samples at 8 kHz since then.
    levels: [u32; 6],
    samples: u8,
    /// The lowest level of the hops since it was moved, and of the 0.8 s before that.
    lowest: [i32; 2],
    hops: u8,
    /// The level of loud speech.
    loudest: i32,
    /// The viseme that is shown: 0 for none.
    viseme: u8,
    /// Those that follow, and when they begin.
    waiting: Deque<(u8, u32), WAITING>,
    /// Milliseconds since the start in tens, those that are not part of it yet, and those since samples came.
    now: u32,
    rest: u32,
    silent_ms: u32,
}

impl Talk {
    /// A closed mouth, for sound of `rate` samples a second; `None` unless these are [`LEAST_RATE`] to [`MOST_RATE`].
    pub fn new(rate: u32) -> Option<Talk> {
        (LEAST_RATE..=MOST_RATE).contains(&rate).then(|| Talk {
            weights: [0; 14],
            targets: [0; 14],
            speaking: 0,
            gap: 0,
            rate,
            phase: 0,
            sum: 0,
            count: 0,
            mean: 0,
            before: [0; 2],
            bands: [[0; 2]; 6],
            levels: [0; 6],
            samples: 0,
            lowest: [LOUDEST, 0],
            hops: 0,
            loudest: 0,
            viseme: 0,
            waiting: Deque::new(),
            now: 0,
            rest: 0,
            silent_ms: 0,
        })
    }

    /// The weights of [`VISEMES`], Q15: 0 to [`FULL_WEIGHT`].
    pub fn weights(&self) -> &[u16; 14] {
        &self.weights
    }

    /// How far speech has the mouth to itself, Q15: 0 to [`FULL_WEIGHT`], which it is while there is sound or a viseme, and for 0.4 s after it.
    pub fn speaking(&self) -> u16 {
        self.speaking
    }

    /// Adds the weights to those of a face, whose own weights of the units of visemes give way by [`Talk::speaking`]. Fails for a model that lacks one
    /// of [`VISEMES`] whose weight is not 0.
    pub fn add_to(&self, weights: &mut Weights, model: &Model) -> Result<(), UnknownName> {
        weights.fade(model, &VISEMES, self.speaking);
        for (name, &weight) in VISEMES.iter().zip(&self.weights) {
            if weight > 0 {
                weights.add(model, name, Weight::from_bits(i32::from(weight) << 1))?;
            }
        }
        Ok(())
    }

    /// Listens to samples of one channel. The weights follow every 10 ms of sound, unless a viseme is shown or waits.
    pub fn push(&mut self, samples: &[i16]) {
        if !samples.is_empty() {
            self.silent_ms = 0;
        }
        for &sample in samples {
            self.sum += i32::from(sample);
            self.count += 1;
            self.phase += BAND_RATE;
            if self.phase < self.rate {
                continue;
            }
            self.phase -= self.rate;
            let reciprocal = RECIPROCALS.get(self.count).copied().unwrap_or(0);
            self.sample((self.sum * reciprocal) >> 12);
            (self.sum, self.count) = (0, 0);
        }
    }

    /// Shows a viseme, 1 to 14, or none, 0, from `at` on until the next one's time: milliseconds of the clock of [`Talk::step`], which begins at 0; a
    /// time that has passed is now. Sound has no effect while a viseme is shown or waits.
    pub fn viseme(&mut self, viseme: u8, at: u32) -> Result<(), VisemeError> {
        if usize::from(viseme) > VISEMES.len() {
            return Err(VisemeError::Unknown);
        }
        if self.waiting.is_full() {
            return Err(VisemeError::Full);
        }
        if self.waiting.back().is_some_and(|last| before(at, last.1)) {
            return Err(VisemeError::Early);
        }
        self.waiting.push_back((viseme, at)).map_err(|_| VisemeError::Full)
    }

    /// Lets time pass: visemes become due, the weights approach theirs every 10 ms, and the mouth closes if no samples came for 150 ms. The samples of
    /// a time are pushed before its step, which may be longer.
    pub fn step(&mut self, ms: u16) {
        self.rest += u32::from(ms);
        // The time of a step before which there was sound is the sound's own.
        let most = if self.silent_ms == 0 { SILENT_MS - TICK_MS } else { SILENT_MS };
        while self.rest >= TICK_MS {
            self.rest -= TICK_MS;
            self.tick(most);
        }
    }

    /// `most_silent_ms` is what this time can add up to.
    fn tick(&mut self, most_silent_ms: u32) {
        let timed = self.timed();
        self.now = self.now.wrapping_add(TICK_MS);
        while let Some(&(viseme, at)) = self.waiting.front() {
            if before(self.now, at) {
                break;
            }
            self.viseme = viseme;
            self.waiting.pop_front();
        }
        self.silent_ms = if timed { SILENT_MS } else { self.silent_ms.max(most_silent_ms.min(self.silent_ms + TICK_MS)) };
        if self.silent_ms < SILENT_MS {
            return;
        }
        self.targets = [0; 14];
        if let Some(target) = usize::from(self.viseme).checked_sub(1).and_then(|index| self.targets.get_mut(index)) {
            *target = FULL;
        }
        self.approach();
    }

    fn timed(&self) -> bool {
        self.viseme != 0 || !self.waiting.is_empty()
    }

    /// Takes up one sample at 8 kHz.
    fn sample(&mut self, sample: i32) {
        self.mean += (sample * 16 - self.mean) >> 4;
        let sample = sample * 16 - self.mean;
        let driven = (sample - self.before[1]) >> 3;
        self.before = [sample, self.before[0]];
        for ((band, level), [turn, decay]) in self.bands.iter_mut().zip(&mut self.levels).zip(RESONATORS) {
            let now = driven + ((turn * band[0] - decay * band[1]) >> 9);
            *band = [now, band[0]];
            *level += now.unsigned_abs() >> 4;
        }
        self.samples += 1;
        if self.samples < HOP {
            return;
        }
        self.samples = 0;
        let level = self.levels.map(|sum| logarithm(sum + u32::from(HOP)));
        self.levels = [0; 6];
        if !self.timed() {
            self.listen(level);
            self.approach();
        }
    }

    /// The mouth's targets by the levels of a hop.
    fn listen(&mut self, [l300, l650, l1000, l1500, l2200, l3200]: [i32; 6]) {
        self.targets = [0; 14];
        let open = l650.max(l1000);
        let voice = open.max(l300);
        if !self.audible(voice.max(l3200), open) {
            return;
        }
        let hiss = ramp(l3200 - voice, -150, 100);
        // Where the voice has its energy: below 500 Hz in i and u, above in aa, e and o; above 1800 Hz in e and i; in o and u below.
        let wide = part(ramp(l650 - l300, -300, -100), FULL - hiss);
        let narrow = FULL - hiss - wide;
        let jaw = part(wide, ramp(open - self.loudest, -750, -150));
        let front = ramp(l2200 - l1000, -470, -310);
        let e = part(jaw, front);
        let o = part(jaw, part(ramp(l300 - l1000, 80, 220), FULL - front));
        // i and u open the jaw little: they have their whole weight where m and n, which are softer, have none.
        let loud = part(narrow, ramp(voice - self.loudest, -420, -235));
        let u = part(loud, ramp(l1500 - l2200, -40, 120));
        let ss = part(hiss, ramp(l3200 - self.loudest, -1100, -700));
        self.targets = [0, 0, 0, 0, 0, 0, ss, 0, 0, jaw - e - o, e, loud - u, o, u];
    }

    /// Follows the lowest and the loudest level; whether a hop of such levels is louder than noise.
    fn audible(&mut self, all: i32, open: i32) -> bool {
        self.lowest[0] = self.lowest[0].min(all);
        let noise = self.lowest[0].min(self.lowest[1]).max(SOFTEST);
        self.hops += 1;
        if self.hops == LOWEST_HOPS {
            self.hops = 0;
            self.lowest = [all, self.lowest[0]];
        }
        if open > self.loudest {
            self.loudest += (open - self.loudest + 3) >> 2;
        } else {
            self.loudest -= i32::from(self.hops & 1);
        }
        self.loudest = self.loudest.max(noise + SPEECH_ABOVE_NOISE);
        all >= noise + ABOVE_NOISE
    }

    /// A step of all weights towards their targets: half of the way, and five eighths where a weight falls, so that lips meet in a short gap.
    fn approach(&mut self) {
        let quiet = self.targets.iter().all(|&target| target == 0);
        self.gap = if quiet { self.gap.saturating_sub(1) } else { GAP };
        self.speaking = match self.gap {
            0 => self.speaking - self.speaking.div_ceil(8),
            _ => self.speaking + (FULL - self.speaking).div_ceil(4),
        };
        for (weight, &target) in self.weights.iter_mut().zip(&self.targets) {
            let rest = i32::from(target) - i32::from(*weight);
            let step = if rest < 0 { -((-rest * 5) >> 3) } else { rest >> 1 };
            *weight = weight.wrapping_add_signed(if step == 0 { rest } else { step } as i16);
        }
    }
}

/// A full weight.
const FULL: u16 = FULL_WEIGHT as u16;

/// Whether a time of the clock, which begins again after 49 days, is before another.
fn before(time: u32, other: u32) -> bool {
    (time.wrapping_sub(other) as i32) < 0
}

/// The level of a sum of magnitudes, above 0.
fn logarithm(sum: u32) -> i32 {
    let bits = sum.max(1).ilog2();
    let fraction = if bits < 8 { sum << (8 - bits) } else { sum >> (bits - 8) };
    (bits * 256 + (fraction & 255)) as i32
}

/// A weight that grows from 0 at `none` to its full at `full`.
fn ramp(level: i32, none: i32, full: i32) -> u16 {
    let above = (level - none).clamp(0, full - none);
    (above * FULL_WEIGHT / (full - none)) as u16
}

fn part(weight: u16, of: u16) -> u16 {
    ((u32::from(weight) * u32::from(of)) >> 15) as u16
}
