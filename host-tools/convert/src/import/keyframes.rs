//! Our own key-frame text, written by hand: docs/KEYFRAMES.md describes it.

use super::written::{self, HEADINGS, Header, LineParser as _, Read, Wrong, number, rig, wrong};
use super::{Request, Source};
use crate::keys::{cubics, sample, within};
use crate::motion::{Interpolation, Motion, Origin, Rig};
use anyhow::{Error, Result};
use std::path::Path;

/// Whether `head` begins such a file.
pub fn begins(head: &[u8]) -> bool {
    written::begins(head, KeysText::FIRST[0])
}

/// Reads the key-frame file `path`.
pub fn read(path: &Path, options: &Request) -> Result<Source> {
    KeysText::default().read(path, options)
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
struct KeysText {
    header: Header,
    blocks: Vec<Block>,
}

impl written::LineParser for KeysText {
    const FIRST: [&'static str; 2] = ["keyframes", "1"];

    fn line(&mut self, line: usize, first: &str, rest: &[&str]) -> Read<()> {
        match first {
            _ if Header::has(first) && !self.blocks.is_empty() => {
                wrong(format!("`{first}` stands after the first `keys`; expected it before"))
            }
            _ if Header::has(first) => self.header.line(first, rest),
            "keys" => self.keys(line, rest),
            _ if first.starts_with(|c: char| c.is_ascii_digit()) => self.row(first, rest),
            _ => {
                let found = [&[first], rest].concat().join(" ");
                wrong(format!("expected {HEADINGS}, keys or a frame number, found `{found}`"))
            }
        }
    }

    fn finish(mut self, options: &Request) -> Read<Source> {
        let Header { cm_per_unit, looped, .. } = self.header;
        let (frames, fps) = self.header.timing(options.fps, options.memory)?;
        let mut values = self.header.at_rest(frames);
        let mut keys = vec![None; values.len()];
        for block in &self.blocks {
            block.check_last(frames, looped)?;
            for (place, &channel) in block.channels.iter().enumerate() {
                let curve = block.curve(place, frames, looped);
                values[channel] = sample(&curve, block.interpolation, frames, looped);
                let pieces = cubics(&curve, block.interpolation, looped);
                keys[channel] = Some(within(curve, block.interpolation, pieces, &values[channel]));
            }
        }
        let events = self.header.events();
        let rig = Rig { cm_per_unit: cm_per_unit.unwrap_or(1.0), ..self.header.rig };
        let motion = Motion { rig, frame_time: 1.0 / fps, frames, values, keys, looped, events, origin: Origin::default() };
        Ok(Source { unit_known: cm_per_unit.is_some(), ..Source::plain(motion, Vec::new()) })
    }
}

impl KeysText {
    fn keys(&mut self, line: usize, words: &[&str]) -> Read<()> {
        if self.header.frames.is_none() {
            return wrong("expected `frames NUMBER` before the first `keys`");
        }
        let [by, names @ ..] = words else { return wrong("expected `keys INTERPOLATION JOINT-OR-CHANNEL...`") };
        let interpolation = interpolation(by)?;
        let mut channels = Vec::new();
        for name in names {
            channels.extend(rig::channels(&self.header.rig, name)?);
        }
        if channels.is_empty() {
            return wrong("expected joints or channels after the interpolation");
        }
        let mut keyed: Vec<usize> = self.blocks.iter().flat_map(|block| block.channels.iter().copied()).collect();
        for &channel in &channels {
            if keyed.contains(&channel) {
                return wrong(format!("channel `{}` has keys already", self.header.rig.channel_name(channel)));
            }
            keyed.push(channel);
        }
        rig::check_groups(&self.header.rig, &channels)?;
        self.blocks.push(Block { line, interpolation, channels, rows: Vec::new() });
        Ok(())
    }

    fn row(&mut self, frame: &str, words: &[&str]) -> Read<()> {
        let frames = self.header.frames.unwrap_or(1);
        let last = if self.header.looped { frames } else { frames - 1 };
        let Some(block) = self.blocks.last_mut() else { return wrong("a row of values before the first `keys`") };
        let frame = match frame.parse::<usize>() {
            Ok(frame) if frame <= last => frame,
            _ => return wrong(format!("expected a frame of 0 to {last}, found `{frame}`")),
        };
        match block.rows.last() {
            None if frame != 0 => return wrong(format!("expected frame 0 as the first key, found {frame}")),
            Some(&(before, _)) if before >= frame => return wrong(format!("expected a frame after {before}, found {frame}")),
            _ => {}
        }
        let count = block.channels.len();
        if words.len() != count {
            return wrong(format!("expected {count} values after the frame, one a channel, found {}", words.len()));
        }
        let rig = &self.header.rig;
        let value = |(word, &channel): (&&str, &usize)| {
            let value = number(word)?;
            let scalar = channel.checked_sub(rig.joint_channels()).and_then(|scalar| rig.scalars.get(scalar));
            match scalar.filter(|scalar| value.abs() > scalar.full_scale) {
                Some(scalar) => {
                    wrong(format!("{value} of `{}` is outside {1}..{2}", scalar.name, -scalar.full_scale, scalar.full_scale))
                }
                None => Ok(value),
            }
        };
        let values = words.iter().zip(&block.channels).map(value).collect::<Read<_>>()?;
        block.rows.push((frame, values));
        Ok(())
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
        Err(Wrong { line: Some(self.line), error: Error::msg(message) })
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

fn interpolation(word: &str) -> Read<Interpolation> {
    Ok(match word {
        "linear" => Interpolation::Linear,
        "catmull-rom" => Interpolation::CatmullRom,
        "natural" => Interpolation::Natural,
        "discrete" => Interpolation::Discrete,
        _ => return wrong(format!("expected linear, catmull-rom, natural or discrete, found `{word}`")),
    })
}
