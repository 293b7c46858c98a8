//! `pantin convert`.

use super::channel_bound::{ChannelBound, above_zero};
use super::edits::Edits;
use super::joint_error::{self, JointError};
use super::shard::{self, Shard};
use super::{bank, batch, check_fit, convert_bank, convert_list, default_output, same_form, up_axis};
use crate::channel_error;
use crate::edit::cut::cut;
use crate::edit::find_loop::{self, Cut};
use crate::edit::loop_seam::{self, Closed, Most};
use crate::encode::clip::Start;
use crate::encode::{clip, rig};
use crate::errors;
use crate::fit::bounds::Bounds;
use crate::fit::chain::Constraint;
use crate::fit::descent::{Level, Plan};
use crate::fit::parametrize::{Coding, Rotations, has_choice, quaternions};
use crate::fit::{channelwise, fit_coding};
use crate::import;
use crate::motion::Motion;
use crate::number::Number;
use crate::output::{self, Wanted, detail, note, outln, refuse_foreign};
use crate::pose_bound::{self, PoseBound, Shell};
use crate::verify::{self, compare};
use anyhow::{Context, Result, bail, ensure};
use indicatif::ProgressBar;
use pantin::Up;
use pantin::codec::layout::MAX_FRAMES;
use serde_json::{Map, Value, json};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Turn a motion file into a clip.
///
/// The bound is verified: before anything is written, the device's own decoder plays the clip, and every joint (or channel) is compared
/// with the motion at every frame. If the bound cannot be met, nothing is written.
///
/// If the input is a folder, all motions in it and its subfolders are converted into the folder --output; clips that are up to date are skipped. If
/// --output ends in .ptb, the clips, which must have one rig, go into one file, a bank.
#[derive(clap::Args, Clone, Debug)]
#[command(after_help = "Examples:
  pantin convert walk.bvh -o walk.ptn
  pantin convert walk.bvh -o walk.ptn --max-error 3cm
  pantin convert walk.bvh -o walk.ptn --rig-out figure.rig
  pantin convert motions/walk.keys -o walk.ptn --exact
  pantin convert walk.bvh -o walk.ptn --index 2
  pantin convert walk.bvh -o walk.ptn --max-channel-error 0.5
  pantin convert walk.bvh -o walk.ptn --footsteps --event clap@12 --event 'door opens@1.5s'
  pantin convert face.csv -o face.ptn --max-scalar-error 2
  pantin convert servos.tsv -o servos.ptn --fps 50
  pantin convert --list fox.glb
  pantin convert fox.glb -o walk.ptn --animation Walk --cm-per-unit 1
  pantin convert walk.bvh -o walk.ptn --fps 30 --from 40 --to 71 --loop
  pantin convert walk.bvh --find-loop
  pantin convert cycle.bvh -o cycle.ptn --close-loop --rate 25
  pantin convert walk.bvh -o legs.ptn --joints '*Leg,*Foot'
  pantin convert walk.bvh -o walk.ptn --drop '*Thumb*,*Finger*' --mirror
  pantin convert walk.bvh -o walk.ptn --retarget display --map names.txt
  pantin convert fox.glb --animation all -o clips
  pantin convert walk.bvh bow.bvh -o clips -j 2
  pantin convert captures -o clips --jobs 4 --max-error 0.5%
  pantin convert captures -o clips --shard 2/8        part 2 of 8, on one of 8 machines
  pantin convert walk.bvh bow.bvh kick.bvh --same-form -o clips
  pantin convert captures -o moves.ptb
  pantin convert moves.list -o moves.ptb --same-form")]
