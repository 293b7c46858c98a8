//! `cargo xtask train`: the format's tables, from motions.
//!
//! Every motion is fitted at each bound and frame rate with the tables of this build, and its symbols are counted; all clips have
//! equal weight. Build and run it again until the sizes converge. Tables are frozen with a version of the format.

mod counts;

use std::fmt;
use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::Args;
use pantin_convert::edit::cut::cut;
use pantin_convert::encode::{clip::Coded, rig};
use pantin_convert::fit::{bounds::Bounds, chain::Constraint, channelwise, fit, level::Level};
use pantin_convert::import::{self, Disk};
use pantin_convert::motion::{Interpolation, Keys, Kind, Motion};
use pantin_convert::pose_bound::PoseBound;
use pantin_tools::output::write_whole;
use rayon::prelude::*;

use counts::Counts;

/// Computes the format's tables (decoder/src/codec/tables.rs) from motions; needed only for a new version of the format
#[derive(Args)]
pub struct Train {
    /// Motion files
    #[arg(required = true)]
    inputs: Vec<PathBuf>,
    /// The source file to write
    #[arg(short, long)]
    output: PathBuf,
    /// A sentence for the file that describes the training data
    #[arg(long)]
    note: String,
    /// Bounds in cm, more than 0
    #[arg(long, value_delimiter = ',', default_value = "0.3,1,3", value_parser = above_zero)]
    bounds: Vec<f64>,
    /// Use every frame, every second, every fourth, ...
    #[arg(long, value_delimiter = ',', default_value = "1,2,4", value_parser = clap::value_parser!(u32).range(1..))]
    strides: Vec<u32>,
    /// Frames per second, for sources that do not state them
    #[arg(long)]
    fps: Option<f64>,
}

fn above_zero(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|value: &f64| value.is_finite() && *value > 0.0).ok_or("expected a number above 0".into())
}

/// Statistics are of what the search finds when it is not hurried.
const TRAINING: Level = Level::DEFAULT;

/// Every `stride`-th frame.
fn decimated(motion: &Motion, stride: usize) -> Motion {
    let values: Vec<Vec<f64>> = motion.values.iter().map(|values| values.iter().step_by(stride).copied().collect()).collect();
    let keys = vec![None; values.len()];
    Motion {
        frames: motion.frames.div_ceil(stride),
        frame_time: motion.frame_time * stride as f64,
        values,
        keys,
        ..motion.clone()
    }
}

/// Lengths of the parts that are cut out, in frames, and how many of each: short clips begin in the middle of a movement.
const CUTS: [usize; 2] = [24, 56];
const CUTS_OF_LENGTH: usize = 4;

/// The same motion with three translations at every joint, all at rest: many files are written so.
fn with_translations(motion: &Motion) -> Motion {
    let mut out = motion.clone();
    (out.values, out.keys) = (Vec::new(), Vec::new());
    let first = motion.rig.first_channels();
    for (joint, entry) in out.rig.joints.iter_mut().enumerate() {
        let channels = first[joint]..first[joint] + entry.kinds.len();
        if !entry.end_site && !entry.kinds.iter().any(|kind| kind.is_position()) {
            entry.kinds.splice(..0, [Kind::Xposition, Kind::Yposition, Kind::Zposition]);
            out.values.extend(entry.offset.iter().map(|&x| vec![x; motion.frames]));
        }
        out.values.extend_from_slice(&motion.values[channels]);
    }
    out.values.extend_from_slice(&motion.values[motion.rig.joint_channels()..]);
    out.keys = vec![None; out.values.len()];
    out
}

/// Short parts of a motion, every second one with translations.
fn cuts(motion: &Motion) -> Result<Vec<Motion>> {
    let mut out = Vec::new();
    for (place, length) in CUTS.iter().flat_map(|&length| (0..CUTS_OF_LENGTH).map(move |place| (place, length))) {
        if length > motion.frames {
            continue;
        }
        let from = (motion.frames - length) * place / (CUTS_OF_LENGTH - 1);
        let part = cut(motion, Some(from), Some(from + length - 1))?;
        out.push(if place.is_multiple_of(2) { part } else { with_translations(&part) });
    }
    Ok(out)
}

/// Spans between the key frames of [`keyed`], in frames, and its bounds in degrees and the motion's units.
const KEY_SPANS: [usize; 6] = [6, 10, 16, 24, 32, 48];
const KEYED_BOUNDS: [f64; 2] = [0.006, 0.05];
/// How much a keyed motion counts beside a captured one.
const KEYED_WEIGHT: f64 = 0.08;
/// Most frames of a keyed motion.
const KEYED_FRAMES: usize = 240;

