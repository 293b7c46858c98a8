//! Tables of any channels: a row of names, then a row of values a frame, between commas, tabs or semicolons.
//!
//! The first two columns may be a time in seconds (`time`, `t`, `seconds`, `timestamp`, `Time (s)`), in another unit (`time_ms`, `us`) or a frame's number (`frame`, or no
//! name at all). Without a time, `--fps` is needed; with a time, `--fps` takes the values on straight lines at that rate, and without it the rows must
//! be even but for missing ones. Full scale is a channel's own greatest value, whatever its sign.

use super::scalars::{self, Grid, LEAST_SCALE};
use super::sheet::{Row, Sheet, delimiter};
use super::text::quoted;
use super::{Request, Source};
use crate::error::with_remedy;
use crate::events;
use crate::memory::Memory;
use crate::motion::Event;
use crate::note::{Note, NoteKind, Remedy};
use anyhow::{Context, Result};
use std::path::Path;

/// A row may be this far from its place, as a part of a frame: times are written with few digits.
const JITTER: f64 = 0.3;
/// Rates that times written with few digits stand for.
const USUAL: [f64; 16] = [23.976, 24.0, 25.0, 29.97, 30.0, 48.0, 50.0, 59.94, 60.0, 72.0, 90.0, 100.0, 120.0, 10.0, 15.0, 20.0];

/// A usual rate is an assumption where it is farther from the measured one, as a part of it.
const ASSUMED: f64 = 5e-3;
/// Rounding of times changes the rate that they give by less than this part of it, but for a few rows, whose times are taken as they stand.
const HARDLY: f64 = 0.02;
/// No usual rate is farther from the measured one than this part of it: two whole seconds are one frame a second.
const FARTHEST: f64 = 0.5;
/// Rows at a higher rate are refused: that is a unit of time other than seconds.
const MOST_FPS: f64 = 1000.0;

/// Whether `head` begins such a file: a second line that begins with a number, and delimiters in the first.
pub fn begins(head: &[u8]) -> bool {
    let delimiter = delimiter(head);
    let mut lines = head.split(|&byte| byte == b'\n');
    let (Some(names), Some(values)) = (lines.next(), lines.next()) else { return false };
    let first = values.split(|&byte| byte == delimiter).next().unwrap_or_default().trim_ascii();
    names.contains(&delimiter) && std::str::from_utf8(first).is_ok_and(|first| first.parse::<f64>().is_ok())
}

/// Reads the file `path`.
pub fn read(path: &Path, options: &Request) -> Result<Source> {
    let bytes = options.read(path)?;
    let mut sheet = Sheet::open(path, &bytes)?;
    let clock = TimeColumns::of(&sheet.header);
    if let Some(column) = (clock.columns..sheet.header.len()).find(|&column| sheet.header[column].is_empty()) {
        return Err(sheet.error_in(1, column, "expected a name"));
    }
    let channels: Vec<usize> = (clock.columns..sheet.header.len()).filter(|&column| !is_events(&sheet.header[column])).collect();
    let names: Vec<String> = channels.iter().map(|&column| sheet.header[column].clone()).collect();
    scalars::check_size(names.len(), 1, options.memory).with_context(|| sheet.place(1))?;
    let rows = Rows::read(&mut sheet, &clock, &channels)?;
    let memory = options.memory;
    let (values, fps, mut notes) = match (clock.time, options.fps) {
        (Some(_), Some(fps)) => (rows.at_rate(&sheet, fps, memory)?, fps, Vec::new()),
        (Some(_), None) => rows.timed(&sheet, memory)?,
        (None, Some(fps)) => {
            let (values, notes) = rows.numbered(&sheet, memory)?;
            (values, fps, notes)
        }
        (None, None) => {
            let error = sheet.error(1, "no column of times (`time`, in seconds)");
            return Err(with_remedy(&error, Remedy::StateFrameRate));
        }
    };
    if clock.time.is_none()
        && let Some(name) =
            names.iter().find(|name| unit_of_time(name).is_some() || name.to_ascii_lowercase().starts_with("time"))
    {
        let name = quoted(name);
        let text = format!(
            "column {name} becomes a channel: times stand in the first column or behind frame numbers, and are called `time`, `Time (ms)` or the like"
        );
        notes.push(Note::warning(NoteKind::Unread, text));
    }
    let largest = |values: &[f64]| values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    for (name, largest) in names.iter().zip(&values).map(|(name, values)| (name, largest(values))) {
        if largest > 0.0 && largest < LEAST_SCALE {
            let name = quoted(name);
            let text = format!(
                "column {name} stays within {largest:e}; the least full scale is {LEAST_SCALE:e}, and errors are parts of it: another unit keeps it"
            );
            notes.push(Note::warning(NoteKind::Scale, text));
        }
    }
    let scales = vec![0.0; values.len()];
    let mut motion = scalars::motion(names, &scales, values, 1.0 / fps);
    let per_second = if clock.time.is_some() { fps } else { 1.0 };
    let frame = |time: f64| (((time - rows.times[0]) * per_second).round() as usize).min(motion.frames - 1);
    motion.events = rows.events.iter().map(|(time, name)| Event { frame: frame(*time), name: name.clone() }).collect();
    let sampled = clock.time.is_some() && options.fps.is_some();
    Ok(Source { sampled, ..Source::plain(motion, notes) })
}