pub struct Arguments {
    /// The motion: .bvh, .amc (its .asf beside it), .glb or .gltf, .fbx, .wrl or .x3dv, key frames (.keys, see docs/KEYFRAMES.md), functions of time
    /// (.proc, see docs/PROCEDURAL.md), a face from Live Link Face (.csv) or in MPEG-4 parameters (.fap), or a table of channels
    /// with a row of names (.csv, .tsv). For a bank also a list (.list): a motion a line, with its own --name, --animation and changes, as in
    /// `walk.bvh --from 65 --to 129 --loop`
    pub(super) input: PathBuf,
    /// More motions, each of which gets a clip of its name in the folder --output, or beside it
    #[arg(value_name = "MOTION", conflicts_with = "list")]
    pub(super) more: Vec<PathBuf>,
    /// Give the clips of all motions one form: the same length exponent, and the same joints coded as exponential maps, chosen by
    /// what all clips together cost. One figure renderer then plays any of them. All motions need the same rig; --output is a folder
    #[arg(long, requires = "output", conflicts_with_all = ["list", "jobs"])]
    pub(super) same_form: bool,
    /// The clip to write, or the folder [default: the motion's name, ending in .ptn; a file that is there already is kept]
    #[arg(short, long)]
    pub(super) output: Option<PathBuf>,
    /// Write nothing; list the animations of a glTF or FBX file, or a VRML world
    #[arg(long, conflicts_with_all = ["output", "rig_out", "animation"])]
    list: bool,
    /// Write nothing; print the stretches of the motion that make the best loops, with the options that cut them out
    #[arg(long, conflicts_with_all = ["list", "same_form", "more", "bound", "mean_error", "max_scalar_error", "max_rotation_error", "max_joint_error", "shell", "places_only", "index", "jobs", "events", "footsteps", "looped", "close_loop"])]
    find_loop: bool,
    /// Largest distance of any bounded point from its original position: of each joint, of the three points of its shell (see --shell)
    /// and of each End Site. A number with cm, mm, m or in (default unit cm), or with % of the figure's height
    /// [default: 0.5cm, or 6 times --mean-error]
    #[arg(long, group = "bound", value_parser = joint_error::parse)]
    max_error: Option<JointError>,
    /// Mean error of the joints, End Sites left out, in the same units: the clip is as small as its mean allows, instead of filling
    /// --max-error, which still holds for every joint. A joint's error is the largest distance of its shell's points
    #[arg(long, conflicts_with_all = ChannelBound::OPTIONS, value_parser = joint_error::parse)]
    mean_error: Option<JointError>,
    /// Distance of the shell's points from their joint, in the units of --max-error. The points lie along the joint's own axes, so that
    /// --max-error bounds how each joint is turned, too
    /// [default: 3cm, or 3% for a figure below 1 m]
    #[arg(long, value_name = "LENGTH|PERCENT", conflicts_with_all = ChannelBound::OPTIONS, value_parser = joint_error::parse)]
    shell: Option<JointError>,
    /// Bound the places of joints and End Sites alone, without their shells. For figures that are drawn as lines between joints: a head's
    /// yaw or a forearm's twist may be lost
    #[arg(long, conflicts_with = "shell", conflicts_with_all = ChannelBound::OPTIONS)]
    places_only: bool,
    /// Encoder effort: speed against size
    #[arg(long, value_enum, default_value = "default")]
    effort: Level,
    /// How joints with three Euler angles are coded
    #[arg(long, value_enum, default_value = "by-cost")]
    rotations: Rotations,
    /// Largest error of channels that move no joint, in percent of their full scale
    /// [default: 2]
    #[arg(long, value_name = "PERCENT", conflicts_with_all = ChannelBound::OPTIONS, value_parser = above_zero)]
    max_scalar_error: Option<f64>,
    /// Largest angle between the original and the decoded rotation of any joint in the world, in degrees, at most 180
    #[arg(long, value_name = "DEGREES", conflicts_with_all = ChannelBound::OPTIONS, value_parser = joint_error::degrees)]
    max_rotation_error: Option<f64>,
    /// The same against the joint's parent: what a servo or a skinned mesh shows
    #[arg(long, value_name = "DEGREES", conflicts_with_all = ChannelBound::OPTIONS, value_parser = joint_error::degrees)]
    max_joint_error: Option<f64>,
    #[command(flatten)]
    channels: ChannelBound,
    /// Length of the source's unit in cm, instead of a guess
    #[arg(long)]
    cm_per_unit: Option<f64>,
    /// The direction that is vertical, instead of what the file says or of a guess: x, y, z, -x, -y or -z
    #[arg(long, value_name = "AXIS", value_parser = up_axis, allow_hyphen_values = true)]
    up: Option<Up>,
    /// Frames per second of the clip: a file that states its rate, or has keys or times, is resampled; one without a rate (.amc, a
    /// table without times) gets this one
    #[arg(long)]
    fps: Option<f64>,
    #[command(flatten)]
    pub(super) edits: Edits,
    /// The .asf of an .amc, instead of the one found next to it
    #[arg(long)]
    pub(super) skeleton: Option<PathBuf>,
    /// Store a snapshot of the player's state every N seconds, so that seeking starts from the nearest one
    #[arg(long, value_name = "SECONDS")]
    index: Option<f64>,
    /// Which animation of a file that holds several (glTF, FBX, VRML): its name, or its number from 0. `all` writes a clip for each:
    /// OUTPUT-NAME.ptn, or NAME.ptn if --output is a folder
    #[arg(long, value_name = "NAME|INDEX|all")]
    pub(super) animation: Option<String>,
    /// Write the rig to this file, and the clip without it
    #[arg(long)]
    pub(super) rig_out: Option<PathBuf>,
    /// Number of files or animations to convert at a time [default: the number of CPUs]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(super) jobs: Option<u16>,
    /// Convert only the I-th of N parts of the files, I from 1, so that several machines share the work of one command
    #[arg(long, value_name = "I/N", value_parser = shard::parse, conflicts_with_all = ["list", "find_loop", "same_form"])]
    pub(super) shard: Option<Shard>,
    /// Whether this is one file of a folder, whose messages the folder's table replaces.
    #[arg(skip)]
    silent: bool,
    /// Whether the output's name is a default: a file that is there is kept, unless it is this clip, up to date.
    #[arg(skip)]
    pub(super) keeps_existing: bool,
}

impl Arguments {
    pub(super) fn output(&self) -> &Path {
        self.output.as_deref().unwrap_or(Path::new(""))
    }

    /// How the source is read.
    fn import_options(&self) -> import::Options {
        import::Options {
            cm_per_unit: self.cm_per_unit,
            up: self.up,
            // At its own rate first, so that --rate means the frames of the file.
            fps: self.fps.filter(|_| self.edits.rate.is_none()),
            skeleton: self.skeleton.clone(),
            quaternions: self.channels.is_exact() || self.rotations == Rotations::Quaternion,
            animation: self.animation.clone(),
            files: import::Files::default(),
        }
    }

