//! Procedural motion (docs/METHOD.md 2.3): channels as functions of time, sampled at every frame. docs/PROCEDURAL.md describes
//! the text.

use super::expression::{Expression, is_free};
use super::text::quoted;
use super::written::{self, HEADINGS, Header, LineParser as _, Read, Wrong, rig, wrong};
use super::{Request, Source};
use crate::memory::Memory;
use crate::motion::{Motion, Origin, Rig};
use anyhow::Result;
use std::collections::BTreeMap;
use std::path::Path;

/// No length or angle of a real motion comes near it.
const LARGEST: f64 = 1e9;
/// Names of `let` and those that every expression may use: far more than a hand writes.
const MOST_NAMES: usize = 1024;

/// Whether `head` begins such a file.
pub fn begins(head: &[u8]) -> bool {
    written::begins(head, ProceduralText::FIRST[0])
}

/// Reads the file `path`.
pub fn read(path: &Path, options: &Request) -> Result<Source> {
    let mut reader = ProceduralText::default();
    reader.header.fps = options.fps;
    reader.memory = options.memory;
    reader.read(path, options)
}

#[derive(Default)]
struct ProceduralText {
    header: Header,
    /// What expressions may name, at every frame.
    names: BTreeMap<String, Vec<f64>>,
    channels: BTreeMap<usize, Vec<f64>>,
    memory: Memory,
}

impl written::LineParser for ProceduralText {
    const FIRST: [&'static str; 2] = ["procedural", "1"];

    fn line(&mut self, _: usize, first: &str, rest: &[&str]) -> Read<()> {
        let begun = !self.names.is_empty();
        if Header::has(first) && !begun {
            return self.header.line(first, rest);
        }
        if Header::has(first) {
            return wrong(format!("`{first}` stands after the first expression; expected it before"));
        }
        let line = [&[first], rest].concat().join(" ");
        let Some((name, expression)) = line.split_once('=') else {
            return wrong(format!("expected {HEADINGS}, let or `CHANNEL = EXPRESSION`, found {}", quoted(&line)));
        };
        self.begin()?;
        match name.trim().strip_prefix("let ") {
            Some(name) => self.name(name.trim(), expression),
            None => self.channel(name.trim(), expression),
        }
    }

    fn finish(mut self, options: &Request) -> Read<Source> {
        let Header { cm_per_unit, looped, .. } = self.header;
        let (frames, fps) = self.header.timing(options.fps, options.memory)?;
        let mut values = self.header.at_rest(frames);
        while let Some((channel, curve)) = self.channels.pop_first() {
            values[channel] = curve;
        }
        let keys = vec![None; values.len()];
        let events = self.header.events();
        let rig = Rig { cm_per_unit: cm_per_unit.unwrap_or(1.0), ..self.header.rig };
        let motion = Motion { rig, frame_time: 1.0 / fps, frames, values, keys, looped, events, origin: Origin::default() };
        Ok(Source { unit_known: cm_per_unit.is_some(), ..Source::plain(motion, Vec::new()) })
    }
}

impl ProceduralText {
    /// The names that every expression may use.
    fn begin(&mut self) -> Read<()> {
        if !self.names.is_empty() {
            return Ok(());
        }
        let (Some(frames), Some(fps)) = (self.header.frames, self.header.fps) else {
            return wrong("expected `fps NUMBER` and `frames NUMBER` before the first expression");
        };
        self.header.timing(None, self.memory)?;
        for (name, scale) in [("f", 1.0), ("t", fps.recip()), ("u", (frames as f64).recip())] {
            self.names.insert(name.into(), (0..frames).map(|frame| frame as f64 * scale).collect());
        }
        Ok(())
    }

    fn name(&mut self, name: &str, expression: &str) -> Read<()> {
        if !is_free(name) || self.names.contains_key(name) {
            let name = quoted(name);
            return wrong(format!("expected a new name of letters, digits and `_` after `let`, found {name}"));
        }
        if self.names.len() >= MOST_NAMES {
            return wrong(format!("more than {MOST_NAMES} names"));
        }
        let (frames, values) = (self.header.frames.unwrap_or(0), self.names.len() + self.header.rig.channels());
        self.memory.check(frames, values)?;
        let values = self.sample(expression)?;
        self.names.insert(name.into(), values);
        Ok(())
    }

    fn channel(&mut self, name: &str, expression: &str) -> Read<()> {
        let channel = match rig::channels(&self.header.rig, name)?[..] {
            [channel] => channel,
            _ => return wrong(format!("expected one channel such as `{name}.Xrotation`, found `{name}`, a joint")),
        };
        let values = self.sample(expression)?;
        if self.channels.insert(channel, values).is_some() {
            return wrong(format!("channel `{name}` has an expression already"));
        }
        Ok(())
    }

    /// The expression's value at every frame.
    fn sample(&self, expression: &str) -> Read<Vec<f64>> {
        let names: Vec<&str> = self.names.keys().map(String::as_str).collect();
        let parsed = Expression::parse(expression, &names).map_err(Wrong::from)?;
        let used: Vec<(usize, &Vec<f64>)> = self.names.values().enumerate().filter(|(name, _)| parsed.uses(*name)).collect();
        let mut values = vec![0.0; names.len()];
        let at = |frame: usize| {
            used.iter().for_each(|&(name, all)| values[name] = all[frame]);
            match parsed.value(&values) {
                value if value.abs() <= LARGEST => Ok(value),
                value => wrong(format!("is {value} at frame {frame}; expected a finite number of at most {LARGEST:e}")),
            }
        };
        (0..self.header.frames.unwrap_or(0)).map(at).collect()
    }
}