/// Whether a column of this name holds names of events.
fn is_events(name: &str) -> bool {
    ["event", "events"].iter().any(|known| name.eq_ignore_ascii_case(known))
}

/// What the first columns say about time.
struct TimeColumns {
    /// Column and length of its unit in seconds.
    time: Option<(usize, f64)>,
    frame: Option<usize>,
    /// How many columns are not channels.
    columns: usize,
}

impl TimeColumns {
    fn of(header: &[String]) -> TimeColumns {
        let mut clock = TimeColumns { time: None, frame: None, columns: 0 };
        for (column, name) in header.iter().enumerate().take(2) {
            match name.to_ascii_lowercase().as_str() {
                "" | "frame" | "frames" | "frame_number" | "#" if clock.frame.is_none() => clock.frame = Some(column),
                name => match unit_of_time(name).filter(|_| clock.time.is_none()) {
                    Some(unit) => clock.time = Some((column, unit)),
                    None => break,
                },
            }
            clock.columns = column + 1;
        }
        clock
    }
}

/// The length in seconds of the unit of a column with times, by its name: `time`, `timestamp` or `t`, a unit, or both, as in `Time (ms)`.
fn unit_of_time(name: &str) -> Option<f64> {
    let plain: String = name.to_ascii_lowercase().chars().filter(|letter| !" _()[].-/".contains(*letter)).collect();
    let unit = ["timestamp", "time", ""].into_iter().find_map(|begin| plain.strip_prefix(begin)).unwrap_or_default();
    match unit.strip_prefix("in").unwrap_or(unit) {
        "" | "t" => (!plain.is_empty()).then_some(1.0),
        "s" | "ts" | "sec" | "secs" | "second" | "seconds" => Some(1.0),
        "ms" | "tms" | "msec" | "msecs" | "millis" | "millisecond" | "milliseconds" => Some(1e-3),
        "us" | "tus" | "usec" | "micros" | "microsecond" | "microseconds" => Some(1e-6),
        "ns" | "tns" | "nsec" | "nanos" | "nanosecond" | "nanoseconds" => Some(1e-9),
        _ => None,
    }
}

struct Rows {
    lines: Vec<u64>,
    /// Seconds, or a frame's number, or the row's own.
    times: Vec<f64>,
    /// Column that the times are from.
    column: usize,
    /// `values[channel][row]`.
    values: Vec<Vec<f64>>,
    /// Time and name.
    events: Vec<(f64, String)>,
}