    /// Whether the user says which way is up.
    pub(super) fn up_is_given(&self) -> bool {
        self.up.is_some()
    }

    /// The rate of the clips, if the user gives one.
    pub(super) fn fps(&self) -> Option<f64> {
        self.fps
    }

    /// The same with a name for the clip: without --output that of the motion, ending in .ptn.
    fn with_output(&self) -> Result<Arguments> {
        let output = self.output.clone().map_or_else(|| default_output(&self.input, "ptn"), Ok)?;
        Ok(Arguments { output: Some(output), ..self.clone() })
    }

    /// Every file that the conversion is known to read before it begins.
    pub(super) fn inputs(&self) -> Vec<&Path> {
        [self.input.as_path()].into_iter().chain(self.skeleton.as_deref()).chain(self.edits.inputs()).collect()
    }

    /// Refuses outputs that cannot be written, that would overwrite an input or one of the files `read`, or that have the name of
    /// another kind of file.
    fn check_outputs(&self, read: &[PathBuf]) -> Result<()> {
        let inputs: Vec<&Path> = self.inputs().into_iter().chain(read.iter().map(PathBuf::as_path)).collect();
        let outputs: Vec<&Path> = [self.output()].into_iter().chain(self.rig_out.as_deref()).collect();
        output::check(&inputs, &outputs)?;
        self.rig_out.iter().try_for_each(|path| refuse_foreign(path, Wanted::Rig))?;
        refuse_foreign(self.output(), Wanted::Clip)
    }

    /// Bounds that were given and bound nothing in this motion, a sentence each.
    fn without_effect(&self, motion: &Motion) -> Vec<String> {
        let (no_joints, no_scalars) = (motion.rig.joints.is_empty(), motion.rig.scalars.is_empty());
        // Options, whether they are given for nothing, and what is missing.
        let given = [
            ("--max-error", self.max_error.is_some() && no_joints, "joints"),
            ("--mean-error", self.mean_error.is_some() && no_joints, "joints"),
            ("--max-rotation-error", self.max_rotation_error.is_some() && no_joints, "joints"),
            ("--max-joint-error", self.max_joint_error.is_some() && no_joints, "joints"),
            ("--shell", self.shell.is_some() && no_joints, "joints"),
            ("--places-only", self.places_only && no_joints, "joints"),
            ("--cm-per-unit", self.cm_per_unit.is_some() && no_joints, "joints"),
            ("--up", self.up.is_some() && no_joints, "joints"),
            ("--max-scalar-error", self.max_scalar_error.is_some() && no_scalars, "scalars"),
            ("--rotations", self.rotations != Rotations::ByCost && !has_choice(&motion.rig), "joint with three Euler angles"),
        ];
        let given = given.into_iter().filter(|(_, for_nothing, _)| *for_nothing);
        let mut said: Vec<String> =
            given.map(|(name, _, what)| format!("{name} has no effect: the motion has no {what}")).collect();
        if self.channels.is_given() {
            let given = [("--effort", self.effort != Level::Default), ("--rotations", self.rotations == Rotations::Exponential)];
            let given = given.into_iter().filter(|(_, given)| *given);
            said.extend(
                given.map(|(name, _)| format!("{name} has no effect: channels with bounds of their own are coded as they are")),
            );
        }
        said
    }

    /// The same for one of several motions.
    pub(super) fn for_motion(&self, input: PathBuf, output: PathBuf) -> Arguments {
        Arguments { input, more: Vec::new(), output: Some(output), ..self.clone() }
    }

    /// The same for one file of a folder, without messages.
    pub(super) fn for_file(&self, input: PathBuf, output: PathBuf) -> Arguments {
        Arguments {
            silent: true,
            jobs: None,
            shard: None,
            keeps_existing: self.output.is_none(),
            ..self.for_motion(input, output)
        }
    }
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    if arguments.list {
        return super::info::animations(&arguments.input);
    }
    if arguments.find_loop {
        return find_loop(arguments);
    }
    if arguments.output.as_deref().is_some_and(bank::is_bank_name) {
        ensure!(arguments.shard.is_none(), "--shard makes a part of the clips, and a bank holds all of them");
        return convert_bank::run(arguments);
    }
    if convert_list::is_list(&arguments.input) {
        bail!("{}: a list of motions becomes a bank: -o NAME.ptb (`pantin unpack` makes clips of it)", arguments.input.display());
    }
    if arguments.same_form {
        return same_form::run(arguments);
    }
    let all = arguments.animation.as_deref() == Some("all");
    if !arguments.more.is_empty() {
        ensure!(!all, "--animation all takes one file");
        return batch::run_several(arguments);
    }
    if arguments.input.is_dir() {
        ensure!(!all, "--animation all takes one file");
        return batch::run(arguments);
    }
    if all {
        return batch::run_animations(arguments);
    }
    ensure!(arguments.shard.is_none(), "--shard divides several files, and this is one");
    let arguments = &arguments.with_output()?;
    arguments.check_outputs(&[])?;
    // Drawn when the motion is read.
    let bar = OnceLock::new();
    let begin = || output::progress(1000, "fitting {wide_bar} {percent} % {eta} left").unwrap_or_else(|_| ProgressBar::hidden());
    let made = convert(arguments, &|part| bar.get_or_init(begin).set_position((part * 1000.0) as u64))?;
    bar.get_or_init(begin).finish_and_clear();
    output::report(made.fields().into());
    made.sentence(arguments.output()).lines().for_each(|line| note!("{line}"));
    Ok(())
}

