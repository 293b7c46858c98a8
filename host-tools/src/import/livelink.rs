//! Live Link Face CSV (ARKit): a timecode, the number of values, then 51 or 52 weights and, in newer files, 9 angles in radians.
//!
//! Names come as Live Link has them (`EyeBlinkLeft`), however the file spells them (`eyeBlinkLeft`, `eyeBlink_L`). Full scale is 1: a whole weight, or a
//! radian, about as far as a head turns; larger where the data are. Frames that the recording dropped are filled by straight lines.

use super::scalars::{self, Grid};
use super::sheet::{Sheet, delimiter};
use super::text::shown;
use super::timecode::{Clock, NTSC, Timecode};
use super::{Options, Source, read_bytes};
use anyhow::{Context, Result};
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
pub fn read(path: &Path, options: &Options) -> Result<Source> {
    let bytes = read_bytes(path)?;
    let mut sheet = Sheet::open(path, &bytes)?;
    let named = |column: usize, name: &str| sheet.header.get(column).is_some_and(|header| header.eq_ignore_ascii_case(name));
    if !named(0, "Timecode") || !named(1, "BlendshapeCount") {
        return Err(sheet.error(1, "expected `Timecode,BlendshapeCount,` and names of blend shapes"));
    }
    let names: Vec<String> = sheet.header[FIRST..].iter().map(|name| live_link_name(name)).collect();
    scalars::check_size(names.len(), 1).map_err(|error| sheet.error(1, error))?;
    let rows = Rows::read(&mut sheet, names.len())?;
    let (grid, fps, mut warnings) = rows.grid(&sheet, names.len())?;
    let fps = options.fps.unwrap_or(fps);
    if rows.untracked > 0 {
        warnings.push(format!("{} rows hold no values, the face being lost: left out", rows.untracked));
    }
    let values: Vec<Vec<f64>> = rows.values.iter().map(|values| grid.fill(values)).collect();
    let motion = scalars::motion(names, &vec![FULL_SCALE; values.len()], values, 1.0 / fps);
    Ok(Source { motion, unit_known: false, warnings })
}