impl Rows {
    fn read(sheet: &mut Sheet, clock: &TimeColumns, channels: &[usize]) -> Result<Rows> {
        let column = clock.time.map(|(column, _)| column).or(clock.frame);
        let mut rows = Rows {
            lines: Vec::new(),
            times: Vec::new(),
            column: column.unwrap_or(0),
            values: vec![Vec::new(); channels.len()],
            events: Vec::new(),
        };
        while let Some(row) = sheet.next()? {
            sheet.whole(&row)?;
            let time = match (clock.time, column) {
                (Some((column, unit)), _) => sheet.number(&row, column)? * unit,
                (None, Some(column)) => frame_number(sheet, &row, column)?,
                (None, None) => rows.times.len() as f64,
            };
            if rows.times.last().is_some_and(|&before| before >= time) {
                return Err(sheet.error_in(row.line, rows.column, "expected more than in the row above"));
            }
            rows.times.push(time);
            rows.lines.push(row.line);
            for (&channel, values) in channels.iter().zip(&mut rows.values) {
                values.push(sheet.number(&row, channel)?);
            }
            for column in (clock.columns..sheet.header.len()).filter(|&column| is_events(&sheet.header[column])) {
                let names = String::from_utf8_lossy(row.cell(column)).into_owned();
                for name in names.split('|').map(str::trim).filter(|name| !name.is_empty()) {
                    events::check_name(name).map_err(|error| sheet.error_in(row.line, column, error))?;
                    rows.events.push((time, name.into()));
                }
            }
        }
        if rows.times.is_empty() {
            return Err(sheet.error(1, "no row of values below the header"));
        }
        Ok(rows)
    }

    /// Rows by their frames' numbers.
    fn numbered(&self, sheet: &Sheet, memory: Memory) -> Result<(Vec<Vec<f64>>, Vec<Note>)> {
        let frames: Vec<usize> = self.times.iter().map(|time| (time - self.times[0]) as usize).collect();
        let grid = Grid { frames, period: 1.0 };
        scalars::check_size(self.values.len(), grid.len(), memory).with_context(|| sheet.place(1))?;
        Ok((self.filled(&grid), self.gaps(&grid)))
    }

    /// Rows by their times, which must be even; frames a second; and what is odd.
    fn timed(&self, sheet: &Sheet, memory: Memory) -> Result<(Vec<Vec<f64>>, f64, Vec<Note>)> {
        let Some(grid) = Grid::of(&self.times) else {
            let error = sheet.error(self.lines[0], "one row tells no frame rate");
            return Err(with_remedy(&error, Remedy::StateFrameRate));
        };
        scalars::check_size(self.values.len(), grid.len(), memory).with_context(|| sheet.place(1))?;
        if let Some(row) = self.first_uneven(&grid) {
            let message = format!("this time is between the frames of rows {:.6} s apart", grid.period);
            let error = sheet.error_in(self.lines[row], self.column, message);
            return Err(with_remedy(&error, Remedy::StateFrameRate));
        }
        let (rate, assumed) = usual_rate(&grid, &self.times);
        if rate > MOST_FPS {
            let message = format!("rows {:.3e} s apart are {rate:.0} frames a second", grid.period);
            let error = sheet.error_in(self.lines[0], self.column, message);
            return Err(with_remedy(&error, Remedy::LowerFrameRate));
        }
        let warning = assumed.then(|| {
            let measured = grid.period.recip();
            let text = format!("{rate} frames a second are assumed, as times have few digits (they give {measured:.3})");
            Note::warning(NoteKind::FrameRate, text).remedy(Remedy::ChangeFrameRate)
        });
        Ok((self.filled(&grid), rate, self.gaps(&grid).into_iter().chain(warning).collect()))
    }

    /// The first row that is too far from its frame, or has another's.
    fn first_uneven(&self, grid: &Grid) -> Option<usize> {
        let off = |row: usize| (self.times[row] - self.times[0]) / grid.period - grid.frames[row] as f64;
        (1..self.times.len()).find(|&row| off(row).abs() > JITTER || grid.frames[row] == grid.frames[row - 1])
    }

