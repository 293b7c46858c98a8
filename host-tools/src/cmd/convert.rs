//! `pantin convert`.

use super::channel_bound::{ChannelBound, above_zero};
use super::write_whole;
use crate::channel_error;
use crate::encode::{clip, rig};
use crate::fit::bounds::Bounds;
use crate::fit::chain::Held;
use crate::fit::descent::{Level, Plan};
use crate::fit::parametrize::Rotations;
use crate::fit::{channelwise, fit};
use crate::import;
use crate::motion::Motion;
use crate::verify::{Report, verify};
use anyhow::{Context, Result, ensure};
use indicatif::{ProgressBar, ProgressStyle};
use pantin::layout::MAX_FRAMES;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Turn a motion file into a clip.
///
/// The bound holds: before anything is written, the clip is played by the device's own decoder and compared, joint by joint
/// (or channel by channel) and frame by frame, with the motion. If the bound cannot be met, nothing is written.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin convert walk.bvh -o walk.ptn
  pantin convert walk.bvh -o walk.ptn --max-error 3cm
  pantin convert walk.bvh -o walk.ptn --rig-out figure.rig
  pantin convert motions/walk.keys -o walk.ptn --exact
  pantin convert walk.bvh -o walk.ptn --index 2
  pantin convert walk.bvh -o walk.ptn --max-channel-error 0.5
  pantin convert face.csv -o face.ptn --max-scalar-error 2
  pantin convert servos.tsv -o servos.ptn --fps 50
  pantin convert --list fox.glb
  pantin convert fox.glb -o walk.ptn --animation Walk --cm-per-unit 1")]
pub struct Arguments {
    /// The motion: .bvh, .amc (its .asf beside it), .glb or .gltf, .fbx, .wrl or .x3dv, our key frames (.keys, see docs/KEYFRAMES.md), functions of time
    /// (.proc, see docs/PROCEDURAL.md), a face by Live Link Face (.csv) or in MPEG-4 parameters (.fap), or a table of channels
    /// below a row of their names (.csv, .tsv)
    input: PathBuf,
    /// The clip to write
    #[arg(short, long, required_unless_present = "list")]
    output: Option<PathBuf>,
    /// Write nothing; list the animations of a glTF or FBX file, or a VRML world
    #[arg(long)]
    list: bool,
    /// Greatest distance of any joint or End Site from where it should be: a number with cm, mm, m or in (default unit cm)
    #[arg(long, group = "bound", default_value = "0.5cm", value_parser = length_cm)]
    max_error: f64,
    /// How hard to look for few bytes
    #[arg(long, value_enum, default_value = "default")]
    effort: Level,
    /// How joints with three Euler angles are coded
    #[arg(long, value_enum, default_value = "by-cost")]
    rotations: Rotations,
    /// Greatest error of channels that move no joint, in percent of their full scale
    #[arg(long, value_name = "PERCENT", default_value = "2", value_parser = above_zero)]
    max_scalar_error: f64,
    #[command(flatten)]
    channels: ChannelBound,
    /// Length of the source's unit in cm, instead of a guess
    #[arg(long)]
    cm_per_unit: Option<f64>,
    /// Frames a second: for sources that do not say, instead of what a face's file says, and at which a table with a time is sampled
    #[arg(long)]
    fps: Option<f64>,
    /// The .asf of an .amc, instead of the one found beside it
    #[arg(long)]
    skeleton: Option<PathBuf>,
    /// Put a snapshot of the player's state into the file each so many seconds: seeking starts from the last one
    #[arg(long, value_name = "SECONDS")]
    index: Option<f64>,
    /// Which animation of a file that holds several (glTF, FBX, VRML): its name, or its number from 0
    #[arg(long, value_name = "NAME|INDEX")]
    animation: Option<String>,
    /// Write the rig to this file, and the clip without it
    #[arg(long)]
    rig_out: Option<PathBuf>,
    /// Print the measured errors as one JSON object
    #[arg(long)]
    json: bool,
    /// Say nothing but errors
    #[arg(short, long)]
    quiet: bool,
}

impl Arguments {
    fn output(&self) -> &Path {
        self.output.as_deref().unwrap_or(Path::new(""))
    }
}

fn length_cm(text: &str) -> Result<f64, String> {
    let units = [("cm", 1.0), ("mm", 0.1), ("in", 2.54), ("m", 100.0), ("", 1.0)];
    let (number, factor) =
        units.iter().find_map(|(unit, factor)| text.strip_suffix(unit).map(|number| (number, factor))).unwrap_or((text, &1.0));
    match number.trim().parse::<f64>() {
        Ok(number) if number > 0.0 && number.is_finite() => Ok(number * factor),
        _ => Err("expected a length above 0, like 0.5cm".into()),
    }
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    if arguments.list {
        return super::info::animations(&arguments.input, arguments.json);
    }
    let options = import::Options {
        cm_per_unit: arguments.cm_per_unit,
        fps: arguments.fps,
        skeleton: arguments.skeleton.clone(),
        animation: arguments.animation.clone(),
    };
    let imported = import::load(&arguments.input, &options)?;
    if !arguments.quiet {
        imported.warnings.iter().for_each(|warning| eprintln!("warning: {warning}"));
        eprintln!("{}", imported.units);
    }
    let motion = imported.motion;
    let rig = rig::encode(&motion.rig)?;
    let made = match arguments.channels.bounds(&motion)? {
        Some(bounds) => by_channel(arguments, &motion, &rig, &bounds)?,
        None => by_distance(arguments, &motion, &rig)?,
    };
    if let Some(path) = &arguments.rig_out {
        write_whole(path, &rig).context("rig")?;
    }
    write_whole(arguments.output(), &made.bytes)?;
    if arguments.json {
        println!("{}", made.json);
    }
    if !arguments.quiet {
        let raw = motion.frames * motion.rig.channels() * 2;
        eprintln!(
            "{}: {} frames, {} channels; {} bytes ({} per frame at 16 bits, {:.1} % saved); {}",
            arguments.output().display(),
            motion.frames,
            motion.rig.channels(),
            made.bytes.len(),
            raw,
            100.0 - 100.0 * made.bytes.len() as f64 / raw as f64,
            made.errors
        );
    }
    Ok(())
}

