//! Live Link Face CSV (ARKit): a timecode, the number of values, then 51 or 52 weights and, in newer files, 9 angles in radians.
//!
//! Names come as Live Link has them (`EyeBlinkLeft`), however the file spells them (`eyeBlinkLeft`, `eyeBlink_L`). Full scale is 1: a whole weight, or a
//! radian, about as far as a head turns; larger where the data are. Frames that the recording dropped are filled by straight lines.

use super::scalars::{self, Grid};
use super::sheet::{Sheet, delimiter};
use super::text::{quoted, shown};
use super::timecode::{NTSC, Timecode, TimecodeCount};
use super::{Request, Source};
use crate::note::{Note, NoteKind};
use anyhow::{Context, Result};
use std::collections::HashMap;
use std::path::Path;

/// Full scale of weights, and of angles in radians.
const FULL_SCALE: f64 = 1.0;
/// A recording that stops for longer, in seconds, is another recording.
const LONGEST_GAP: f64 = 60.0;
/// Columns before the first value.
const FIRST: usize = 2;

/// Whether `head` begins such a file.
pub fn begins(head: &[u8]) -> bool {
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head).trim_ascii_start().to_ascii_lowercase();
    head.strip_prefix(b"timecode")
        .is_some_and(|rest| rest.first() == Some(&delimiter(&head)) && rest[1..].starts_with(b"blendshapecount"))
}

/// Reads the file `path`.
pub fn read(path: &Path, options: &Request) -> Result<Source> {
    let bytes = options.read(path)?;
    let mut sheet = Sheet::open(path, &bytes)?;
    let named = |column: usize, name: &str| sheet.header.get(column).is_some_and(|header| header.eq_ignore_ascii_case(name));
    if !named(0, "Timecode") || !named(1, "BlendshapeCount") {
        return Err(sheet.error(1, "expected `Timecode,BlendshapeCount,` and names of blend shapes"));
    }
    let names: Vec<String> = sheet.header[FIRST..].iter().map(|name| live_link_name(name)).collect();
    scalars::check_size(names.len(), 1, options.memory).with_context(|| sheet.place(1))?;
    let mut columns = HashMap::new();
    for (column, name) in names.iter().enumerate() {
        if let Some(other) = columns.insert(name, column) {
            let [first, later] = [other, column].map(|column| quoted(&sheet.header[FIRST + column]));
            return Err(sheet.error(1, format!("the columns {first} and {later} are one blend shape")));
        }
    }
    let rows = Rows::read(&mut sheet, names.len())?;
    let (grid, fps, mut notes) = rows.grid(&sheet, names.len(), options)?;
    if rows.untracked > 0 {
        let text = format!("{} rows hold no values, the face being lost: left out", rows.untracked);
        notes.push(Note::warning(NoteKind::Frames, text));
    }
    let values: Vec<Vec<f64>> = rows.values.iter().map(|values| grid.fill(values)).collect();
    let motion = scalars::motion(names, &vec![FULL_SCALE; values.len()], values, 1.0 / fps);
    Ok(Source::plain(motion, notes))
}

/// `eyeBlinkLeft` and `eyeBlink_L` as `EyeBlinkLeft`.
pub fn live_link_name(name: &str) -> String {
    let (stem, side) = match (name.strip_suffix("_L"), name.strip_suffix("_R")) {
        (Some(stem), _) => (stem, "Left"),
        (_, Some(stem)) => (stem, "Right"),
        _ => (name, ""),
    };
    let mut letters = stem.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).chain(side.chars()).collect())
}

/// The rows that hold values.
struct Rows {
    lines: Vec<u64>,
    codes: Vec<Timecode>,
    /// `values[channel][row]`.
    values: Vec<Vec<f64>>,
    /// Rows without values.
    untracked: usize,
}