    /// The times of the rows: of even ones that were rounded, those before rounding, at `fps`, a part of it, or a usual rate if that explains them.
    fn exact_times(&self, fps: f64) -> Vec<f64> {
        let Some(grid) = Grid::of(&self.times).filter(|grid| self.first_uneven(grid).is_none()) else {
            return self.times.clone();
        };
        let off = |rate: &f64| (rate * grid.period - 1.0).abs();
        let likely = |rate: &f64| explains(*rate, &grid, &self.times) && off(rate) < HARDLY;
        let parts = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0].map(|part| [fps / part, fps * part]);
        let given = parts.into_iter().flatten().filter(likely).min_by(|a, b| off(a).total_cmp(&off(b)));
        match given.or_else(|| Some(usual_rate(&grid, &self.times).0).filter(likely)) {
            Some(rate) => grid.frames.iter().map(|&frame| frame as f64 / rate).collect(),
            None => self.times.clone(),
        }
    }

    /// The values on straight lines between the rows, `fps` times a second.
    fn at_rate(&self, sheet: &Sheet, fps: f64, memory: Memory) -> Result<Vec<Vec<f64>>> {
        let times = self.exact_times(fps);
        let (first, last) = (times[0], times[times.len() - 1]);
        // A last row that rounding puts just before a frame is that frame.
        let frames = ((last - first) * fps + 1e-6) as usize + 1;
        scalars::check_size(self.values.len(), frames, memory).with_context(|| sheet.place(1))?;
        let sampled = |values: &Vec<f64>| {
            let mut row = 0;
            let mut at = |frame: usize| {
                let time = first + frame as f64 / fps;
                // A row that rounding puts just behind a frame is that frame's.
                while row + 1 < times.len() && times[row + 1] <= time + 1e-6 / fps {
                    row += 1;
                }
                let Some(next) = times.get(row + 1) else { return values[row] };
                let part = ((time - times[row]) / (next - times[row])).max(0.0);
                values[row] + part * (values[row + 1] - values[row])
            };
            (0..frames).map(&mut at).collect()
        };
        Ok(self.values.iter().map(sampled).collect())
    }

    fn filled(&self, grid: &Grid) -> Vec<Vec<f64>> {
        self.values.iter().map(|values| grid.fill(values)).collect()
    }

    fn gaps(&self, grid: &Grid) -> Vec<Note> {
        let Some(row) = grid.first_gap() else { return Vec::new() };
        let (missing, line) = (grid.gaps().0, self.lines[row]);
        let text = format!("{missing} of {} frames have no row (first before line {line}): filled by straight lines", grid.len());
        vec![Note::warning(NoteKind::Frames, text).at_line(line as usize)]
    }
}

fn frame_number(sheet: &Sheet, row: &Row, column: usize) -> Result<f64> {
    let number = sheet.number(row, column)?;
    if number.fract() == 0.0 {
        Ok(number)
    } else {
        Err(sheet.error_in(row.line, column, format!("expected a whole frame's number, found {number}")))
    }
}

/// The usual rate nearest to the measured one, if it [`explains`] the times; else the measured one. Returns also whether it is an assumption: another
/// rate than the times give.
fn usual_rate(grid: &Grid, times: &[f64]) -> (f64, bool) {
    let measured = grid.period.recip();
    let far = |rate: &f64| (rate / measured - 1.0).abs();
    let nearest = USUAL.into_iter().min_by(|a, b| far(a).total_cmp(&far(b)));
    let rate = nearest.filter(|&rate| explains(rate, grid, times)).unwrap_or(measured);
    (rate, far(&rate) > ASSUMED)
}

/// Whether rows at a rate have these times, as far as their digits go.
fn explains(rate: f64, grid: &Grid, times: &[f64]) -> bool {
    let rounding = last_digit(times);
    let place = |(&time, &frame): (&f64, &usize)| (time - times[0] - frame as f64 / rate).abs();
    (rate * grid.period - 1.0).abs() < FARTHEST && times.iter().zip(&grid.frames).all(|row| place(row) <= rounding)
}

/// The place value of the last decimal digit that any of `times` has. No two of them are closer.
fn last_digit(times: &[f64]) -> f64 {
    let closest = times.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
    let whole =
        |scale: f64| closest * scale > 0.5 && times.iter().all(|time| (time * scale - (time * scale).round()).abs() < 1e-3);
    let scales = (0..9).map(|digits| 10f64.powi(digits));
    scales.into_iter().find(|&scale| whole(scale)).unwrap_or(1e9).recip()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_told_by_its_second_line() {
        assert!(begins(b"a,b\n1,2\n") && begins(b"a\tb\n-1e3\t2\n"));
        assert!(!begins(b"a,b\nc,d\n") && !begins(b"a\n1\n") && !begins(b""));
    }
}
