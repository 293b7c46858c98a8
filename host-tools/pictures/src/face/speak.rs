//! A track of visemes for spoken text, or for a recording.

use anyhow::{Context, Result, ensure};
use pantin_face::FULL_WEIGHT;
use pantin_face::talk::{MOST_RATE, Talk, VISEMES};
use std::fmt::Write;

/// Frames a second of the track.
pub const FPS: f64 = 30.0;
/// Milliseconds of a vowel, of a consonant, and of a pause at a comma or at the end of a sentence.
const VOWEL_MS: f64 = 140.0;
const CONSONANT_MS: f64 = 80.0;
const PAUSE_MS: [f64; 2] = [180.0, 320.0];
/// Milliseconds of rest before and after.
const REST_MS: f64 = 200.0;
/// The longest text in letters.
const MOST_LETTERS: usize = 20_000;

/// A viseme, or the mouth at rest, and when it is spoken.
#[derive(Clone, Debug, PartialEq)]
pub struct Spoken {
    /// The name of a weight of the face; `None` is a pause.
    pub viseme: Option<&'static str>,
    /// Milliseconds from the start of the track to its middle.
    pub middle_ms: f64,
}

impl Spoken {
    /// Whether the lips must be closed: at p, b and m.
    pub fn closes(&self) -> bool {
        self.viseme == Some("viseme_pp")
    }

    /// Whether it is an open vowel, at which the jaw must be open.
    pub fn opens(&self) -> bool {
        matches!(self.viseme, Some("viseme_aa" | "viseme_o" | "viseme_e"))
    }
}

/// Spellings and their visemes, longer ones first; what is not listed is silent.
const SPELLINGS: [(&str, &[&str]); 58] = [
    ("tion", &["ch", "e", "nn"]),
    ("ough", &["o"]),
    ("augh", &["o"]),
    ("igh", &["aa", "i"]),
    ("tch", &["ch"]),
    ("dge", &["ch"]),
    ("sch", &["ch"]),
    ("th", &["th"]),
    ("sh", &["ch"]),
    ("ch", &["ch"]),
    ("ph", &["ff"]),
    ("wh", &["u"]),
    ("ck", &["kk"]),
    ("ng", &["nn", "kk"]),
    ("qu", &["kk", "u"]),
    ("kn", &["nn"]),
    ("wr", &["rr"]),
    ("mb", &["pp"]),
    ("ee", &["i"]),
    ("ea", &["i"]),
    ("ie", &["i"]),
    ("oo", &["u"]),
    ("ou", &["aa", "u"]),
    ("ow", &["o", "u"]),
    ("oa", &["o"]),
    ("oi", &["o", "i"]),
    ("oy", &["o", "i"]),
    ("ai", &["e", "i"]),
    ("ay", &["e", "i"]),
    ("au", &["o"]),
    ("aw", &["o"]),
    ("ew", &["u"]),
    ("a", &["aa"]),
    ("b", &["pp"]),
    ("c", &["kk"]),
    ("d", &["dd"]),
    ("e", &["e"]),
    ("f", &["ff"]),
    ("g", &["kk"]),
    ("h", &[]),
    ("i", &["i"]),
    ("j", &["ch"]),
    ("k", &["kk"]),
    ("l", &["nn"]),
    ("m", &["pp"]),
    ("n", &["nn"]),
    ("o", &["o"]),
    ("p", &["pp"]),
    ("q", &["kk"]),
    ("r", &["rr"]),
    ("s", &["ss"]),
    ("t", &["dd"]),
    ("u", &["u"]),
    ("v", &["ff"]),
    ("w", &["u"]),
    ("x", &["kk", "ss"]),
    ("y", &["i"]),
    ("z", &["ss"]),
];