/// A motion of key frames: smooth between every `span`-th frame of `motion`.
fn keyed(motion: &Motion, span: usize) -> Motion {
    let frames = motion.frames.min(KEYED_FRAMES);
    let mut out = motion.clone();
    for (values, keys) in out.values.iter_mut().zip(&mut out.keys) {
        let at: Vec<usize> = (0..frames - 1).step_by(span).chain([frames - 1]).collect();
        let on: Vec<(usize, f64)> = at.into_iter().map(|frame| (frame, values[frame])).collect();
        *values = pantin_convert::keys::sample(&on, Interpolation::Discrete, frames, false);
        let pieces = pantin_convert::keys::cubics(&on, Interpolation::Discrete, false);
        *keys = Some(Keys::OnFrames { interpolation: Interpolation::Discrete, keys: on, pieces });
    }
    Motion { frames, ..out }
}

/// What is fitted for the statistics.
struct Sample {
    motion: Motion,
    bound: f64,
    counts: Counted,
}

/// What of a sample is counted.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Counted {
    Whole,
    /// The starts: the segments of short parts are those of whole motions.
    Start,
    /// A keyed motion, every channel of which keeps the bound instead of every joint.
    Keyed,
}

impl fmt::Display for Sample {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}, {} frames, {}", self.counts, self.motion.frames, self.bound)
    }
}

impl Sample {
    /// Adds its symbols, the less the longer it is.
    fn count(&self, coded: &Coded, bytes: &[u8], counts: &mut Counts) -> Result<()> {
        let segments: usize = coded.channels.iter().map(|channel| channel.segments.len()).sum();
        let rig = pantin::Rig::new_checked(bytes)?;
        let weight = (2000.0 / segments.max(200) as f64).min(1.0);
        match self.counts {
            Counted::Whole => counts.add(coded, &rig, weight),
            Counted::Start => counts.add_starts(coded, &rig, weight),
            Counted::Keyed => counts.add(coded, &rig, KEYED_WEIGHT * weight),
        }
        Ok(())
    }

    fn coded(&self) -> Result<(Coded, Vec<u8>)> {
        let bytes = rig::encode(&self.motion.rig)?;
        let coded = if self.counts == Counted::Keyed {
            let greatest = vec![self.bound; self.motion.values.len()];
            let bounds = Bounds { constraint: Constraint::Positions, exact: true, asked: greatest.clone(), greatest };
            channelwise::fit(&self.motion, &bounds, &|| ())?
        } else {
            fit(&self.motion, TRAINING.plan(PoseBound::places(self.bound)), 0.02, &mut |_| ())?
        };
        Ok((coded, bytes))
    }
}

impl Train {
    /// Fits everything, and writes the tables.
    pub fn run(self) -> Result<()> {
        let mut counts = Counts::default();
        for path in &self.inputs {
            let mut options = import::ImportOptions::new();
            options.fps = self.fps;
            let motion = import::import(&Disk::default(), path, &options)?.motion;
            let samples = self.samples(&motion)?;
            let coded = samples.par_iter().map(Sample::coded).collect::<Result<Vec<_>>>();
            for (sample, (coded, bytes)) in samples.iter().zip(coded.with_context(|| path.display().to_string())?) {
                println!("{}: {sample}", path.display());
                sample.count(&coded, &bytes, &mut counts)?;
            }
        }
        write_whole(&self.output, counts.tables(&self.note).as_bytes())
    }

    /// What is fitted of a motion: all of it and parts of it at each rate and bound, and smooth motions between its key frames.
    fn samples(&self, motion: &Motion) -> Result<Vec<Sample>> {
        let mut samples = Vec::new();
        if motion.frames > KEY_SPANS[5] {
            for (&span, &bound) in KEY_SPANS.iter().flat_map(|span| KEYED_BOUNDS.iter().map(move |bound| (span, bound))) {
                samples.push(Sample { motion: keyed(motion, span), bound, counts: Counted::Keyed });
            }
        }
        for &stride in &self.strides {
            let motion = decimated(motion, stride as usize);
            let parts = cuts(&motion)?;
            let counted = [(motion, Counted::Whole)].into_iter().chain(parts.into_iter().map(|part| (part, Counted::Start)));
            for (motion, counts) in counted {
                samples.extend(self.bounds.iter().map(|&bound| Sample { motion: motion.clone(), bound, counts }));
            }
        }
        Ok(samples)
    }
}
