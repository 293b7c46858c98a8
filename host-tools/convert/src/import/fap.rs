//! MPEG-4 facial animation parameters as text, version 2.1 (ISO/IEC 14496-2, Annex C): a mask of 68 parameters and their values, frame by frame.
//!
//! Values are in the parameter's unit (`Unit`). The standard fixes units, not ranges: full scale is the greatest value that the file has in
//! the same unit. A parameter that a frame does not give keeps its value; before it is given first it is 0, the neutral face.

use super::fap_names::{EXPRESSION, PARAMETERS, SHORT, Unit, VISEME, values};
use super::scalars::{self, peak};
use super::text::{number_in, shown};
use super::{Request, Source};
use crate::memory::Memory;
use crate::note::{Note, NoteKind};
use anyhow::{Context, Error, Result, anyhow};
use std::path::Path;

/// Whether `head` begins such a file.
pub fn begins(head: &[u8]) -> bool {
    let line = head.trim_ascii_start().split(|&byte| byte == b'\n').next().unwrap_or_default();
    Header::read(line).is_ok()
}

/// Reads the file `path`.
pub fn read(path: &Path, options: &Request) -> Result<Source> {
    let bytes = options.read(path)?;
    let mut reader = FapParser {
        file: path.display().to_string(),
        lines: lines(&bytes).peekable(),
        line: 1,
        columns: Vec::new(),
        given: Vec::new(),
        frames: 0,
    };
    let (line, first) = reader.lines.next().unwrap_or((1, &[]));
    reader.line = line;
    let header =
        Header::read(first).map_err(|wrong| reader.error(format!("expected `2.1 NAME FRAMES-A-SECOND FRAMES`; {wrong}")))?;
    reader.columns = vec![Vec::new(); values().count()];
    reader.given = vec![false; values().count()];
    scalars::check_size(1, header.frames, options.memory).with_context(|| reader.place())?;
    let notes = reader.rows(header.frames)?;
    if !reader.given.contains(&true) {
        return Err(reader.error("no mask sets a parameter, so nothing can move"));
    }
    Ok(Source::plain(reader.motion(header.fps, options.memory)?, notes))
}

struct Header {
    fps: f64,
    frames: usize,
}

impl Header {
    /// Reads the first line, or says which of its words is wrong. A name may have spaces.
    fn read(line: &[u8]) -> Result<Header, String> {
        let words: Vec<&[u8]> = words(line).collect();
        let wrong = |number: usize, what: &str| format!("word {number}, {what}, is {}", shown(Some(words[number - 1])));
        let count = words.len();
        if count == 0 {
            return Err("the line has no words".into());
        }
        if words[0] != b"2.1" {
            return Err(wrong(1, "the version"));
        }
        if count < 3 {
            return Err(format!("the line has {count} of at least 3 words"));
        }
        let fps = number_in(words[count - 2]).ok().filter(|&fps| fps > 0.0);
        let fps = fps.ok_or_else(|| wrong(count - 1, "the frames a second"))?;
        let frames = std::str::from_utf8(words[count - 1]).ok().and_then(|word| word.parse().ok()).filter(|&frames| frames > 0);
        Ok(Header { fps, frames: frames.ok_or_else(|| wrong(count, "the number of frames"))? })
    }
}

/// Lines that are not empty, with their numbers from 1.
fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, &[u8])> {
    let lines = bytes.split(|&byte| byte == b'\n').enumerate();
    lines.map(|(index, line)| (index + 1, line.trim_ascii())).filter(|(_, line)| !line.is_empty())
}

fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

struct FapParser<'a, L: Iterator<Item = (usize, &'a [u8])>> {
    file: String,
    lines: std::iter::Peekable<L>,
    line: usize,
    /// `[value][frame]`, of values that were given once.
    columns: Vec<Vec<f64>>,
    given: Vec<bool>,
    frames: usize,
}

