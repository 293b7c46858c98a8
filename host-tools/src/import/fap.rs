//! MPEG-4 facial animation parameters as text, version 2.1 (ISO/IEC 14496-2, Annex C): a mask of 68 parameters and their values, frame by frame.
//!
//! Values are in the parameter's unit ([`Unit`]). The standard fixes units, not ranges: full scale is the greatest value that the file has in
//! the same unit. A parameter that a frame does not give keeps its value; before it is given first it is 0, the neutral face.

use super::scalars::{self, peak};
use super::text::{number_in, shown};
use super::{Options, Source, read_bytes};
use anyhow::{Error, Result, anyhow};
use std::path::Path;

/// Low-level parameters and the two of a higher level.
pub const PARAMETERS: usize = 68;

/// What a value of 1 is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Iris diameter / 1024.
    Irisd,
    /// Eye separation / 1024.
    Es,
    /// Eye-nose separation / 1024.
    Ens,
    /// Mouth-nose separation / 1024.
    Mns,
    /// Mouth width / 1024.
    Mw,
    /// Angle unit: 10^-5 radians.
    Au,
    /// A choice among so many, or a part of so many.
    Of(u8),
}

use Unit::{Au, Ens, Es, Irisd, Mns, Mw, Of};

/// Names and units of parameters 3 to 68, in order.
const LOW: [(&str, Unit); PARAMETERS - 2] = [
    ("open_jaw", Mns),
    ("lower_t_midlip", Mns),
    ("raise_b_midlip", Mns),
    ("stretch_l_cornerlip", Mw),
    ("stretch_r_cornerlip", Mw),
    ("lower_t_lip_lm", Mns),
    ("lower_t_lip_rm", Mns),
    ("raise_b_lip_lm", Mns),
    ("raise_b_lip_rm", Mns),
    ("raise_l_cornerlip", Mns),
    ("raise_r_cornerlip", Mns),
    ("thrust_jaw", Mns),
    ("shift_jaw", Mw),
    ("push_b_lip", Mns),
    ("push_t_lip", Mns),
    ("depress_chin", Mns),
    ("close_t_l_eyelid", Irisd),
    ("close_t_r_eyelid", Irisd),
    ("close_b_l_eyelid", Irisd),
    ("close_b_r_eyelid", Irisd),
    ("yaw_l_eyeball", Au),
    ("yaw_r_eyeball", Au),
    ("pitch_l_eyeball", Au),
    ("pitch_r_eyeball", Au),
    ("thrust_l_eyeball", Es),
    ("thrust_r_eyeball", Es),
    ("dilate_l_pupil", Irisd),
    ("dilate_r_pupil", Irisd),
    ("raise_l_i_eyebrow", Ens),
    ("raise_r_i_eyebrow", Ens),
    ("raise_l_m_eyebrow", Ens),
    ("raise_r_m_eyebrow", Ens),
    ("raise_l_o_eyebrow", Ens),
    ("raise_r_o_eyebrow", Ens),
    ("squeeze_l_eyebrow", Es),
    ("squeeze_r_eyebrow", Es),
    ("puff_l_cheek", Es),
    ("puff_r_cheek", Es),
    ("lift_l_cheek", Ens),
    ("lift_r_cheek", Ens),
    ("shift_tongue_tip", Mw),
    ("raise_tongue_tip", Mns),
    ("thrust_tongue_tip", Mw),
    ("raise_tongue", Mns),
    ("tongue_roll", Au),
    ("head_pitch", Au),
    ("head_yaw", Au),
    ("head_roll", Au),
    ("lower_t_midlip_o", Mns),
    ("raise_b_midlip_o", Mns),
    ("stretch_l_cornerlip_o", Mw),
    ("stretch_r_cornerlip_o", Mw),
    ("lower_t_lip_lm_o", Mns),
    ("lower_t_lip_rm_o", Mns),
    ("raise_b_lip_lm_o", Mns),
    ("raise_b_lip_rm_o", Mns),
    ("raise_l_cornerlip_o", Mns),
    ("raise_r_cornerlip_o", Mns),
    ("stretch_l_nose", Ens),
    ("stretch_r_nose", Ens),
    ("raise_nose", Ens),
    ("bend_nose", Ens),
    ("raise_l_ear", Ens),
    ("raise_r_ear", Ens),
    ("pull_l_ear", Ens),
    ("pull_r_ear", Ens),
];

/// What parameter 1 holds: files leave out the last one or do not.
const VISEME: [(&str, Unit); 4] =
    [("viseme_select1", Of(14)), ("viseme_select2", Of(14)), ("viseme_blend", Of(63)), ("viseme_def", Of(1))];

/// What parameter 2 holds: files leave out the last two or do not.
const EXPRESSION: [(&str, Unit); 6] = [
    ("expression_select1", Of(6)),
    ("expression_intensity1", Of(63)),
    ("expression_select2", Of(6)),
    ("expression_intensity2", Of(63)),
    ("init_face", Of(1)),
    ("expression_def", Of(1)),
];