/// A clip that keeps its bound.
struct Made {
    bytes: Vec<u8>,
    json: serde_json::Value,
    /// The errors as a clause for the user.
    errors: String,
}

fn bar(arguments: &Arguments, length: u64) -> Result<ProgressBar> {
    let bar = if arguments.quiet { ProgressBar::hidden() } else { ProgressBar::new(length) };
    bar.set_style(ProgressStyle::with_template("fitting {wide_bar} {percent} % {eta}")?);
    Ok(bar)
}

/// The clip's bytes, with the index that was asked for; says what it costs.
fn file(arguments: &Arguments, coded: &clip::Coded, rig: &[u8]) -> Result<Vec<u8>> {
    let apart = arguments.rig_out.is_some();
    let plain = clip::encode(coded, rig, apart)?;
    let Some(seconds) = arguments.index else { return Ok(plain) };
    let spacing = (seconds * 1e9 / f64::from(coded.frame_time_ns)).round();
    ensure!((1.0..=f64::from(MAX_FRAMES)).contains(&spacing), "--index {seconds}: expected a frame's time or more, in seconds");
    let bytes = clip::encode_with_index(coded, rig, apart, spacing as u32)?;
    if !arguments.quiet {
        let cost = bytes.len() - plain.len();
        let part = 100.0 * cost as f64 / plain.len() as f64;
        eprintln!("index: a snapshot each {spacing} frames costs {cost} bytes ({part:.1} % more)");
    }
    Ok(bytes)
}

fn by_distance(arguments: &Arguments, motion: &Motion, rig: &[u8]) -> Result<Made> {
    let plan = Plan { rotations: arguments.rotations, ..arguments.effort.plan(arguments.max_error) };
    let part = arguments.max_scalar_error / 100.0;
    let bar = bar(arguments, 1000)?;
    let coded = fit(motion, plan, part, &mut |done| bar.set_position((done * 1000.0) as u64))?;
    bar.finish_and_clear();
    let bytes = file(arguments, &coded, rig)?;
    let not_written = || format!("{}: not written", arguments.output().display());
    let report = verify(&bytes, rig, motion, arguments.max_error, part).with_context(not_written)?;
    Ok(Made { bytes, json: errors_json(&report, motion), errors: errors_text(&report, motion) })
}

/// The errors of what the motion has: joints, scalars or both.
fn errors_json(report: &Report, motion: &Motion) -> serde_json::Value {
    let mut fields = serde_json::Map::new();
    if !motion.rig.joints.is_empty() {
        fields.insert("max_error_cm".into(), json!(report.max_cm));
        fields.insert("mean_error_cm".into(), json!(report.mean_cm));
        fields.insert("worst_joint".into(), json!(report.worst_joint));
        fields.insert("worst_frame".into(), json!(report.worst_frame));
    }
    if !motion.rig.scalars.is_empty() {
        fields.insert("max_scalar_error_percent".into(), json!(100.0 * report.max_scalar));
        fields.insert("worst_scalar".into(), json!(report.worst_scalar));
        fields.insert("worst_scalar_frame".into(), json!(report.worst_scalar_frame));
    }
    fields.into()
}

fn errors_text(report: &Report, motion: &Motion) -> String {
    let (joint, frame) = (&report.worst_joint, report.worst_frame);
    let joints = format!("error max {:.4} cm ({joint} at frame {frame}), mean {:.4} cm", report.max_cm, report.mean_cm);
    let (scalar, frame) = (&report.worst_scalar, report.worst_scalar_frame);
    let place = if scalar.is_empty() { String::new() } else { format!(" ({scalar} at frame {frame})") };
    let scalars = format!("scalars' error max {:.3} % of full scale{place}", 100.0 * report.max_scalar);
    match (motion.rig.joints.is_empty(), motion.rig.scalars.is_empty()) {
        (false, true) => joints,
        (true, _) => scalars,
        (false, false) => format!("{joints}; {scalars}"),
    }
}

fn by_channel(arguments: &Arguments, motion: &Motion, rig: &[u8], bounds: &Bounds) -> Result<Made> {
    let bar = bar(arguments, motion.rig.channels() as u64)?;
    let not_written = || format!("{}: not written", arguments.output().display());
    let coded = channelwise::fit(motion, bounds, &|| bar.inc(1)).with_context(not_written)?;
    bar.finish_and_clear();
    let bytes = file(arguments, &coded, rig)?;
    let report = channel_error::verify(&bytes, rig, motion, bounds).with_context(not_written)?;
    let worst = &report.worst;
    let json = json!({
        "max_error": worst.error,
        "part_of_bound": worst.part,
        "worst_channel": motion.rig.channel_name(worst.channel),
        "worst_frame": worst.frame,
        "max_drift": report.drift.error,
        "drifting_channel": motion.rig.channel_name(report.drift.channel),
    });
    let errors = match bounds.held {
        Held::Positions => format!("error max {}", worst.sentence(motion)),
        Held::Accelerations => {
            format!("error max {}, a frame^2; drift max {}", worst.sentence(motion), report.drift.sentence(motion))
        }
    };
    Ok(Made { bytes, json, errors })
}