/// Prints proposals for --from and --to.
fn find_loop(arguments: &Arguments) -> Result<()> {
    ensure!(
        arguments.output.is_none() && arguments.rig_out.is_none(),
        "--find-loop writes no file: leave --output and --rig-out out"
    );
    let place = || arguments.input.display().to_string();
    let options = arguments.import_options();
    let imported = import::load(&arguments.input, &options)?;
    imported.warnings.iter().for_each(|warning| note!("warning: {warning}"));
    let edited = arguments.edits.apply(imported.motion, arguments.fps, &options.files).with_context(place)?;
    edited.said.iter().for_each(|sentence| note!("{sentence}"));
    let motion = edited.motion;
    if motion.looped {
        note!("{}: a loop already: --from and --to would make another of it", place());
    }
    let mut cuts = find_loop::find(&motion).with_context(place)?;
    // Frames count as those of --from and --to do: before the cut.
    let first = arguments.edits.first_frame(motion.frame_time);
    cuts.iter_mut().for_each(|cut| (cut.from, cut.to) = (cut.from + first, cut.to + first));
    let seconds = |cut: &Cut| (cut.to - cut.from) as f64 * motion.frame_time;
    if output::is_json() {
        let object = |cut: &Cut| json!({"from": cut.from, "to": cut.to, "seam_cm": cut.seam_cm, "joint": cut.joint, "seconds": seconds(cut), "still": cut.still});
        output::report(json!({"loops": cuts.iter().map(object).collect::<Vec<_>>()}));
        return Ok(());
    }
    for cut in &cuts {
        let (frames, joint) = (cut.to - cut.from, output::clean(&cut.joint));
        outln!(
            "--from {} --to {} --loop: {frames} frames, {:.2} s, seam {:.3} cm ({joint}){}",
            cut.from,
            cut.to,
            seconds(cut),
            cut.seam_cm,
            if cut.still { "; the figure stands" } else { "" }
        )?;
    }
    ensure!(!cuts.is_empty(), "{}: no stretch looks like a cycle", place());
    Ok(())
}

/// Motions that a clip without a bound on rotations leaves out are mentioned from this many degrees on.
const TOLD_DEGREES: f64 = 1.0;
/// So many of them are named.
const NAMED_CHANNELS: usize = 3;

/// A clip that keeps its bound.
pub(super) struct Made {
    pub bytes: Vec<u8>,
    /// Number of its bytes, which outlives them.
    pub len: usize,
    pub json: Value,
    /// The errors as a clause for the user.
    errors: String,
    /// The same for a table's column.
    pub cell: String,
    pub frames: usize,
    channels: usize,
    /// Every file that was read for it.
    pub read: Vec<PathBuf>,
    /// What is odd about the motion, a sentence each.
    pub warnings: Vec<String>,
    /// What else the user should know, a sentence each.
    pub notes: Vec<String>,
}

impl Made {
    /// A clip of `motion`. What was read for it, and what is odd, is for the caller to add.
    fn new(motion: &Motion, bytes: Vec<u8>, json: Value, errors: String, cell: String, notes: Notes) -> Made {
        let (frames, channels) = (motion.frames, motion.rig.channels());
        Made {
            len: bytes.len(),
            bytes,
            json,
            errors,
            cell,
            frames,
            channels,
            read: Vec::new(),
            warnings: Vec::new(),
            notes: notes.said,
        }
    }

    /// The same after its bytes were written: a report of many keeps them no longer.
    pub fn without_bytes(self) -> Made {
        Made { bytes: Vec::new(), ..self }
    }

    /// The fields of a report.
    pub fn fields(&self) -> Map<String, Value> {
        let mut fields = self.json.as_object().cloned().unwrap_or_default();
        fields.insert("frames".into(), json!(self.frames));
        fields.insert("bytes".into(), json!(self.len));
        fields.insert("warnings".into(), json!(self.warnings));
        fields
    }

    /// Sizes and errors, for the user.
    pub fn sentence(&self, output: &Path) -> String {
        let raw = self.frames * self.channels * 2;
        let saved = match raw {
            0 => String::new(),
            raw => format!(", {:.1} % saved", 100.0 - 100.0 * self.bytes.len() as f64 / raw as f64),
        };
        format!(
            "{}: {} frames, {} channels; {} bytes ({raw} per frame at 16 bits{saved}); {}",
            output.display(),
            self.frames,
            self.channels,
            self.bytes.len(),
            self.errors
        )
    }
}

/// What a conversion says: at once, or kept for the report of many.
struct Notes {
    silent: bool,
    said: Vec<String>,
}

impl Notes {
    fn of(arguments: &Arguments) -> Notes {
        Notes { silent: arguments.silent, said: Vec::new() }
    }

    fn say(&mut self, sentence: String) {
        if !self.silent {
            note!("{sentence}");
        }
        self.said.push(sentence);
    }
}