/// Values of parameters 1 and 2 without those that files leave out.
const SHORT: [usize; 2] = [3, 4];

/// Name and unit of each value, in the order of a row that gives all.
fn values() -> impl Iterator<Item = (&'static str, Unit)> {
    VISEME.into_iter().chain(EXPRESSION).chain(LOW)
}

/// Whether `head` begins such a file.
pub fn begins(head: &[u8]) -> bool {
    let line = head.trim_ascii_start().split(|&byte| byte == b'\n').next().unwrap_or_default();
    Header::read(line).is_some()
}

/// Reads the file `path`.
pub fn read(path: &Path, options: &Options) -> Result<Source> {
    let bytes = read_bytes(path)?;
    let mut reader = Reader {
        file: path.display().to_string(),
        lines: lines(&bytes).peekable(),
        line: 1,
        columns: Vec::new(),
        given: Vec::new(),
        frames: 0,
    };
    let (_, first) = reader.lines.next().unwrap_or((1, &[]));
    let Some(header) = Header::read(first) else {
        return Err(reader.error(format!("expected `2.1 NAME FRAMES-A-SECOND FRAMES`, found {}", shown(Some(first)))));
    };
    reader.columns = vec![Vec::new(); values().count()];
    reader.given = vec![false; values().count()];
    scalars::check_size(1, header.frames).map_err(|error| reader.error(error))?;
    let warnings = reader.rows(header.frames)?;
    if !reader.given.contains(&true) {
        return Err(reader.error("no mask sets a parameter, so nothing can move"));
    }
    let fps = options.fps.unwrap_or(header.fps);
    Ok(Source { motion: reader.motion(fps)?, unit_known: false, warnings })
}

struct Header {
    fps: f64,
    frames: usize,
}