/// `eyeBlinkLeft` and `eyeBlink_L` as `EyeBlinkLeft`.
fn live_link_name(name: &str) -> String {
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
    fn grid(&self, sheet: &Sheet, channels: usize) -> Result<(Grid, f64, Vec<String>)> {
        let clock = Clock::of(&self.codes);
        let mut warnings = Vec::new();
        if clock.guessed {
            warnings.push(format!("too short to tell what its timecode counts to: taken as {} frames a second", clock.rate));
        }
        let counts = self.counts(sheet, &clock)?;
        let Some(grid) = Grid::of(&counts) else {
            if let Some(line) = self.lines.get(1) {
                return Err(sheet.error_in(*line, 0, "the timecode stands still"));
            }
            return Ok((Grid { frames: vec![0], period: 1.0 }, clock.real_rate(), warnings));
        };
        scalars::check_size(channels, grid.len()).map_err(|error| sheet.error(1, error))?;
        let fps = rate(&grid, &clock);
        let (missing, shared) = grid.gaps();
        if let (1.., Some(row)) = (missing, grid.first_gap()) {
            let line = self.lines[row];
            warnings.push(format!(
                "{missing} of {} frames were dropped by the recording (first before line {line}): filled by straight lines",
                grid.len()
            ));
        }
        if shared > 0 {
            warnings.push(format!("{shared} rows have the time of the row above: left out"));
        }
        if (fps * clock.real_rate().recip() * grid.period.round().max(1.0) - 1.0).abs() > 1e-4 {
            warnings.push(format!("rows come {fps:.3} times a second by a timecode of {}", clock.rate));
        }
        Ok((grid, fps, warnings))
    }

    /// Timecodes in frames, which run on over midnight.
    fn counts(&self, sheet: &Sheet, clock: &Clock) -> Result<Vec<f64>> {
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
fn rate(grid: &Grid, clock: &Clock) -> f64 {
    let measured = clock.real_rate() / grid.period;
    let usual = clock.real_rate() / grid.period.round().max(1.0);
    let intervals = (grid.len() - 1) as f64;
    let keeps = |fps: &f64| (intervals * (fps / measured - 1.0)).abs() <= 0.5;
    [usual, usual / NTSC].into_iter().find(keeps).unwrap_or(measured)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::load;
    use crate::motion::Motion;

    fn read_as(name: &str, text: impl AsRef<[u8]>) -> Result<(Motion, Vec<String>)> {
        let path = std::env::temp_dir().join(format!("pantin-livelink-{name}-{}.csv", std::process::id()));
        std::fs::write(&path, text).unwrap();
        let read = load(&path, &Options::default());
        std::fs::remove_file(&path).unwrap();
        read.map(|imported| (imported.motion, imported.warnings))
    }

    const HEADER: &str = "Timecode,BlendshapeCount,EyeBlinkLeft,HeadYaw\n";

    fn error(name: &str, rows: &str) -> String {
        format!("{:#}", read_as(name, format!("{HEADER}{rows}")).unwrap_err())
    }

    /// Rows of one recording: value = frame number / 1000.
    fn recording(codes: impl IntoIterator<Item = (u32, u32, f64)>) -> String {
        let row = |(number, second, frame): (u32, u32, f64)| {
            format!("23:59:{second:02}:{frame:06.3},2,{},-1.25\n", f64::from(number) / 1000.0)
        };
        HEADER.to_string() + &codes.into_iter().map(row).collect::<String>()
    }

    #[test]
    fn dropped_frames_come_back_between_their_neighbours() {
        let codes = (0..90u32)
            .filter(|frame| !(40..43).contains(frame))
            .map(|frame| (frame, 50 + frame / 60, f64::from(frame % 60) + 0.273));
        let (motion, warnings) = read_as("dropped", recording(codes)).unwrap();
        assert_eq!((motion.frames, motion.frame_time), (90, 1.0 / 60.0));
        assert!((0..90).all(|frame| (motion.values[0][frame] - frame as f64 / 1000.0).abs() < 1e-12));
        assert!(
            warnings.iter().any(|warning| warning.starts_with("3 of 90 frames were dropped") && warning.contains("line 42")),
            "{warnings:?}"
        );
        assert_eq!(motion.rig.scalars[0].full_scale, 1.0);
        assert_eq!(motion.rig.scalars[1].full_scale, 1.25);
        assert!(motion.rig.joints.is_empty());
    }

    #[test]
    fn rates_are_told_apart() {
        let thirty = (0..70u32).map(|frame| (frame, frame / 30, f64::from(frame % 30)));
        assert_eq!(read_as("thirty", recording(thirty)).unwrap().0.frame_time, 1.0 / 30.0);
        // A camera at 59.94 Hz by a clock that counts sixtieths: a frame behind after each thousand.
        let at = |row: u32| f64::from(row) * 1.001;
        let slow = (0..1500u32).map(|row| (row, (at(row) / 60.0) as u32, at(row) % 60.0));
        let (motion, _) = read_as("ntsc", recording(slow)).unwrap();
        assert_eq!((motion.frames, motion.frame_time), (1500, 1.001 / 60.0));
        // Neither: as measured.
        let at = |row: u32| f64::from(row) * 1.0016;
        let slow = (0..2000u32).map(|row| (row, (at(row) / 60.0) as u32, at(row) % 60.0));
        let (motion, warnings) = read_as("measured", recording(slow)).unwrap();
        assert!((motion.frame_time * 60.0 - 1.0016).abs() < 1e-5, "{}", motion.frame_time * 60.0);
        assert!(warnings[0].contains("59.904 times a second"), "{warnings:?}");
        // Every second frame of a clock at 60.
        let half = (0..60u32).map(|row| (row, row / 30, f64::from(row % 30 * 2)));
        assert_eq!(read_as("half", recording(half)).unwrap().0.frame_time, 1.0 / 30.0);
    }

    #[test]
    fn a_recording_runs_on_over_midnight() {
        let text =
            format!("{HEADER}23:59:59:58.5,2,0.1,0\n23:59:59:59.5,2,0.2,0\n00:00:00:00.5,2,0.3,0\n00:00:00:02.5,2,0.5,0\n");
        let (motion, _) = read_as("midnight", text).unwrap();
        assert!((motion.values[0][3] - 0.4).abs() < 1e-12 && motion.frames == 5);
    }

    #[test]
    fn names_are_live_links_in_every_spelling() {
        for (header, count) in
            [("timecode,blendshapeCount,eyeBlinkLeft,headYaw", 2), ("Timecode,BlendShapeCount,eyeBlink_L,HeadYaw", 2)]
        {
            let (motion, _) = read_as("names", format!("\u{feff}{header}\r\n1:00:00:00,{count},0.5,0\r\n")).unwrap();
            assert_eq!([motion.rig.channel_name(0), motion.rig.channel_name(1)], ["EyeBlinkLeft", "HeadYaw"]);
        }
        assert_eq!(live_link_name("noseSneer_R"), "NoseSneerRight");
    }

    #[test]
    fn lost_faces_leave_a_gap() {
        let text = format!("{HEADER}0:0:0:0,2,0,0\n0:0:0:1,2,0.1,0\n0:0:0:2,0\n0:0:0:3,2,0.3,0\n");
        let (motion, warnings) = read_as("lost", text).unwrap();
        assert!((motion.values[0][2] - 0.2).abs() < 1e-12);
        assert!(warnings.iter().any(|warning| warning.starts_with("1 rows hold no values")), "{warnings:?}");
    }

    #[test]
    fn what_is_wrong_is_named_with_its_place() {
        assert!(error("empty", "").contains(".csv:1: no row"));
        assert!(error("columns", "0:0:0:0,2,0,0\n0:0:0:1,2,0\n").contains(".csv:3: 3 cells; expected 4"));
        assert!(error("count", "0:0:0:0,61,0,0\n").contains(".csv:2: column 2 (BlendshapeCount): 61 values; the header names 2"));
        assert!(error("nan", "0:0:0:0,2,0,nan\n").contains(".csv:2: column 4 (HeadYaw): expected a finite number"));
        assert!(error("huge", "0:0:0:0,2,1e300,0\n").contains(".csv:2: column 3 (EyeBlinkLeft)"));
        assert!(
            error("code", "noon,2,0,0\n").contains(".csv:2: column 1 (Timecode): expected HH:MM:SS:FF.fraction, found `noon`")
        );
        assert!(error("back", "0:0:0:5,2,0,0\n0:0:0:1,2,0,0\n").contains(".csv:3: column 1 (Timecode): this timecode is before"));
        assert!(error("break", "0:0:0:5,2,0,0\n0:9:0:1,2,0,0\n").contains("is to be split"));
        assert!(
            error("still", "0:0:0:5,2,0,0\n0:0:0:5,2,0,0\n").contains(".csv:3: column 1 (Timecode): the timecode stands still")
        );
        let unnamed = format!("{:#}", read_as("unnamed", "Timecode,BlendshapeCount\n0:0:0:0,0\n").unwrap_err());
        assert!(unnamed.contains(".csv:1: no channels"), "{unnamed}");
        let strange = format!("{:#}", read_as("strange", b"Timecode,BlendshapeCount,Eye\xff\n").unwrap_err());
        assert!(strange.contains(".csv:1: column 3: `Eye\u{fffd}` is not UTF-8"), "{strange}");
    }
}