/// Prints what the conversions of several motions say, each under its label. What several of them say alike is said once.
pub(super) fn say_of_each<'a>(all: impl Iterator<Item = (&'a str, &'a [String])>) {
    let mut sentences: Vec<(&str, &str, usize)> = Vec::new();
    let mut places: HashMap<&str, usize> = HashMap::new();
    let mut motions = 0;
    for (label, said) in all {
        motions += 1;
        for sentence in said {
            let place = *places.entry(sentence).or_insert(sentences.len());
            match sentences.get_mut(place) {
                Some((.., count)) => *count += 1,
                None => sentences.push((sentence, label, 1)),
            }
        }
    }
    for (sentence, label, count) in sentences {
        match count {
            1 => note!("{label}: {sentence}"),
            _ if count == motions => note!("all {count}: {sentence}"),
            _ => note!("{label} and {} others: {sentence}", count - 1),
        }
    }
}

/// A function that takes the part of a fit that is done, from 0 to 1.
pub(super) type Progress<'a> = &'a (dyn Fn(f64) + Sync);

/// Converts one file and writes the clip.
pub(super) fn convert(arguments: &Arguments, progress: Progress<'_>) -> Result<Made> {
    let prepared = prepare(arguments)?;
    arguments.check_outputs(&prepared.read)?;
    let made = prepared.code(arguments, &prepared.coding(arguments), progress)?;
    // A clip opens with its own rig alone: a new one beside an old one would be lost.
    let rig = arguments.rig_out.as_deref().map(|path| (path, prepared.rig.as_slice()));
    let outputs: Vec<(&Path, &[u8])> = rig.into_iter().chain([(arguments.output(), made.bytes.as_slice())]).collect();
    output::write_together(&outputs)?;
    Ok(made)
}

/// A motion after all edits, and what its clip must keep.
pub(super) struct Prepared {
    pub motion: Motion,
    /// The bytes of the motion's rig.
    pub rig: Vec<u8>,
    /// Every file that was read for it.
    pub read: Vec<PathBuf>,
    /// What is odd about the motion, a sentence each.
    warnings: Vec<String>,
    notes: Vec<String>,
    bound: Bound,
    /// What closing a loop moved.
    seam: Option<Seam>,
    retarget_max_cm: Option<f64>,
}

/// A loop's source, and what closing its seam took of the bound.
struct Seam {
    /// The motion before its seam was closed, without the last frame.
    source: Motion,
    /// The bound against it.
    bound: Bound,
    closed: Map<String, Value>,
}

/// Imports one file and applies the edits.
pub(super) fn prepare(arguments: &Arguments) -> Result<Prepared> {
    let mut prepared = prepare_without_footsteps(arguments)?;
    prepared.find_footsteps(arguments)?;
    Ok(prepared)
}

/// The same before footsteps are found: they depend on the direction that is up, on which several motions agree first.
pub(super) fn prepare_without_footsteps(arguments: &Arguments) -> Result<Prepared> {
    let options = arguments.import_options();
    let imported = import::load(&arguments.input, &options)?;
    let mut notes = Notes::of(arguments);
    if !arguments.silent {
        imported.warnings.iter().for_each(|warning| note!("warning: {warning}"));
    }
    notes.say(imported.units);
    let place = || arguments.input.display().to_string();
    if let Some(sentence) = arguments.edits.on_sampled(&arguments.input, &options)? {
        notes.say(sentence);
    }
    let edited = arguments.edits.apply(imported.motion, arguments.fps, &options.files).with_context(place)?;
    let read = options.files.read_so_far();
    read.iter().for_each(|path| detail!("read {}", path.display()));
    edited.said.into_iter().chain(arguments.without_effect(&edited.motion)).for_each(|sentence| notes.say(sentence));
    let mut motion = edited.motion;
    if arguments.rotations == Rotations::Quaternion {
        motion = quaternions(&motion);
    }
    check_fit(&motion, arguments.effort, &options.files).with_context(place)?;
    let mut bound = match arguments.channels.bounds(&motion)? {
        Some(bounds) => {
            // Bounds of channels do not see where the joints are.
            let usual = joint_error::DEFAULT.cm(&motion).unwrap_or(1.0);
            ensure!(
                imported.error_cm < 0.5 * usual,
                "{}: the file's joints are only known within {:.3e} cm; a bound of channels needs them within {:.3e} cm",
                place(),
                imported.error_cm,
                0.5 * usual
            );
            Bound::Channels(bounds)
        }
        None => {
            Bound::Distance(Distance::of(arguments, &motion).and_then(|bound| bound.less(imported.error_cm)).with_context(place)?)
        }
    };
    let mut seam = None;
    if arguments.edits.looped {
        let whole = bound.clone();
        let closed = bound.close(&motion).with_context(place)?;
        closed_sentences(&closed, &motion).into_iter().for_each(|sentence| notes.say(sentence));
        if !motion.looped {
            let source = cut(&motion, None, Some(closed.motion.frames - 1))?;
            seam = Some(Seam { source, bound: whole, closed: closed_json(&closed) });
        }
        motion = closed.motion;
    }
    let rig = rig::encode(&motion.rig)?;
    let (warnings, notes) = (imported.warnings, notes.said);
    Ok(Prepared { motion, rig, read, warnings, notes, bound, seam, retarget_max_cm: edited.retarget_max_cm })
}

