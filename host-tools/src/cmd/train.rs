//! `pantin train`.

use super::channel_bound::above_zero;
use crate::encode::rig;
use crate::fit::{descent::Level, fit};
use crate::import;
use crate::motion::Motion;
use crate::output::{Wanted, check, note, refuse_foreign, write_whole};
use crate::train::Counts;
use anyhow::{Context, Result};
use std::path::{Path, PathBuf};

/// Compute the format's tables (decoder/src/codec/tables.rs) from motions; needed only to change the format.
///
/// Every motion is fitted at each bound and frame rate with the tables of this build, and its symbols are counted; all clips have equal
/// weight. Build and run it again until the sizes converge.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin train motions/*.bvh -o decoder/src/codec/tables.rs --note 'Trained on ...'")]
pub struct Arguments {
    /// Motion files
    #[arg(required = true)]
    inputs: Vec<PathBuf>,
    /// The source file to write
    #[arg(short, long)]
    output: PathBuf,
    /// A sentence for the file that describes the training data
    #[arg(long)]
    note: String,
    /// Bounds in cm
    #[arg(long, value_delimiter = ',', default_value = "0.3,1,3", value_parser = above_zero)]
    bounds: Vec<f64>,
    /// Use every frame, every second, every fourth, ...
    #[arg(long, value_delimiter = ',', default_value = "1,2,4", value_parser = clap::value_parser!(u32).range(1..))]
    strides: Vec<u32>,
    /// Frames per second, for sources that do not state them
    #[arg(long)]
    fps: Option<f64>,
}

/// Statistics are of what the search finds when it is not hurried.
const TRAINING: Level = Level::Default;

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

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    refuse_foreign(&arguments.output, Wanted::Source)?;
    let inputs: Vec<&Path> = arguments.inputs.iter().map(PathBuf::as_path).collect();
    check(&inputs, &[&arguments.output])?;
    let mut counts = Counts::default();
    for path in &arguments.inputs {
        let files = import::Files::default();
        let motion =
            import::load(path, &import::Options { fps: arguments.fps, files: files.clone(), ..Default::default() })?.motion;
        super::check_read(&files, &[&arguments.output])?;
        super::check_fit(&motion, TRAINING, &files).with_context(|| path.display().to_string())?;
        let bytes = rig::encode(&motion.rig)?;
        let rig = pantin::Rig::new_checked(&bytes)?;
        for &stride in &arguments.strides {
            let motion = decimated(&motion, stride as usize);
            for &bound_cm in &arguments.bounds {
                let coded =
                    fit(&motion, TRAINING.plan(bound_cm), 0.02, &mut |_| ()).with_context(|| path.display().to_string())?;
                let segments: usize = coded.channels.iter().map(|channel| channel.segments.len()).sum();
                note!("{} every {stride}: {bound_cm} cm, {segments} segments", path.display());
                counts.add(&coded, &rig, (2000.0 / segments.max(200) as f64).min(1.0));
            }
        }
    }
    write_whole(&arguments.output, counts.tables(&arguments.note).as_bytes())
}