/// Mnemonics of espeak-ng's phonemes, longer ones first.
const PHONEMES: [(&str, &[&str]); 64] = [
    ("tS", &["ch"]),
    ("dZ", &["ch"]),
    ("aI@", &["aa", "i", "e"]),
    ("aU@", &["aa", "u", "e"]),
    ("aI", &["aa", "i"]),
    ("aU", &["aa", "u"]),
    ("eI", &["e", "i"]),
    ("OI", &["o", "i"]),
    ("oU", &["o", "u"]),
    ("i@", &["i", "e"]),
    ("e@", &["e"]),
    ("U@", &["u", "e"]),
    ("A@", &["aa"]),
    ("O@", &["o"]),
    ("o@", &["o"]),
    ("I2", &["i"]),
    ("I#", &["i"]),
    ("@L", &["e", "nn"]),
    ("@2", &["e"]),
    ("@5", &["e"]),
    ("a#", &["aa"]),
    ("aa", &["aa"]),
    ("3:", &["e"]),
    ("A:", &["aa"]),
    ("O:", &["o"]),
    ("i:", &["i"]),
    ("u:", &["u"]),
    ("p", &["pp"]),
    ("b", &["pp"]),
    ("m", &["pp"]),
    ("f", &["ff"]),
    ("v", &["ff"]),
    ("T", &["th"]),
    ("D", &["th"]),
    ("t", &["dd"]),
    ("d", &["dd"]),
    ("k", &["kk"]),
    ("g", &["kk"]),
    ("N", &["kk"]),
    ("S", &["ch"]),
    ("Z", &["ch"]),
    ("s", &["ss"]),
    ("z", &["ss"]),
    ("n", &["nn"]),
    ("l", &["nn"]),
    ("L", &["nn"]),
    ("r", &["rr"]),
    ("R", &["rr"]),
    ("w", &["u"]),
    ("j", &["i"]),
    ("h", &[]),
    ("a", &["aa"]),
    ("A", &["aa"]),
    ("0", &["o"]),
    ("O", &["o"]),
    ("o", &["o"]),
    ("V", &["aa"]),
    ("E", &["e"]),
    ("e", &["e"]),
    ("@", &["e"]),
    ("3", &["e"]),
    ("I", &["i"]),
    ("i", &["i"]),
    ("U", &["u"]),
];

/// The visemes of a text by rules of English spelling.
pub fn of_text(text: &str) -> Result<Vec<Spoken>> {
    ensure!(text.chars().count() <= MOST_LETTERS, "the text has more than {MOST_LETTERS} letters");
    let mut track = Speech::new();
    for word in text.to_lowercase().split_inclusive(|c: char| !c.is_alphanumeric() && c != '\'') {
        let letters: String = word.chars().filter(char::is_ascii_alphabetic).collect();
        track.say(silent_end(&letters), &SPELLINGS);
        match word.chars().last() {
            Some(',' | ';' | ':') => track.rest(PAUSE_MS[0]),
            Some('.' | '!' | '?' | '\n') => track.rest(PAUSE_MS[1]),
            _ => {}
        }
    }
    track.finish("the text has no letters to speak")
}

/// Letters and digits of a text that [`of_text`] leaves out, each once, in their order.
pub fn unspoken(text: &str) -> String {
    let mut seen = String::new();
    for letter in text.chars().filter(|letter| letter.is_alphanumeric() && !letter.is_ascii_alphabetic()) {
        if !seen.contains(letter) {
            seen.push(letter);
        }
    }
    seen
}

/// A word without an e at its end that is not spoken.
fn silent_end(word: &str) -> &str {
    let vowels = word.chars().filter(|letter| "aeiouy".contains(*letter)).count();
    if vowels > 1 && !word.ends_with("ee") { word.strip_suffix('e').unwrap_or(word) } else { word }
}

/// The visemes of what `espeak-ng -q -x` prints: mnemonics of phonemes, a line for each clause.
pub fn of_phonemes(lines: &str) -> Result<Vec<Spoken>> {
    ensure!(lines.len() <= MOST_LETTERS, "there are more than {MOST_LETTERS} phonemes");
    let mut track = Speech::new();
    for line in lines.lines() {
        for word in line.split_whitespace() {
            track.say(word, &PHONEMES);
        }
        track.rest(PAUSE_MS[1]);
    }
    track.finish("there are no phonemes")
}

struct Speech {
    spoken: Vec<Spoken>,
    at_ms: f64,
}

impl Speech {
    fn new() -> Speech {
        let mut track = Speech { spoken: Vec::new(), at_ms: 0.0 };
        track.rest(REST_MS);
        track
    }