impl Prepared {
    /// States another direction as up.
    pub fn set_up(&mut self, up: Up) -> Result<()> {
        self.motion.rig.up = up;
        self.rig = rig::encode(&self.motion.rig)?;
        Ok(())
    }

    /// Adds the events of footsteps, if they are asked for.
    pub fn find_footsteps(&mut self, arguments: &Arguments) -> Result<()> {
        let found = arguments.edits.add_footsteps(&mut self.motion);
        if let Some(sentence) = found.with_context(|| arguments.input.display().to_string())? {
            let mut notes = Notes::of(arguments);
            notes.say(sentence);
            self.notes.append(&mut notes.said);
        }
        Ok(())
    }

    /// The cheapest coding for this motion alone.
    fn coding(&self, arguments: &Arguments) -> Coding {
        shared_coding(std::slice::from_ref(self), arguments)
    }

    /// The clip in a coding; its errors are those of the device's decoder.
    pub fn code(&self, arguments: &Arguments, coding: &Coding, progress: Progress<'_>) -> Result<Made> {
        progress(0.0);
        let mut made = match &self.bound {
            Bound::Channels(bounds) => by_channel(arguments, self, bounds, coding, progress)?,
            Bound::Distance(distance) => by_distance(arguments, self, distance, coding, progress)?,
        };
        if let (Some(cm), Some(fields)) = (self.retarget_max_cm, made.json.as_object_mut()) {
            fields.insert("retarget_max_cm".into(), json!(cm));
        }
        (made.read, made.warnings) = (self.read.clone(), self.warnings.clone());
        made.notes.splice(0..0, self.notes.iter().cloned());
        Ok(made)
    }
}

/// The cheapest coding for motions of one rig together.
pub(super) fn shared_coding(prepared: &[Prepared], arguments: &Arguments) -> Coding {
    let motion = |prepared: &Prepared| match &prepared.bound {
        Bound::Distance(distance) => (distance.plan(arguments.effort).bound, arguments.rotations),
        // Bounds of channels are bounds of the file's own angles.
        Bound::Channels(_) => (PoseBound::places(f64::INFINITY), Rotations::Euler),
    };
    let rotations = prepared.first().map_or(Rotations::Euler, |first| motion(first).1);
    let motions: Vec<_> = prepared.iter().map(|prepared| (&prepared.motion, motion(prepared).0)).collect();
    Coding::of(&motions, rotations)
}

/// What a conversion keeps to.
#[derive(Clone)]
enum Bound {
    Distance(Distance),
    Channels(Bounds),
}

/// The errors of joints and scalars that a conversion keeps to.
#[derive(Clone, Copy)]
struct Distance {
    /// Of joints.
    pose: PoseBound,
    /// Of scalars, as a part of full scale.
    scalar_part: f64,
}

/// The bound of scalars without an option, in percent of full scale.
const MAX_SCALAR_PERCENT: f64 = 2.0;
/// The bound of every joint, relative to the mean.
const MAX_OF_MEAN: f64 = 6.0;

impl Distance {
    fn of(arguments: &Arguments, motion: &Motion) -> Result<Distance> {
        let mean_cm = arguments.mean_error.map(|mean| mean.cm(motion)).transpose()?;
        let max_cm = match (arguments.max_error, mean_cm) {
            (Some(max), _) => max.cm(motion)?,
            (None, Some(mean)) => MAX_OF_MEAN * mean,
            (None, None) => joint_error::DEFAULT.cm(motion)?,
        };
        ensure!(
            mean_cm.is_none_or(|mean| mean <= max_cm),
            "--mean-error {} cm is more than --max-error, {max_cm} cm",
            mean_cm.unwrap_or_default()
        );
        let shell = match arguments.shell {
            _ if arguments.places_only => Shell::Places,
            Some(shell) => Shell::Cm(shell.cm(motion)?),
            None => Shell::Cm(verify::shell_radius_cm(motion)),
        };
        let (max_rotation_deg, max_joint_deg) = (arguments.max_rotation_error, arguments.max_joint_error);
        let pose = PoseBound { max_cm, shell, max_rotation_deg, max_joint_deg, mean_cm };
        Ok(Distance { pose, scalar_part: arguments.max_scalar_error.unwrap_or(MAX_SCALAR_PERCENT) / 100.0 })
    }

    /// What is left of the bound for a motion whose joints are `error_cm` from where the file has them: no joint is farther than all of it from the
    /// file.
    fn less(self, error_cm: f64) -> Result<Distance> {
        let PoseBound { max_cm, mean_cm, .. } = self.pose;
        ensure!(
            error_cm == 0.0 || error_cm < 0.5 * mean_cm.unwrap_or(max_cm),
            "the file is only known within {error_cm:e} cm, which is too much of the bound"
        );
        let pose = PoseBound { max_cm: max_cm - error_cm, mean_cm: mean_cm.map(|mean| mean - error_cm), ..self.pose };
        Ok(Distance { pose, ..self })
    }

