//! Our own key-frame text, written by hand: docs/KEYFRAMES.md describes it.

mod rig;

use super::text::{number_in, shown};
use super::{Options, Source, read_bytes};
use crate::keys::sample;
use crate::motion::{Interpolation, Keys, Motion, Rig};
use anyhow::{Result, anyhow};
use std::path::Path;

/// First word of every such file.
const MAGIC: &str = "keyframes";
/// The version that this reader knows.
const VERSION: &str = "1";
/// Far more than a hand writes, and little enough to sample.
const MOST_FRAMES: f64 = 1e6;
/// Frames times channels: 128 MB of samples.
const MOST_VALUES: usize = 1 << 24;

/// Whether `head` begins such a file; comments may stand before.
pub fn begins(head: &[u8]) -> bool {
    let text = String::from_utf8_lossy(head);
    text.lines().find_map(|line| words(line).next()) == Some(MAGIC)
}

/// Reads the key-frame file `path`.
pub fn read(path: &Path, options: &Options) -> Result<Source> {
    let bytes = read_bytes(path)?;
    let text = String::from_utf8_lossy(&bytes);
    let mut reader = Reader::default();
    let mut line = 0;
    let result = text.lines().try_for_each(|content| {
        line += 1;
        reader.line(line, &words(content).collect::<Vec<_>>())
    });
    let source = result.and_then(|()| reader.finish(options));
    source.map_err(|Wrong { line: own, message }| anyhow!("{}:{}: {message}", path.display(), own.unwrap_or(line.max(1))))
}

fn words(line: &str) -> impl Iterator<Item = &str> {
    line.split('#').next().unwrap_or_default().trim_start_matches('\u{feff}').split_whitespace()
}

/// What is wrong, and where if it is not the line at hand.
struct Wrong {
    line: Option<usize>,
    message: String,
}

impl From<String> for Wrong {
    fn from(message: String) -> Wrong {
        Wrong { line: None, message }
    }
}

type Read<T> = Result<T, Wrong>;

fn wrong<T>(message: impl Into<String>) -> Read<T> {
    Err(Wrong::from(message.into()))
}

/// A `keys` block.
struct Block {
    line: usize,
    interpolation: Interpolation,
    channels: Vec<usize>,
    /// Frame and one value a channel.
    rows: Vec<(usize, Vec<f64>)>,
}

#[derive(Default)]
struct Reader {
    begun: bool,
    rig: Rig,
    cm_per_unit: Option<f64>,
    fps: Option<f64>,
    frames: Option<usize>,
    looped: bool,
    blocks: Vec<Block>,
}

impl Reader {
    fn line(&mut self, line: usize, words: &[&str]) -> Read<()> {
        let Some((&first, rest)) = words.split_first() else { return Ok(()) };
        if !self.begun {
            self.begun = true;
            return if words == [MAGIC, VERSION] {
                Ok(())
            } else {
                wrong(format!("expected `{MAGIC} {VERSION}` as the first line"))
            };
        }
        let heading = matches!(first, "cm-per-unit" | "fps" | "frames" | "loop" | "joint" | "end" | "scalar");
        if heading && !self.blocks.is_empty() {
            return wrong(format!("`{first}` stands after the first `keys`; expected it before"));
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
            "joint" => rig::joint(&mut self.rig, rest)?,
            "end" => rig::end(&mut self.rig, rest)?,
            "scalar" => rig::scalar(&mut self.rig, rest)?,
            "keys" => self.keys(line, rest)?,
            _ if first.starts_with(|c: char| c.is_ascii_digit()) => self.row(words)?,
            _ => {
                let known = "cm-per-unit, fps, frames, loop, joint, end, scalar, keys or a frame number";
                return wrong(format!("expected {known}, found `{}`", words.join(" ")));
            }
        }
        Ok(())
    }

    fn keys(&mut self, line: usize, words: &[&str]) -> Read<()> {
        if self.frames.is_none() {
            return wrong("expected `frames NUMBER` before the first `keys`");
        }
        let [by, names @ ..] = words else { return wrong("expected `keys INTERPOLATION JOINT-OR-CHANNEL...`") };
        let interpolation = interpolation(by)?;
        let mut channels = Vec::new();
        for name in names {
            channels.extend(rig::channels(&self.rig, name)?);
        }
        if channels.is_empty() {
            return wrong("expected joints or channels after the interpolation");
        }
        let mut keyed: Vec<usize> = self.blocks.iter().flat_map(|block| block.channels.iter().copied()).collect();
        for &channel in &channels {
            if keyed.contains(&channel) {
                return wrong(format!("channel `{}` has keys already", self.rig.channel_name(channel)));
            }
            keyed.push(channel);
        }
        rig::check_groups(&self.rig, &channels)?;
        self.blocks.push(Block { line, interpolation, channels, rows: Vec::new() });
        Ok(())
    }