    fn rest(&mut self, ms: f64) {
        self.add(None, ms);
    }

    fn add(&mut self, viseme: Option<&'static str>, ms: f64) {
        self.spoken.push(Spoken { viseme, middle_ms: self.at_ms + ms / 2.0 });
        self.at_ms += ms;
    }

    /// Adds the visemes of a word by the first entry of a table that fits at each place.
    fn say(&mut self, word: &str, table: &[(&str, &[&'static str])]) {
        let mut rest = word;
        while let Some(first) = rest.chars().next() {
            let Some((spelling, visemes)) = table.iter().find(|entry| rest.starts_with(entry.0)) else {
                rest = &rest[first.len_utf8()..];
                continue;
            };
            // A letter that is written twice is spoken once.
            let again = spelling.len() == 1 && rest[1..].starts_with(spelling);
            for viseme in visemes.iter().filter(|_| !again) {
                let vowel = matches!(*viseme, "aa" | "e" | "i" | "o" | "u");
                self.add(Some(name(viseme)), if vowel { VOWEL_MS } else { CONSONANT_MS });
            }
            rest = &rest[spelling.len()..];
        }
    }

    fn finish(mut self, nothing: &str) -> Result<Vec<Spoken>> {
        ensure!(self.spoken.iter().any(|spoken| spoken.viseme.is_some()), "{nothing}");
        self.rest(REST_MS);
        Ok(self.spoken)
    }
}

/// The face's name of a viseme.
fn name(short: &str) -> &'static str {
    let named = |name: &&&str| name.strip_prefix("viseme_") == Some(short);
    VISEMES.iter().find(named).expect("the tables of spellings and phonemes name visemes")
}

/// The frame of a time.
fn frame(ms: f64) -> usize {
    (ms * FPS / 1000.0).round() as usize
}

/// Writes the track as key-frame text: each viseme has its full weight in the middle of its time, and none in the middle of its neighbours'.
pub fn keys(spoken: &[Spoken], comment: &str) -> String {
    // Middles are at least two frames apart, but those of short consonants may fall into one frame.
    let mut frames: Vec<usize> = Vec::new();
    for entry in spoken {
        frames.push(frame(entry.middle_ms).max(frames.last().map_or(0, |&last| last + 1)));
    }
    let count = frames.last().map_or(0, |&last| last + 1) + frame(REST_MS / 2.0);
    let mut names: Vec<&str> = spoken.iter().filter_map(|entry| entry.viseme).collect();
    names.sort_unstable();
    names.dedup();
    let mut out = format!("keyframes 1\n# {}\nfps {FPS:.0}\nframes {count}\n\n", comment.replace('\n', " "));
    // Writing to a string cannot fail.
    for name in &names {
        let _ = writeln!(out, "scalar {name} scale 1");
    }
    for name in names {
        let _ = writeln!(out, "\nkeys linear {name}");
        let mut rows: Vec<(usize, u8)> = vec![(0, 0)];
        for (index, entry) in spoken.iter().enumerate() {
            let near = index.saturating_sub(1)..=(index + 1).min(spoken.len() - 1);
            let own = entry.viseme == Some(name);
            if own || near.into_iter().any(|index| spoken[index].viseme == Some(name)) {
                rows.push((frames[index], u8::from(own)));
            }
        }
        rows.push((count - 1, 0));
        rows.dedup_by_key(|row| row.0);
        rows.iter().for_each(|(frame, value)| {
            let _ = writeln!(out, "  {frame} {value}");
        });
    }
    out
}

/// Writes the mouth of a recording as key-frame text: the weights of [`Talk`] at each frame. Fails for other files than PCM of 16 bits.
pub fn of_wav(bytes: &[u8], comment: &str) -> Result<String> {
    let (rate, samples) = wav(bytes)?;
    let (rate, samples) = lowered(rate, samples);
    let mut talk = Talk::new(rate).with_context(|| format!("expected a sampling rate of at least 8,000 Hz, not {rate}"))?;
    let step = f64::from(rate) / FPS;
    let count = ((samples.len() as f64 / step).ceil() as usize).max(2);
    ensure!(count <= 1 << 16, "the recording is longer than {} minutes", (1 << 16) / 30 / 60);
    let mut pushed = 0;
    let mut weights = Vec::with_capacity(count);
    for frame in 0..count {
        let end = ((frame as f64 * step) as usize).min(samples.len());
        talk.push(&samples[pushed..end]);
        pushed = end;
        weights.push(*talk.weights());
    }
    let mut out = format!("keyframes 1\n# {}\nfps {FPS:.0}\nframes {count}\n\n", comment.replace('\n', " "));
    let used = |viseme: &usize| weights.iter().any(|weights| weights[*viseme] > 0);
    // A recording of silence has a mouth too, which is closed.
    let mut visemes: Vec<usize> = (0..VISEMES.len()).filter(used).collect();
    if visemes.is_empty() {
        visemes = VISEMES.iter().position(|name| *name == "viseme_aa").into_iter().collect();
    }
    for &viseme in &visemes {
        let _ = writeln!(out, "scalar {} scale 1", VISEMES[viseme]);
    }
    for viseme in visemes {
        let _ = writeln!(out, "\nkeys linear {}", VISEMES[viseme]);
        for (frame, weights) in weights.iter().enumerate() {
            let _ = writeln!(out, "  {frame} {:.3}", f64::from(weights[viseme]) / f64::from(FULL_WEIGHT));
        }
    }
    Ok(out)
}

/// A recording at a rate that [`Talk`] takes: where its own is higher, each sample is the mean of several.
fn lowered(rate: u32, samples: Vec<i16>) -> (u32, Vec<i16>) {
    let group = rate.div_ceil(MOST_RATE);
    if group == 1 {
        return (rate, samples);
    }
    let mean = |part: &[i16]| (part.iter().map(|&x| i64::from(x)).sum::<i64>() / part.len() as i64) as i16;
    (rate / group, samples.chunks(group as usize).map(mean).collect())
}

/// The sampling rate and the first channel of a WAV.
fn wav(bytes: &[u8]) -> Result<(u32, Vec<i16>)> {
    ensure!(bytes.len() > 12 && bytes.starts_with(b"RIFF") && &bytes[8..12] == b"WAVE", "no WAV");
    let (mut at, mut format) = (12, None);
    while let Some(head) = bytes.get(at..at + 8) {
        let length = u32::from_le_bytes([head[4], head[5], head[6], head[7]]) as usize;
        let left = bytes.len() - at - 8;
        // A recorder that cannot go back to its header claims the longest length.
        ensure!(
            &head[..4] != b"data" || length <= left || length == u32::MAX as usize,
            "byte {at}: the data chunk claims {length} bytes, but {left} follow; expected a whole WAV"
        );
        let body = &bytes[at + 8..(at + 8).saturating_add(length).min(bytes.len())];
        match &head[..4] {
            b"fmt " if body.len() >= 16 => {
                let short = |place: usize| u16::from_le_bytes([body[place], body[place + 1]]);
                ensure!(short(0) == 1 && short(14) == 16, "expected PCM of 16 bits");
                let channels = usize::from(short(2));
                ensure!(channels > 0, "byte {at}: the format has 0 channels; expected at least 1");
                format = Some((u32::from_le_bytes([body[4], body[5], body[6], body[7]]), channels));
            }
            b"data" => {
                let (rate, channels) = format.context("samples before their format")?;
                ensure!((1_000..=400_000).contains(&rate), "expected a sampling rate from 1,000 to 400,000 Hz, not {rate}");
                ensure!(
                    body.len().is_multiple_of(2 * channels) || length == u32::MAX as usize,
                    "byte {at}: the data chunk has {} bytes; expected a multiple of {}, {channels} samples of 16 bits",
                    body.len(),
                    2 * channels
                );
                let samples: Vec<i16> = body.chunks_exact(2 * channels).map(|x| i16::from_le_bytes([x[0], x[1]])).collect();
                ensure!(!samples.is_empty(), "no samples");
                return Ok((rate, samples));
            }
            _ => {}
        }
        at = (at + 8).saturating_add(length.next_multiple_of(2));
    }
    anyhow::bail!("no samples")
}
