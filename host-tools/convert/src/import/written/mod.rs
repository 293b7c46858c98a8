//! What our own texts share: lines of words, the figure and the timing in front, and errors that name the line.

pub mod rig;

use super::Request;
use super::text::{number_in, quoted};
use crate::events;
use crate::memory::Memory;
use crate::motion::{Event, Rig};
use anyhow::{Error, Result};
use std::collections::BTreeSet;
use std::path::Path;

/// Far more than a hand writes, and little enough to sample.
const MOST_FRAMES: f64 = 1e6;

/// What is wrong, and where if it is not the line at hand.
pub struct Wrong {
    /// Another line than the one at hand, from 1.
    pub line: Option<usize>,
    /// What was expected and what stands there.
    pub error: Error,
}

impl From<Error> for Wrong {
    fn from(error: Error) -> Wrong {
        Wrong { line: None, error }
    }
}

impl From<String> for Wrong {
    fn from(message: String) -> Wrong {
        Wrong { line: None, error: Error::msg(message) }
    }
}

/// What a line gives.
pub type Read<T> = Result<T, Wrong>;

/// An error at the line at hand.
pub fn wrong<T>(message: impl Into<String>) -> Read<T> {
    Err(Wrong::from(message.into()))
}

/// Whether the first word of `head` is `magic`; comments may stand before.
pub fn begins(head: &[u8], magic: &str) -> bool {
    let text = String::from_utf8_lossy(head);
    text.lines().find_map(|line| words(line).next()) == Some(magic)
}

fn words(line: &str) -> impl Iterator<Item = &str> {
    line.split('#').next().unwrap_or_default().trim_start_matches('\u{feff}').split_whitespace()
}

/// Reads a text of lines.
pub trait LineParser: Sized {
    /// The first line: a word and the version that this reader knows.
    const FIRST: [&'static str; 2];

    /// Takes line `line`, whose first word is `first`.
    fn line(&mut self, line: usize, first: &str, rest: &[&str]) -> Read<()>;

    /// The motion, once all lines were read.
    fn finish(self, options: &Request) -> Read<super::Source>;

    /// Reads `path`. Errors name the file and the line.
    fn read(mut self, path: &Path, options: &Request) -> Result<super::Source> {
        let bytes = options.read(path)?;
        let text = String::from_utf8_lossy(&bytes);
        let mut begun = false;
        let mut line = 0;
        let result = text.lines().try_for_each(|content| {
            line += 1;
            let words: Vec<&str> = words(content).collect();
            let Some((first, rest)) = words.split_first() else { return Ok(()) };
            if begun {
                return self.line(line, first, rest);
            }
            begun = true;
            if words == Self::FIRST { Ok(()) } else { wrong(format!("expected `{}` as the first line", Self::FIRST.join(" "))) }
        });
        let source = result.and_then(|()| self.finish(options));
        source.map_err(|Wrong { line: own, error }| error.context(format!("{}:{}", path.display(), own.unwrap_or(line.max(1)))))
    }
}

/// The lines in front: figure and timing.
#[derive(Default)]
pub struct Header {
    /// The figure; its `cm_per_unit` is that of the line, or 1.
    pub rig: Rig,
    /// Length of its unit, if the file says.
    pub cm_per_unit: Option<f64>,
    /// Frames a second.
    pub fps: Option<f64>,
    /// Number of frames.
    pub frames: Option<usize>,
    /// Whether frame 0 follows the last frame.
    pub looped: bool,
    /// Markers, in the order of the lines.
    events: Vec<Event>,
    /// Lines so far of which there may be only one, by their first word.
    given: BTreeSet<String>,
}

/// First words of a header's lines, as errors list them.
pub const HEADINGS: &str = "cm-per-unit, fps, frames, loop, event, joint, end, scalar";

impl Header {
    /// Whether a line that begins so is part of the header.
    pub fn has(first: &str) -> bool {
        HEADINGS.split(", ").any(|heading| heading == first)
    }

    /// Takes one of its lines.
    pub fn line(&mut self, first: &str, rest: &[&str]) -> Read<()> {
        if matches!(first, "cm-per-unit" | "fps" | "frames" | "loop") && !self.given.insert(first.into()) {
            return wrong(format!("a second `{first}`; expected one"));
        }
        match first {
            "cm-per-unit" => self.cm_per_unit = Some(positive(first, rest)?),
            "fps" => self.fps = Some(positive(first, rest)?),
            "frames" => {
                let frames = positive(first, rest)?;
                if frames.fract() != 0.0 || frames > MOST_FRAMES {
                    return wrong(format!("expected whole frames, at most {MOST_FRAMES}, found {frames}"));
                }
                self.frames = Some(frames as usize);
            }
            "loop" if rest.is_empty() => self.looped = true,
            "event" => self.event(rest)?,
            "joint" => rig::joint(&mut self.rig, rest)?,
            "end" => rig::end(&mut self.rig, rest)?,
            "scalar" => rig::scalar(&mut self.rig, rest)?,
            _ => return wrong(format!("expected the end of the line after `{first}`, found `{}`", rest.join(" "))),
        }
        Ok(())
    }

    /// `event NAME FRAME...`
    fn event(&mut self, words: &[&str]) -> Read<()> {
        let [name, frames @ ..] = words else { return wrong("expected `event NAME FRAME...`") };
        if frames.is_empty() {
            return wrong("expected frames after the event's name");
        }
        events::check_name(name)?;
        let Some(count) = self.frames else { return wrong("expected `frames NUMBER` before the first `event`") };
        for word in frames {
            match word.parse::<usize>() {
                Ok(frame) if frame < count => self.events.push(Event { frame, name: (*name).into() }),
                _ => return wrong(format!("expected a frame of 0 to {}, found {}", count - 1, quoted(word))),
            }
        }
        Ok(())
    }

    /// The markers in the order of their frames.
    pub fn events(&mut self) -> Vec<Event> {
        let mut events = std::mem::take(&mut self.events);
        events.sort_by_key(|event| event.frame);
        events
    }

    /// Frames and frames a second, if the figure has what can move and samples fit the memory.
    pub fn timing(&self, fps: Option<f64>, memory: Memory) -> Read<(usize, f64)> {
        let missing = |what: &str| Wrong::from(format!("expected `{what} NUMBER`, found the end of the file"));
        let frames = self.frames.ok_or_else(|| missing("frames"))?;
        let fps = self.fps.or(fps).ok_or_else(|| missing("fps"))?;
        let channels = self.rig.channels();
        if channels == 0 {
            return wrong("no joint has channels and there is no scalar, so nothing can move");
        }
        memory.check(frames, channels)?;
        Ok((frames, fps))
    }

    /// Every channel held still where it is without a line of its own.
    pub fn at_rest(&self, frames: usize) -> Vec<Vec<f64>> {
        self.rig.channel_kinds().into_iter().map(|place| vec![self.rig.rest(place); frames]).collect()
    }
}

/// A number.
pub fn number(word: &str) -> Read<f64> {
    number_in(word.as_bytes()).map_err(Wrong::from)
}

/// The one number above 0 that follows `name`.
pub fn positive(name: &str, words: &[&str]) -> Read<f64> {
    let [word] = words else { return wrong(format!("expected one number after `{name}`")) };
    match number(word)? {
        number if number > 0.0 => Ok(number),
        _ => wrong(format!("expected a number above 0 after `{name}`, found {}", quoted(word))),
    }
}