impl<'a, L: Iterator<Item = (usize, &'a [u8])>> FapParser<'a, L> {
    fn error(&self, message: impl std::fmt::Display) -> Error {
        anyhow!("{}: {message}", self.place())
    }

    fn place(&self) -> String {
        format!("{}:{}", self.file, self.line)
    }

    /// Reads rows up to `frames`, and what is odd about them.
    fn rows(&mut self, frames: usize) -> Result<Vec<Note>> {
        let mut notes = Vec::new();
        let (mut first, mut skipped) = (None, 0);
        while let Some((line, mask)) = self.lines.next() {
            self.line = line;
            if self.frames == frames {
                let text = format!("the header says {frames} frames; what follows from line {line} is left out");
                notes.push(Note::warning(NoteKind::Frames, text).at_line(line));
                break;
            }
            let mask = self.mask(mask)?;
            let Some((line, row)) = self.lines.next() else {
                return Err(self.error("expected values after this mask, found the end of the file"));
            };
            self.line = line;
            let (number, row) = self.numbered(row)?;
            let frame = number.checked_sub(*first.get_or_insert(number)).filter(|&frame| frame >= self.frames);
            let Some(frame) = frame else { return Err(self.error(format!("frame {number} stands after a later one"))) };
            if frame >= frames {
                return Err(self.error(format!("frame {number}, but the header says {frames} frames")));
            }
            skipped += frame - self.frames;
            self.hold(frame);
            self.row(&mask, &row)?;
        }
        if skipped > 0 {
            let text = format!("{skipped} frames are not given: they keep the values of the frame before");
            notes.push(Note::warning(NoteKind::Frames, text));
        }
        if self.frames < frames && self.frames > 0 {
            let given = self.frames;
            let text = format!("the header says {frames} frames, but {given} are given: the rest keeps the last values");
            notes.push(Note::warning(NoteKind::Frames, text));
            self.hold(frames);
        }
        Ok(notes)
    }

    fn mask(&self, line: &[u8]) -> Result<Vec<bool>> {
        let bit = |word: &[u8]| match word {
            b"0" => Ok(false),
            b"1" => Ok(true),
            _ => Err(self.error(format!("expected a mask of {PARAMETERS} times 0 or 1, found {}", shown(Some(word))))),
        };
        let mask = words(line).map(bit).collect::<Result<Vec<bool>>>()?;
        if mask.len() == PARAMETERS {
            Ok(mask)
        } else {
            Err(self.error(format!("a mask of {}; expected {PARAMETERS} times 0 or 1", mask.len())))
        }
    }

    /// The frame's number and the values behind it.
    fn numbered(&self, line: &[u8]) -> Result<(usize, Vec<f64>)> {
        let mut words = words(line);
        let first = words.next();
        let number = first.and_then(|word| std::str::from_utf8(word).ok()?.parse().ok());
        let number =
            number.ok_or_else(|| self.error(format!("expected a frame's number before its values, found {}", shown(first))))?;
        let value = |(index, word)| number_in(word).map_err(|message| self.error(format!("value {}: {message}", index + 1)));
        Ok((number, words.enumerate().map(value).collect::<Result<_>>()?))
    }

    /// Keeps the last values up to `frame`.
    fn hold(&mut self, frame: usize) {
        for column in self.columns.iter_mut().filter(|column| !column.is_empty()) {
            let last = column.last().copied().unwrap_or_default();
            column.resize(frame, last);
        }
        self.frames = frame;
    }

    /// Takes the values of the next frame.
    fn row(&mut self, mask: &[bool], row: &[f64]) -> Result<()> {
        let low = mask[2..].iter().filter(|&&set| set).count();
        let lengths = [VISEME.len(), EXPRESSION.len()];
        // Which values parameters 1 and 2 have tells the row's length: no two combinations are equally long.
        let options = |parameter: usize| if mask[parameter] { vec![SHORT[parameter], lengths[parameter]] } else { vec![0] };
        let pairs = options(0).into_iter().flat_map(|viseme| options(1).into_iter().map(move |expression| (viseme, expression)));
        let Some((viseme, expression)) = pairs.into_iter().find(|(viseme, expression)| viseme + expression + low == row.len())
        else {
            let high = if mask[0] || mask[1] { " and 3 or 4 for a viseme, 4 or 6 for an expression" } else { "" };
            return Err(self.error(format!("{} values; the mask sets {low}{high}", row.len())));
        };
        let set = (0..viseme).chain((0..expression).map(|index| VISEME.len() + index));
        let set = set.chain(
            mask[2..].iter().enumerate().filter(|(_, set)| **set).map(|(index, _)| VISEME.len() + EXPRESSION.len() + index),
        );
        for (column, &value) in set.zip(row) {
            self.given[column] = true;
            self.columns[column].resize(self.frames, 0.0);
            self.columns[column].push(value);
        }
        self.hold(self.frames + 1);
        Ok(())
    }

    fn motion(self, fps: f64, memory: Memory) -> Result<crate::motion::Motion> {
        let unit_peak = |unit: Unit| {
            let same = values().zip(&self.columns).filter(|((_, other), _)| *other == unit);
            same.fold(0f64, |greatest, (_, column)| greatest.max(peak(column)))
        };
        let given = || values().zip(&self.given).filter(|(_, given)| **given).map(|(value, _)| value);
        let scale = |(_, unit)| match unit {
            Unit::Of(most) => f64::from(most),
            unit => unit_peak(unit),
        };
        let names: Vec<String> = given().map(|(name, _)| name.to_string()).collect();
        let scales: Vec<f64> = given().map(scale).collect();
        let place = self.place();
        scalars::check_size(names.len(), self.frames, memory).context(place)?;
        let columns = self.columns.into_iter().zip(&self.given).filter(|(_, given)| **given).map(|(column, _)| column).collect();
        Ok(scalars::motion(names, &scales, columns, 1.0 / fps))
    }
}
