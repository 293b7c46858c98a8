//! BVH that is still being written: a header, then rows, one a line, until the stream ends.
//!
//! Bytes are pushed in pieces of any size, and where they are cut changes nothing. The number after `Frames:` may be missing, 0 or a word, as a program
//! that records does not know it. Other than in a file, a row stands on one line: a line of another length is an error at once, where
//! a reader that waits for the missing numbers would take every later row from the wrong place.

use super::bvh::figure;
use super::replaced;
use super::text::{Words, number_in};
use crate::error::Error;
use crate::motion::Rig;
use crate::note::Note;
use anyhow::{Result, anyhow};
use std::path::{Path, PathBuf};

/// Most bytes of a header: 1023 joints with long names and offsets take a quarter of it.
const MOST_HEADER_BYTES: usize = 1 << 20;
/// Most bytes of a row's line: 1023 numbers of 64 letters.
const MOST_LINE_BYTES: usize = 1 << 16;

/// The header of a [`BvhStream`].
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Head {
    /// The figure; its unit of length is not known.
    pub rig: Rig,
    /// Seconds a frame.
    pub frame_time: f64,
    /// Warnings about the figure.
    pub notes: Vec<Note>,
    /// The number after `Frames:` if it is one above 0, and its line.
    stated: Option<usize>,
    line: usize,
}

/// A BVH stream.
#[derive(Debug)]
pub struct BvhStream {
    name: PathBuf,
    /// The header so far with its line ends as `\n`; behind the header, the line that has not ended.
    pending: Vec<u8>,
    /// Where the line that has not ended begins in `pending`.
    line_start: usize,
    /// Lines that have ended.
    lines: usize,
    /// Whether the last line ended with CR, so that an LF belongs to it.
    after_cr: bool,
    /// Whether the line with `MOTION` has come.
    in_motion: bool,
    head: Option<Head>,
    /// Rows that were not taken yet, each with a value a channel.
    values: Vec<f64>,
    /// Rows that have come.
    rows: u64,
}

impl BvhStream {
    /// A stream from which nothing has come. Errors begin with `name`.
    pub fn new(name: &Path) -> BvhStream {
        BvhStream {
            name: name.into(),
            pending: Vec::new(),
            line_start: 0,
            lines: 0,
            after_cr: false,
            in_motion: false,
            head: None,
            values: Vec::new(),
            rows: 0,
        }
    }

    /// The header; `None` until all of it has come.
    pub fn head(&self) -> Option<&Head> {
        self.head.as_ref()
    }

    /// Rows that have come and were not taken.
    pub fn ready(&self) -> usize {
        self.head.as_ref().map_or(0, |head| self.values.len() / head.rig.channels().max(1))
    }

    /// Takes the next bytes. After an error nothing more can be pushed; rows that stood before it are ready.
    pub fn push(&mut self, mut bytes: &[u8]) -> Result<(), Error> {
        self.pushed(&mut bytes).map_err(|error| Error::of(&error, Error::source))
    }

    fn pushed(&mut self, bytes: &mut &[u8]) -> Result<()> {
        while let Some(&first) = bytes.first() {
            if std::mem::take(&mut self.after_cr) && first == b'\n' {
                *bytes = &bytes[1..];
                continue;
            }
            let end = bytes.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(bytes.len());
            let (line, rest) = bytes.split_at(end);
            self.append(line)?;
            let Some((&mark, rest)) = rest.split_first() else { break };
            self.after_cr = mark == b'\r';
            self.end_line()?;
            *bytes = rest;
        }
        Ok(())
    }

    /// Takes the end of the stream. Fails if it ends within a row or the header, or before as many rows as the header states.
    pub fn end(&mut self) -> Result<(), Error> {
        self.ended().map_err(|error| Error::of(&error, Error::source))
    }

    fn ended(&mut self) -> Result<()> {
        if self.pending.len() > self.line_start {
            self.end_line()?;
        }
        let Some(head) = &self.head else { return self.read_head(true) };
        let (line, rows) = (head.line, self.rows);
        match head.stated {
            Some(stated) if rows < stated as u64 => {
                Err(self.error_at(line, format!("`Frames: {stated}`, but the stream ends after {rows} frames")))
            }
            _ if rows == 0 => Err(self.error_at(line, "the stream ends before its first frame")),
            _ => Ok(()),
        }
    }