impl Rows {
    fn read(sheet: &mut Sheet, channels: usize) -> Result<Rows> {
        let mut rows = Rows { lines: Vec::new(), codes: Vec::new(), values: vec![Vec::new(); channels], untracked: 0 };
        while let Some(row) = sheet.next()? {
            let code = Timecode::parse(row.cell(0)).with_context(|| {
                let message = format!("expected HH:MM:SS:FF.fraction, found {}", shown(Some(row.cell(0))));
                format!("{:#}", sheet.error_in(row.line, 0, message))
            })?;
            let count = sheet.number(&row, 1)?;
            if count == 0.0 {
                rows.untracked += 1;
                continue;
            }
            if count != channels as f64 {
                return Err(sheet.error_in(row.line, 1, format!("{count} values; the header names {channels}")));
            }
            sheet.whole(&row)?;
            for (channel, values) in rows.values.iter_mut().enumerate() {
                values.push(sheet.number(&row, FIRST + channel)?);
            }
            rows.lines.push(row.line);
            rows.codes.push(code);
        }
        if rows.codes.is_empty() {
            return Err(sheet.error(1, "no row below the header holds values"));
        }
        Ok(rows)
    }

    /// The frames of the rows, frames a second, and what is odd about them.
    fn grid(&self, sheet: &Sheet, channels: usize, options: &Request) -> Result<(Grid, f64, Vec<Note>)> {
        let clock = TimecodeCount::of(&self.codes);
        let mut notes = Vec::new();
        if clock.guessed {
            let text = format!("too short to tell what its timecode counts to: taken as {} frames a second", clock.rate);
            notes.push(Note::warning(NoteKind::FrameRate, text));
        }
        let counts = self.counts(sheet, &clock)?;
        let Some(grid) = Grid::of(&counts) else {
            if let Some(line) = self.lines.get(1) {
                return Err(sheet.error_in(*line, 0, "the timecode stands still"));
            }
            return Ok((Grid { frames: vec![0], period: 1.0 }, clock.real_rate(), notes));
        };
        scalars::check_size(channels, grid.len(), options.memory).with_context(|| sheet.place(1))?;
        let fps = rate(&grid, &clock);
        let (missing, shared) = grid.gaps();
        if let (1.., Some(row)) = (missing, grid.first_gap()) {
            let line = self.lines[row];
            let text = format!(
                "{missing} of {} frames were dropped by the recording (first before line {line}): filled by straight lines",
                grid.len()
            );
            notes.push(Note::warning(NoteKind::Frames, text).at_line(line as usize));
        }
        if shared > 0 {
            let text = format!("{shared} rows have the time of the row above: left out");
            notes.push(Note::warning(NoteKind::Frames, text));
        }
        if (fps * clock.real_rate().recip() * grid.period.round().max(1.0) - 1.0).abs() > 1e-4 {
            let text = format!("rows come {fps:.3} times a second by a timecode of {}", clock.rate);
            notes.push(Note::warning(NoteKind::FrameRate, text));
        }
        Ok((grid, fps, notes))
    }

    /// Timecodes in frames, which run on over midnight.
    fn counts(&self, sheet: &Sheet, clock: &TimecodeCount) -> Result<Vec<f64>> {
        let mut counts: Vec<f64> = Vec::with_capacity(self.codes.len());
        let mut days = 0.0;
        for (code, &line) in self.codes.iter().zip(&self.lines) {
            let mut count = clock.count(code) + days;
            if let Some(&before) = counts.last() {
                if before - count > clock.day() / 2.0 {
                    days += clock.day();
                    count += clock.day();
                }
                let seconds = (count - before) / clock.real_rate();
                if seconds < 0.0 {
                    return Err(sheet.error_in(line, 0, "this timecode is before that of the row above"));
                }
                if seconds > LONGEST_GAP {
                    let message = format!(
                        "{seconds:.0} s after the row above; a recording that stops for more than {LONGEST_GAP} s is to be split"
                    );
                    return Err(sheet.error_in(line, 0, message));
                }
            }
            counts.push(count);
        }
        Ok(counts)
    }
}

/// Frames a second: what the timecode says, or NTSC's, if every row stays within half a frame of it; else as measured.
fn rate(grid: &Grid, clock: &TimecodeCount) -> f64 {
    let measured = clock.real_rate() / grid.period;
    let usual = clock.real_rate() / grid.period.round().max(1.0);
    let intervals = (grid.len() - 1) as f64;
    let keeps = |fps: &f64| (intervals * (fps / measured - 1.0)).abs() <= 0.5;
    [usual, usual / NTSC].into_iter().find(keeps).unwrap_or(measured)
}