    fn plan(&self, effort: Level) -> Plan {
        // A looser bound than by default saves nothing, and leaves first codes too much room.
        let max_cm = self.pose.mean_cm.map_or(self.pose.max_cm, |mean| self.pose.max_cm.min(MAX_OF_MEAN * mean));
        effort.plan(PoseBound { max_cm, ..self.pose })
    }
}

/// What closing a loop may take of the bound.
const CLOSING: f64 = 0.9;

impl Bound {
    /// Closes a loop, and leaves of the bound what that did not take: in the end no joint is farther than all of it from the source.
    fn close(&mut self, motion: &Motion) -> Result<Closed> {
        let scalars = |moved: &[f64]| {
            let parts = motion
                .rig
                .scalars
                .iter()
                .zip(&moved[motion.rig.joint_channels()..])
                .map(|(scalar, moved)| moved / scalar.full_scale);
            parts.fold(0.0, f64::max)
        };
        match self {
            Bound::Distance(distance) => {
                let Distance { pose, scalar_part } = distance;
                let closed = loop_seam::close(motion, Most::Distance(pose, *scalar_part))?;
                // Half of the seam at most, or a little more where joints turn far: then there is nothing left to code with.
                let max_cm = pose.max_cm;
                ensure!(
                    closed.moved_cm < CLOSING * max_cm,
                    "--loop: closing the seam moves {} by {:.3} cm, which leaves too little of the bound of {max_cm} cm; a bound above {:.3} cm will do",
                    closed.joint,
                    closed.moved_cm,
                    closed.moved_cm / CLOSING
                );
                pose.max_cm -= closed.moved_cm;
                *scalar_part -= scalars(&closed.moved);
                for (most, turned, option) in [
                    (&mut pose.max_rotation_deg, closed.turned_deg, "--max-rotation-error"),
                    (&mut pose.max_joint_deg, closed.turned_joint_deg, "--max-joint-error"),
                ] {
                    let Some(most) = most else { continue };
                    ensure!(
                        turned < CLOSING * *most,
                        "--loop: closing the seam turns a joint by {turned:.3} degrees, which leaves too little of {option} {most}"
                    );
                    *most -= turned;
                }
                if let Some(mean_cm) = pose.mean_cm {
                    let source = cut(motion, None, Some(closed.motion.frames - 1))?;
                    let moved = compare(&source, &closed.motion, pose.shell_cm().unwrap_or(0.0))?.bounded_mean_cm(pose);
                    ensure!(
                        moved < CLOSING * mean_cm,
                        "--loop: closing the seam moves the joints by {moved:.4} cm in the mean, which leaves too little of --mean-error {mean_cm} cm"
                    );
                    pose.mean_cm = Some(mean_cm - moved);
                }
                Ok(closed)
            }
            Bound::Channels(bounds) => {
                let closed = loop_seam::close(motion, Most::Channels(bounds))?;
                bounds.greatest.iter_mut().zip(&closed.moved).for_each(|(greatest, moved)| *greatest -= moved);
                Ok(closed)
            }
        }
    }
}

/// What closing a seam moved, for a report.
fn closed_json(closed: &Closed) -> Map<String, Value> {
    let fields = [
        ("seam_cm", json!(closed.seam_cm)),
        ("seam_joint", json!(closed.seam_joint)),
        ("seam_moved_cm", json!(closed.moved_cm)),
        ("seam_moved_joint", json!(closed.joint)),
        ("seam_turned_deg", json!(closed.turned_deg)),
    ];
    fields.into_iter().map(|(name, value)| (name.into(), value)).collect()
}

fn closed_sentences(closed: &Closed, motion: &Motion) -> Vec<String> {
    if motion.looped {
        return vec!["loop: it is one already".into()];
    }
    let joint = if closed.joint.is_empty() { String::new() } else { format!(" ({})", closed.joint) };
    let travel =
        closed.travel.iter().map(|(name, way)| format!("loop: {name} goes {way:.3} units on each time round, which stays"));
    let seam = format!("loop: the greatest seam is {:.4} cm ({})", closed.seam_cm, closed.seam_joint);
    let moved =
        format!("loop: closing the seam moved joints by up to {:.4} cm{joint}; {} frames", closed.moved_cm, closed.motion.frames);
    (!closed.seam_joint.is_empty()).then_some(seam).into_iter().chain([moved]).chain(travel).collect()
}

/// The clip's bytes, with the index that was asked for; says what it costs.
fn file(arguments: &Arguments, coded: &clip::Coded, rig: &[u8], notes: &mut Notes) -> Result<Vec<u8>> {
    let apart = arguments.rig_out.is_some();
    let plain = clip::encode(coded, rig, apart)?;
    let Some(seconds) = arguments.index else { return Ok(plain) };
    let spacing = (seconds * 1e9 / f64::from(coded.frame_time_ns)).round();
    let frame = f64::from(coded.frame_time_ns) * 1e-9;
    ensure!(
        (1.0..=f64::from(MAX_FRAMES)).contains(&spacing),
        "--index {}: expected seconds, from {frame} (a frame) to {} ({MAX_FRAMES} frames)",
        Number(seconds),
        frame * f64::from(MAX_FRAMES)
    );
    let bytes = clip::encode_with_index(coded, rig, apart, spacing as u32)?;
    let cost = bytes.len() - plain.len();
    let part = 100.0 * cost as f64 / plain.len() as f64;
    notes.say(format!("index: a snapshot each {spacing} frames costs {cost} bytes ({part:.1} % more)"));
    Ok(bytes)
}