    /// The first `frames` rows that are ready, as values of each channel; fewer if fewer are ready.
    pub fn take(&mut self, frames: usize) -> Vec<Vec<f64>> {
        let channels = self.head.as_ref().map_or(0, |head| head.rig.channels());
        let count = frames.min(self.ready()) * channels;
        let mut values = vec![Vec::with_capacity(frames.min(self.ready())); channels];
        for row in self.values[..count].chunks(channels.max(1)) {
            values.iter_mut().zip(row).for_each(|(values, value)| values.push(*value));
        }
        self.values.drain(..count);
        values
    }

    fn append(&mut self, part: &[u8]) -> Result<()> {
        let most = if self.head.is_some() { MOST_LINE_BYTES } else { MOST_HEADER_BYTES };
        if self.pending.len() + part.len() > most {
            let what = if self.head.is_some() { "a line" } else { "a header" };
            return Err(self.error_at(self.lines + 1, format!("{what} of more than {most} bytes")));
        }
        self.pending.extend_from_slice(part);
        Ok(())
    }

    fn end_line(&mut self) -> Result<()> {
        self.lines += 1;
        if self.head.is_some() {
            let line = std::mem::take(&mut self.pending);
            return self.row(&line);
        }
        let line = self.pending[self.line_start..].to_ascii_lowercase();
        let has = |word: &[u8]| line.windows(word.len()).any(|window| window == word);
        self.in_motion |= has(b"motion");
        let may_end = self.in_motion && has(b"time");
        self.pending.push(b'\n');
        self.line_start = self.pending.len();
        // Something else than BVH has no end of a header to wait for.
        let begun = self.pending.iter().any(|byte| !byte.is_ascii_whitespace());
        if may_end || (begun && !super::bvh::begins(&self.pending)) { self.read_head(false) } else { Ok(()) }
    }

    /// Reads the header and what stands behind it on its last line, unless more of it is to come.
    fn read_head(&mut self, at_end: bool) -> Result<()> {
        let mut words = Words::new(&self.name, &self.pending);
        let head = match head(&mut words) {
            Ok(head) => head,
            Err(_) if words.is_at_end() && !at_end => return Ok(()),
            Err(error) => return Err(error),
        };
        let rest = words.rest().to_vec();
        self.pending = Vec::new();
        self.line_start = 0;
        self.head = Some(head);
        self.row(&rest)?;
        if at_end { self.ended() } else { Ok(()) }
    }

    /// Takes a line: a row, or white space.
    fn row(&mut self, line: &[u8]) -> Result<()> {
        let Some(head) = &self.head else { return Ok(()) };
        let (channels, before) = (head.rig.channels(), self.values.len());
        let words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        let mut count = 0;
        for word in words {
            count += 1;
            match number_in(word) {
                Ok(number) if count <= channels => self.values.push(number),
                Ok(_) => {}
                Err(message) => {
                    self.values.truncate(before);
                    return Err(self.error_at(self.lines, message));
                }
            }
        }
        if count != 0 && count != channels {
            self.values.truncate(before);
            return Err(self.error_at(self.lines, format!("expected {channels} numbers, one a channel, found {count}")));
        }
        self.rows += u64::from(count > 0);
        Ok(())
    }

    fn error_at(&self, line: usize, message: impl std::fmt::Display) -> anyhow::Error {
        anyhow!("{}:{line}: {message}", self.name.display())
    }
}

/// Reads the header.
fn head(words: &mut Words) -> Result<Head> {
    let (rig, mut notes) = figure(words)?;
    words.expect("MOTION", "after the hierarchy")?;
    words.expect("Frames", "after MOTION")?;
    let line = words.line();
    words.accept(":");
    let mut stated = None;
    if !words.accept("Frame") {
        let word = words.next();
        stated = word.and_then(|word| std::str::from_utf8(word).ok()?.parse::<usize>().ok()).filter(|&frames| frames > 0);
        words.expect("Frame", "after the number of frames")?;
    }
    words.expect("Time", "after `Frame`")?;
    words.accept(":");
    let frame_time = words.number("the seconds a frame after `Frame Time:`")?;
    if frame_time <= 0.0 {
        return Err(words.error(format!("expected a frame time above 0, found {frame_time}")));
    }
    let channels = rig.channels();
    if channels == 0 {
        return Err(words.error_at(line, "no joint has CHANNELS, so nothing can move"));
    }
    notes.extend(replaced(&rig, &[]));
    Ok(Head { rig, frame_time, notes, stated, line })
}