impl Header {
    fn read(line: &[u8]) -> Option<Header> {
        let text = String::from_utf8_lossy(line);
        let words: Vec<&str> = text.split_whitespace().collect();
        let ["2.1", .., fps, frames] = words[..] else { return None };
        let fps = number_in(fps.as_bytes()).ok().filter(|&fps| fps > 0.0)?;
        Some(Header { fps, frames: frames.parse().ok().filter(|&frames| frames > 0)? })
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

struct Reader<'a, L: Iterator<Item = (usize, &'a [u8])>> {
    file: String,
    lines: std::iter::Peekable<L>,
    line: usize,
    /// `[value][frame]`, of values that were given once.
    columns: Vec<Vec<f64>>,
    given: Vec<bool>,
    frames: usize,
}

impl<'a, L: Iterator<Item = (usize, &'a [u8])>> Reader<'a, L> {
    fn error(&self, message: impl std::fmt::Display) -> Error {
        anyhow!("{}:{}: {message}", self.file, self.line)
    }

    /// Reads rows up to `frames`, and what is odd about them.
    fn rows(&mut self, frames: usize) -> Result<Vec<String>> {
        let mut warnings = Vec::new();
        let (mut first, mut skipped) = (None, 0);
        while let Some((line, mask)) = self.lines.next() {
            self.line = line;
            if self.frames == frames {
                warnings.push(format!("the header says {frames} frames; what follows from line {line} is left out"));
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
            warnings.push(format!("{skipped} frames are not given: they keep the values of the frame before"));
        }
        if self.frames < frames && self.frames > 0 {
            warnings
                .push(format!("the header says {frames} frames, but {} are given: the rest keeps the last values", self.frames));
            self.hold(frames);
        }
        Ok(warnings)
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

    fn motion(self, fps: f64) -> Result<crate::motion::Motion> {
        let unit_peak = |unit: Unit| {
            let same = values().zip(&self.columns).filter(|((_, other), _)| *other == unit);
            same.fold(0f64, |greatest, (_, column)| greatest.max(peak(column)))
        };
        let given = || values().zip(&self.given).filter(|(_, given)| **given).map(|(value, _)| value);
        let scale = |(_, unit)| match unit {
            Of(most) => f64::from(most),
            unit => unit_peak(unit),
        };
        let names: Vec<String> = given().map(|(name, _)| name.to_string()).collect();
        let scales: Vec<f64> = given().map(scale).collect();
        scalars::check_size(names.len(), self.frames).map_err(|error| self.error(error))?;
        let columns = self.columns.into_iter().zip(&self.given).filter(|(_, given)| **given).map(|(column, _)| column).collect();
        Ok(scalars::motion(names, &scales, columns, 1.0 / fps))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::load;
    use crate::motion::Motion;

    fn read_as(name: &str, text: impl AsRef<[u8]>) -> Result<(Motion, Vec<String>)> {
        let path = std::env::temp_dir().join(format!("pantin-fap-{name}-{}.fap", std::process::id()));
        std::fs::write(&path, text).unwrap();
        let read = load(&path, &Options::default());
        std::fs::remove_file(&path).unwrap();
        read.map(|imported| (imported.motion, imported.warnings))
    }

    fn mask(set: &[usize]) -> String {
        (1..=PARAMETERS).map(|parameter| if set.contains(&parameter) { "1 " } else { "0 " }).collect()
    }

    fn error(name: &str, text: &str) -> String {
        format!("{:#}", read_as(name, text).unwrap_err())
    }

    fn column<'a>(motion: &'a Motion, name: &str) -> &'a [f64] {
        &motion.values[motion.rig.scalars.iter().position(|scalar| scalar.name == name).unwrap()]
    }

    #[test]
    fn parameters_keep_their_values_until_they_get_others() {
        let text = format!(
            "2.1 C:\\my faces\\joy 25 6\n{}\n0 100 -3000\n{}\n1 200\n{}\n4 -400 50\n",
            mask(&[3, 48]),
            mask(&[3]),
            mask(&[3, 4])
        );
        let (motion, warnings) = read_as("keep", text).unwrap();
        assert_eq!((motion.frames, motion.frame_time), (6, 0.04));
        assert_eq!(column(&motion, "open_jaw"), [100.0, 200.0, 200.0, 200.0, -400.0, -400.0]);
        assert_eq!(column(&motion, "head_pitch"), [-3000.0; 6]);
        assert_eq!(column(&motion, "lower_t_midlip"), [0.0, 0.0, 0.0, 0.0, 50.0, 50.0]);
        // Full scale is of a unit, not of a channel.
        let scales: Vec<f64> = motion.rig.scalars.iter().map(|scalar| scalar.full_scale).collect();
        assert_eq!(scales, [400.0, 400.0, 3000.0]);
        assert_eq!(warnings.len(), 2, "{warnings:?}");
    }

    #[test]
    fn visemes_and_expressions_have_several_values() {
        for (viseme, expression) in
            [("3 4 32", "1 63 2 10"), ("3 4 32 1", "1 63 2 10"), ("3 4 32", "1 63 2 10 0 1"), ("3 4 32 1", "1 63 2 10 0 1")]
        {
            let text = format!("2.1 x 30 1\n{}\n0 {viseme} {expression} 77\n", mask(&[1, 2, 68]));
            let (motion, _) = read_as("high", text).unwrap();
            assert_eq!(column(&motion, "viseme_blend"), [32.0]);
            assert_eq!(column(&motion, "expression_intensity1"), [63.0]);
            assert_eq!(column(&motion, "pull_r_ear"), [77.0]);
            assert_eq!(motion.rig.scalars.len(), 1 + viseme.split(' ').count() + expression.split(' ').count());
            assert_eq!(motion.rig.scalars[0].full_scale, 14.0);
        }
    }

    #[test]
    fn frames_may_count_from_any_number() {
        let text = format!("2.1 x 25 2\r\n{0}\r\n7 1\r\n{0}\r\n8 2\r\n", mask(&[3]));
        assert_eq!(read_as("seven", text).unwrap().0.values, [[1.0, 2.0]]);
        let text = format!("2.1 x 25 1\n{0}\n0 1\n{0}\n1 2\n", mask(&[3]));
        let (motion, warnings) = read_as("more", text).unwrap();
        assert!(motion.frames == 1 && warnings[0].contains("from line 4"), "{warnings:?}");
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        let jaw = mask(&[3]);
        assert!(error("header", "2.0 x 25 1\n").contains(".fap:1: expected `2.1 NAME"));
        assert!(error("only", "2.1 x 25 1\n").contains(".fap:1: no mask sets a parameter"));
        assert!(error("short", "2.1 x 25 1\n0 1 1\n0 5 5\n").contains(".fap:2: a mask of 3; expected 68"));
        assert!(
            error("bit", &format!("2.1 x 25 1\n{}2\n0 5\n", &jaw[..134]))
                .contains(".fap:2: expected a mask of 68 times 0 or 1, found `2`")
        );
        assert!(error("cut", &format!("2.1 x 25 1\n{jaw}\n")).contains(".fap:2: expected values after this mask"));
        assert!(error("count", &format!("2.1 x 25 1\n{jaw}\n0 5 6\n")).contains(".fap:3: 2 values; the mask sets 1"));
        assert!(error("nan", &format!("2.1 x 25 1\n{jaw}\n0 nan\n")).contains(".fap:3: value 1: expected a finite number"));
        assert!(error("huge", &format!("2.1 x 25 1\n{jaw}\n0 1e99\n")).contains(".fap:3: value 1: expected a finite number"));
        assert!(error("back", &format!("2.1 x 25 9\n{jaw}\n5 1\n{jaw}\n3 1\n")).contains(".fap:5: frame 3 stands after"));
        assert!(
            error("far", &format!("2.1 x 25 2\n{jaw}\n0 1\n{jaw}\n9 1\n")).contains(".fap:5: frame 9, but the header says 2")
        );
        assert!(error("many", "2.1 x 25 99999999999\n").contains(".fap:1: 99999999999 frames"));
        let strange = format!("{:#}", read_as("strange", b"2.1 \xff 25 1\n\xff\n").unwrap_err());
        assert!(strange.contains(".fap:2: "), "{strange}");
    }
}