fn by_distance(
    arguments: &Arguments,
    prepared: &Prepared,
    distance: &Distance,
    coding: &Coding,
    progress: Progress<'_>,
) -> Result<Made> {
    let Prepared { motion, rig, .. } = prepared;
    let (plan, part) = (distance.plan(arguments.effort), distance.scalar_part);
    let coded = fit_coding(motion, coding, plan, part, &mut |done| progress(done))?;
    let mut notes = Notes::of(arguments);
    let bytes = file(arguments, &coded, rig, &mut notes)?;
    let not_written = || format!("{}: not written", arguments.output().display());
    // Errors are those against the source, whatever closing a loop moved.
    let (source, whole) = match &prepared.seam {
        Some(Seam { source, bound: Bound::Distance(whole), .. }) => (source, whole),
        _ => (motion, distance),
    };
    let report = verify::verify(&bytes, rig, source, &whole.pose, whole.scalar_part).with_context(not_written)?;
    if let Some(mean_cm) = whole.pose.mean_cm {
        let mean = report.bounded_mean_cm(&whole.pose);
        ensure!(mean <= mean_cm, "{}: joints are {mean:.5} cm off in the mean; --mean-error is {mean_cm} cm", not_written());
    }
    left_out(motion, &coded, &whole.pose).into_iter().for_each(|sentence| notes.say(sentence));
    let (errors, cell) = (errors::to_text(&report, motion), errors::to_cell(&report, motion));
    let mut json = errors::to_json(&report, motion);
    json.extend(prepared.seam.iter().flat_map(|seam| seam.closed.clone()));
    Ok(Made::new(motion, bytes, json.into(), errors, cell, notes))
}

/// Names motions that the clip leaves out: of joints that are not bounded, and rotations that places do not show.
fn left_out(motion: &Motion, coded: &clip::Coded, pose: &PoseBound) -> Vec<String> {
    let bounded = pose_bound::bounded(&motion.rig);
    let range = |channel: usize| {
        let values = motion.values[channel].iter();
        values.clone().copied().fold(f64::MIN, f64::max) - values.copied().fold(f64::MAX, f64::min)
    };
    let still = |channel: &usize| matches!(coded.channels[*channel].start, Start::Rest | Start::Constant { .. });
    let kinds = motion.rig.channel_kinds();
    let helper = |joint: Option<usize>| joint.is_some_and(|joint| !bounded[joint]);
    let turns = |channel: usize| kinds[channel].1.is_rotation() || kinds[channel].1.is_exponential();
    let channels = |of: &dyn Fn(usize) -> bool| -> Vec<String> {
        let found = (0..motion.rig.joint_channels()).filter(still).filter(|&channel| of(channel));
        found.map(|channel| motion.rig.channel_name(channel)).collect()
    };
    let helpers = channels(&|channel| helper(kinds[channel].0) && range(channel) > 0.0);
    let rotations = channels(&|channel| {
        !pose.sees_rotations() && !helper(kinds[channel].0) && turns(channel) && range(channel) > TOLD_DEGREES
    });
    let sentence = |names: Vec<String>, what: &str| {
        let more = names.len().saturating_sub(NAMED_CHANNELS);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        let shown = names.iter().take(NAMED_CHANNELS).cloned().collect::<Vec<_>>().join(", ");
        (!names.is_empty()).then(|| format!("{what}: {shown}{more}"))
    };
    let helpers = sentence(helpers, "helper bones are not bounded, and stay at rest in the clip");
    let rotations = sentence(rotations, "--places-only: rotations that hardly move a joint are constant in the clip");
    helpers.into_iter().chain(rotations).collect()
}

fn by_channel(
    arguments: &Arguments,
    prepared: &Prepared,
    bounds: &Bounds,
    coding: &Coding,
    progress: Progress<'_>,
) -> Result<Made> {
    let Prepared { motion, rig, .. } = prepared;
    let mut bounds = bounds.clone();
    bounds.at_least_steps(motion, coding.length_exponent);
    let bounds = &bounds;
    let (channels, done) = (motion.rig.channels() as f64, AtomicUsize::new(0));
    let step = || progress((done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / channels);
    let not_written = || format!("{}: not written", arguments.output().display());
    let coded = channelwise::fit_exponent(motion, bounds, coding.length_exponent, &step).with_context(not_written)?;
    let mut notes = Notes::of(arguments);
    if let Some((channel, asked)) = bounds.raised(motion) {
        notes.say(format!(
            "warning: the figure is so far from its origin that positions have steps of {:.3e}: {} and channels like it keep this bound, not the {asked:.3e} \
             that was asked for",
            bounds.greatest[channel],
            motion.rig.channel_name(channel)
        ));
    }
    let bytes = file(arguments, &coded, rig, &mut notes)?;
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
    let errors = match bounds.constraint {
        Constraint::Positions => format!("error max {}", worst.sentence(motion)),
        Constraint::Accelerations => {
            format!("error max {}, a frame^2; drift max {}", worst.sentence(motion), report.drift.sentence(motion))
        }
    };
    Ok(Made::new(motion, bytes, json, errors, worst.sentence(motion), notes))
}