    fn row(&mut self, words: &[&str]) -> Read<()> {
        let frames = self.frames.unwrap_or(1);
        let last = if self.looped { frames } else { frames - 1 };
        let Some(block) = self.blocks.last_mut() else { return wrong("a row of values before the first `keys`") };
        let frame = match words[0].parse::<usize>() {
            Ok(frame) if frame <= last => frame,
            _ => return wrong(format!("expected a frame of 0 to {last}, found `{}`", words[0])),
        };
        match block.rows.last() {
            None if frame != 0 => return wrong(format!("expected frame 0 as the first key, found {frame}")),
            Some(&(before, _)) if before >= frame => return wrong(format!("expected a frame after {before}, found {frame}")),
            _ => {}
        }
        let count = block.channels.len();
        if words.len() != count + 1 {
            return wrong(format!("expected {count} values after the frame, one a channel, found {}", words.len() - 1));
        }
        let values = words[1..].iter().map(|word| number(word)).collect::<Read<_>>()?;
        block.rows.push((frame, values));
        Ok(())
    }

    fn finish(self, options: &Options) -> Read<Source> {
        let missing = |what: &str| Wrong::from(format!("expected `{what} NUMBER`, found the end of the file"));
        let frames = self.frames.ok_or_else(|| missing("frames"))?;
        let fps = self.fps.or(options.fps).ok_or_else(|| missing("fps"))?;
        let kinds = self.rig.channel_kinds();
        if kinds.is_empty() {
            return wrong("no joint has channels and there is no scalar, so nothing can move");
        }
        if kinds.len() * frames > MOST_VALUES {
            return wrong(format!("{frames} frames of {} channels; expected at most {MOST_VALUES} values", kinds.len()));
        }
        let mut values: Vec<Vec<f64>> = kinds.iter().map(|&place| vec![rig::rest(&self.rig, place); frames]).collect();
        let mut keys = vec![None; kinds.len()];
        for block in &self.blocks {
            block.check_last(frames, self.looped)?;
            for (place, &channel) in block.channels.iter().enumerate() {
                let curve = block.curve(place, frames, self.looped);
                values[channel] = sample(&curve, block.interpolation, frames, self.looped);
                keys[channel] = Some(within(curve, block.interpolation, &values[channel]));
            }
        }
        let rig = Rig { cm_per_unit: self.cm_per_unit.unwrap_or(1.0), ..self.rig };
        let motion = Motion { rig, frame_time: 1.0 / fps, frames, values, keys, looped: self.looped };
        Ok(Source { motion, unit_known: self.cm_per_unit.is_some(), warnings: Vec::new() })
    }
}

impl Block {
    /// Without a loop, nothing says where a channel goes after its last key.
    fn check_last(&self, frames: usize, looped: bool) -> Read<()> {
        let message = match self.rows.last() {
            None => "expected rows of keys below this line".to_string(),
            Some(&(last, _)) if !looped && self.rows.len() > 1 && last + 1 != frames => {
                format!("the last key of this block is at frame {last}; expected one at {}, the last frame", frames - 1)
            }
            _ => return Ok(()),
        };
        Err(Wrong { line: Some(self.line), message })
    }

    /// Keys of the channel at `place`; those of a loop close it.
    fn curve(&self, place: usize, frames: usize, looped: bool) -> Vec<(usize, f64)> {
        let mut curve: Vec<(usize, f64)> = self.rows.iter().map(|(frame, row)| (*frame, row[place])).collect();
        if looped && curve.len() > 1 && curve.last().is_some_and(|&(frame, _)| frame < frames) {
            curve.push((frames, curve[0].1));
        }
        curve
    }
}

/// Keys up to the last frame that is there, with one on it.
fn within(mut keys: Vec<(usize, f64)>, interpolation: Interpolation, values: &[f64]) -> Keys {
    let last = values.len() - 1;
    keys.retain(|&(frame, _)| frame < last);
    keys.push((last, values[last]));
    Keys { interpolation, keys }
}

fn number(word: &str) -> Read<f64> {
    number_in(word.as_bytes()).map_err(Wrong::from)
}

fn positive(name: &str, words: &[&str]) -> Read<f64> {
    let [word] = words else { return wrong(format!("expected one number after `{name}`")) };
    match number(word)? {
        number if number > 0.0 => Ok(number),
        _ => wrong(format!("expected a number above 0 after `{name}`, found {}", shown(Some(word.as_bytes())))),
    }
}

fn interpolation(word: &str) -> Read<Interpolation> {
    Ok(match word {
        "linear" => Interpolation::Linear,
        "catmull-rom" => Interpolation::CatmullRom,
        "natural" => Interpolation::Natural,
        "discrete" => Interpolation::Discrete,
        _ => return wrong(format!("expected linear, catmull-rom, natural or discrete, found `{word}`")),
    })
}
