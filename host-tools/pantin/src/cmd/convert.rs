//! `pantin convert`.

use super::channel_bound::{ChannelBound, above_zero, degrees};
use super::convert_list::ListEntry;
use super::edits::Edits;
use super::encoder::Rotations;
use super::shard::{self, Shard};
use super::{bank, batch, convert_bank, convert_list, convert_stream, default_output, same_form, up_axis};
use crate::memory::{self, limit};
use crate::output::{self, Wanted, detail, note, outln, refuse_foreign};
use crate::words;
use anyhow::{Context, Result, bail, ensure};
use indicatif::ProgressBar;
use pantin::Up;
use pantin_convert::edit::find_loop::{self, Cut};
use pantin_convert::import::ImportOptions;
use pantin_convert::motion::Motion;
use pantin_convert::{Coding, Length, Level, Note, NoteKind, Options, Prepared, Recipe, UseKeys, shared_coding};
use serde_json::{Map, Value, json};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

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
  pantin convert motions/walk.keys -o walk.ptn --segments
  pantin convert walk.bvh -o walk.ptn --index 2
  pantin convert walk.bvh -o walk.ptn --max-channel-error 0.5
  pantin convert walk.bvh -o walk.ptn --footsteps --event clap@12 --event 'door opens@1.5s'
  pantin convert face.csv -o face.ptn --max-scalar-error 2
  pantin convert servos.tsv -o servos.ptn --fps 50
  pantin convert captures -o clips --dry-run
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
  capture-program | pantin convert - --stream -o take
  pantin convert captures -o moves.ptb
  pantin convert moves.list -o moves.ptb --same-form")]
pub struct Arguments {
    /// The motion: .bvh, .amc (its .asf beside it), .glb or .gltf, .fbx, .wrl or .x3dv, key frames (.keys, see docs/KEYFRAMES.md), functions of time
    /// (.proc, see docs/PROCEDURAL.md), a face from Live Link Face (.csv) or in MPEG-4 parameters (.fap), or a table of channels
    /// with a row of names (.csv, .tsv). For a bank also a list (.list): a motion a line, with its own --name, --animation, --fps, --cm-per-unit,
    /// --skeleton, --max-error, --mean-error, --max-rotation-error and changes, as in `walk.bvh --from 65 --to 129 --loop --max-error 1.5cm`
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
    /// Write nothing; print the stretches of the motion that make the best loops, with the options that cut them out. With --max-rotation-error those whose joints
    /// turn by more at the seam are left out
    #[arg(long, conflicts_with_all = ["list", "same_form", "more", "bound", "mean_error", "max_scalar_error", "max_joint_error", "shell", "places_only", "index", "jobs", "events", "footsteps", "looped", "close_loop"])]
    find_loop: bool,
    /// Write nothing; print what would be written, after reading and checking the motions
    #[arg(long, conflicts_with_all = ["list", "find_loop"])]
    pub(super) dry_run: bool,
    /// Largest distance of any bounded point from its original position: of each joint, of the three points of its shell (see --shell)
    /// and of each End Site. A number with cm, mm, m or in (default unit cm), or with % of the figure's height
    /// [default: 0.5cm, or 6 times --mean-error]
    #[arg(long, group = "bound", value_parser = str::parse::<Length>)]
    max_error: Option<Length>,
    /// Mean error of the joints, End Sites left out, in the same units: the clip is as small as its mean allows, instead of filling
    /// --max-error, which still holds for every joint. A joint's error is the largest distance of its shell's points
    #[arg(long, conflicts_with_all = ChannelBound::OPTIONS, value_parser = str::parse::<Length>)]
    mean_error: Option<Length>,
    /// Distance of the shell's points from their joint, in the units of --max-error. The points lie along the joint's own axes, so that
    /// --max-error bounds how each joint is turned, too
    /// [default: 3cm, or 3% for a figure below 1 m]
    #[arg(long, value_name = "LENGTH|PERCENT", conflicts_with_all = ChannelBound::OPTIONS, value_parser = str::parse::<Length>)]
    shell: Option<Length>,
    /// Bound the places of joints and End Sites alone, without their shells. For figures that are drawn as lines between joints: a head's
    /// yaw or a forearm's twist may be lost
    #[arg(long, conflicts_with = "shell", conflicts_with_all = ChannelBound::OPTIONS)]
    places_only: bool,
    /// Encoder effort from 1 (fast) to 9 (best): speed against size. Each level takes at most 1.8 times the time of the one below; the default is 6
    #[arg(long, value_name = "1..9|fast|default|best", default_value = "default", hide_default_value = true, value_parser = str::parse::<Level>)]
    effort: Level,
    /// How joints with three Euler angles are coded
    #[arg(long, value_enum, default_value = "by-cost")]
    rotations: Rotations,
    /// Largest error of channels that move no joint, in percent of their full scale
    /// [default: 2]
    #[arg(long, value_name = "PERCENT", conflicts_with_all = ChannelBound::OPTIONS, value_parser = above_zero)]
    max_scalar_error: Option<f64>,
    /// Largest angle between the original and the decoded rotation of any joint in the world, in degrees, at most 180
    #[arg(long, value_name = "DEGREES", conflicts_with_all = ChannelBound::OPTIONS, value_parser = degrees)]
    max_rotation_error: Option<f64>,
    /// Largest angle between the original and the decoded rotation of any joint in its parent, in degrees, at most 180: for skinned meshes. A single Euler
    /// angle, as a servo gets it, can be off by more: --max-channel-error bounds each
    #[arg(long, value_name = "DEGREES", conflicts_with_all = ChannelBound::OPTIONS, value_parser = degrees)]
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
    /// Write a key clip even if it is larger than segments, and fail if there is none. A key clip holds the motion's keys and their interpolation,
    /// exactly, and only players with feature `keys` play it. Default: the smaller of the two, for .keys files and other curves whose keys lie on
    /// frames, but segments with --index, with --same-form and in banks
    #[arg(long, conflicts_with_all = ["same_form", "index", "segments"])]
    keys: bool,
    /// Write segments (version 1 of the format), which players without feature `keys` play, too
    #[arg(long)]
    segments: bool,
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
    /// Convert BVH from standard input or a pipe while it is captured, into a folder of clips: --output. Each clip is written as soon as its frames have come;
    /// the next one begins with the frame behind its last. The clips share one rig, figure.rig in the folder, and the number in a clip's name is its
    /// first frame. `Frames: 0` means that the number is not known
    #[arg(long, requires = "output", conflicts_with_all = ["more", "list", "find_loop", "dry_run", "same_form", "rig_out", "jobs", "shard", "animation", "skeleton", "keys", "fps", "max_scalar_error", "max_channel_error", "max_accel_error", "exact"])]
    stream: bool,
    /// With --stream: how long a frame waits, at most, for later frames of its clip before the clip is encoded. A shorter delay costs bytes, because each clip
    /// states the start of every channel again
    #[arg(long, value_name = "SECONDS", default_value_t = 4.0, requires = "stream", value_parser = delay)]
    pub(super) delay: f64,
    /// Whether this is one file of a folder, whose messages the folder's table replaces.
    #[arg(skip)]
    silent: bool,
    /// Whether the output's name is a default: a file that is there is kept, unless it is this clip, up to date.
    #[arg(skip)]
    pub(super) keeps_existing: bool,
}

/// Seconds, as `4`, `0.5` or `4s`.
fn delay(text: &str) -> Result<f64, String> {
    above_zero(text.trim().strip_suffix('s').unwrap_or(text))
}

impl Arguments {
    pub(super) fn output(&self) -> &Path {
        self.output.as_deref().unwrap_or(Path::new(""))
    }

    /// The conversion that the options ask for.
    pub(super) fn recipe(&self) -> Recipe {
        let mut import = ImportOptions::new().memory(limit());
        (import.cm_per_unit, import.up) = (self.cm_per_unit, self.up);
        // At its own rate first, so that --rate means the frames of the file.
        import.fps = self.fps.filter(|_| self.edits.rate.is_none());
        (import.skeleton, import.animation) = (self.skeleton.clone(), self.animation.clone());
        let mut options = Options::new().effort(self.effort).rotations(self.rotations.into()).memory(limit());
        (options.max_error, options.mean_error) = (self.max_error, self.mean_error);
        (options.max_scalar_error, options.max_rotation_error) = (self.max_scalar_error, self.max_rotation_error);
        (options.shell, options.places_only) = (self.shell, self.places_only);
        options.max_joint_error = self.max_joint_error;
        (options.channels, options.index) = (self.channels.bound(), self.index);
        (options.looped, options.footsteps) = (self.edits.looped, self.edits.footsteps);
        // Boards' stores, the page and state machines of older players read banks.
        let segments = self.segments || self.same_form || bank::is_bank_name(self.output());
        options.keys = match (self.keys, segments) {
            (true, _) => UseKeys::Always,
            (_, true) => UseKeys::Never,
            _ => UseKeys::IfSmaller,
        };
        options.rig_apart = self.rig_out.is_some();
        Recipe::new().import(import).edits(self.edits.edits(self.fps)).options(options)
    }

    /// Whether the user says which way is up.
    pub(super) fn up_is_given(&self) -> bool {
        self.up.is_some()
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

    /// Prints notes, unless a table of many replaces them.
    fn say(&self, notes: &[Note]) {
        if !self.silent {
            notes.iter().for_each(print);
        }
    }

    /// The same for one of several motions.
    pub(super) fn for_motion(&self, input: PathBuf, output: PathBuf) -> Arguments {
        Arguments { input, more: Vec::new(), output: Some(output), ..self.clone() }
    }

    /// Takes the options of a list's line, which go before those of the command. Refuses a bound beside one of the command that excludes it.
    pub(super) fn take_line(&mut self, line: ListEntry) -> Result<()> {
        let bounded = line.max_error.is_some() || line.mean_error.is_some() || line.max_rotation_error.is_some();
        ensure!(!bounded || !self.channels.is_given(), "the command bounds channels one by one: leave the line's bound out");
        self.max_error = line.max_error.or(self.max_error);
        self.mean_error = line.mean_error.or(self.mean_error);
        self.max_rotation_error = line.max_rotation_error.or(self.max_rotation_error);
        (self.edits, self.animation) = (line.edits, line.animation);
        self.fps = line.fps.or(self.fps);
        self.cm_per_unit = line.cm_per_unit.or(self.cm_per_unit);
        self.skeleton = line.skeleton.or(self.skeleton.take());
        Ok(())
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
    if arguments.stream {
        return convert_stream::run(arguments);
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
    if arguments.dry_run {
        return dry_run(arguments);
    }
    // Drawn when the motion is read.
    let bar = OnceLock::new();
    let begin = || output::progress(1000, "fitting {wide_bar} {percent} % {eta} left").unwrap_or_else(|_| ProgressBar::hidden());
    let made = convert(arguments, &|part| bar.get_or_init(begin).set_position((part * 1000.0) as u64))?;
    bar.get_or_init(begin).finish_and_clear();
    let mut fields = made.fields();
    // Printed already, which puts them into the report.
    fields.remove("notes");
    output::report(fields.into());
    made.sentence(arguments.output()).lines().for_each(|line| note!("{line}"));
    Ok(())
}

/// Reads and checks one motion, and prints what a conversion would write.
fn dry_run(arguments: &Arguments) -> Result<()> {
    let (prepared, read) = prepare(arguments)?;
    arguments.check_outputs(&read)?;
    let (motion, output) = (&prepared.motion, arguments.output().display().to_string());
    let seconds = motion.frames as f64 * motion.frame_time;
    let rig = arguments.rig_out.as_ref().map(|rig| rig.display().to_string());
    output::report(json!({
        "would_write": rig.iter().chain([&output]).collect::<Vec<_>>(),
        "frames": motion.frames,
        "channels": motion.rig.channels(),
        "seconds": seconds,
    }));
    let rig = rig.map_or_else(String::new, |rig| format!(", and its rig as {rig}"));
    let (frames, channels) = (motion.frames, motion.rig.channels());
    note!("{output}: would be written{rig}: {frames} frames, {channels} channels, {seconds:.2} s; nothing was written");
    Ok(())
}

/// Prints proposals for --from and --to.
fn find_loop(arguments: &Arguments) -> Result<()> {
    ensure!(
        arguments.output.is_none() && arguments.rig_out.is_none(),
        "--find-loop writes no file: leave --output and --rig-out out"
    );
    let place = || arguments.input.display().to_string();
    let edited = arguments.recipe().edited(&memory::disk(), &arguments.input)?;
    edited.notes.iter().for_each(print);
    let motion = edited.motion;
    if motion.looped {
        note!("{}: a loop already: --from and --to would make another of it", place());
    }
    let mut cuts = find_loop::find(&motion, &arguments.recipe().options).with_context(place)?;
    // Frames count as those of --from and --to do: before the cut.
    let first = arguments.edits.first_frame(motion.frame_time);
    cuts.iter_mut().for_each(|cut| (cut.from, cut.to) = (cut.from + first, cut.to + first));
    let seconds = |cut: &Cut| (cut.to - cut.from) as f64 * motion.frame_time;
    // Above the least bound, in whole millimetres.
    let asked_cm = if let Length::Cm(cm) = Options::MAX_ERROR { cm } else { 0.0 };
    let bound_cm = |cut: &Cut| asked_cm.max(((cut.bound_cm * 10.0).floor() + 1.0) / 10.0);
    if output::is_json() {
        let object = |cut: &Cut| json!({"from": cut.from, "to": cut.to, "seam_cm": cut.seam_cm, "seam_degrees": cut.seam_deg, "max_error_cm": bound_cm(cut), "joint": cut.joint, "seconds": seconds(cut), "still": cut.still});
        output::report(json!({"loops": cuts.iter().map(object).collect::<Vec<_>>()}));
        return Ok(());
    }
    let turning = arguments.max_rotation_error.map_or_else(String::new, |most| format!(" --max-rotation-error {most}"));
    for cut in &cuts {
        let (frames, joint) = (cut.to - cut.from, output::clean(&cut.joint));
        outln!(
            "--from {} --to {} --loop --max-error {}cm{turning}: {frames} frames, {:.2} s, seam {:.3} cm ({joint}), {:.1} degrees{}",
            cut.from,
            cut.to,
            bound_cm(cut),
            seconds(cut),
            cut.seam_cm,
            cut.seam_deg,
            if cut.still { "; the figure stands" } else { "" }
        )?;
    }
    let within =
        arguments.max_rotation_error.map_or_else(String::new, |most| format!(" whose seam turns no joint by {most} degrees"));
    ensure!(!cuts.is_empty(), "{}: no stretch looks like a cycle{within}", place());
    if !cuts.iter().any(|cut| cut.still) {
        let turned = arguments
            .max_rotation_error
            .map_or_else(String::new, |most| format!(", or a joint turns by {most} degrees at the seam"));
        note!("{}: no line for standing: the figure moves all the time, or stands for less than a second{turned}", place());
    }
    Ok(())
}

/// Prints a note.
fn print(note: &Note) {
    note!("{}", words::line(note));
}

/// A clip that keeps its bound.
pub(super) struct Made {
    pub bytes: Vec<u8>,
    /// Number of its bytes, which outlives them.
    pub len: usize,
    json: Map<String, Value>,
    /// The errors as a clause for the user.
    errors: String,
    /// The errors in short, for a table's column.
    pub cell: String,
    pub frames: usize,
    channels: usize,
    /// Every file that was read for it.
    pub read: Vec<PathBuf>,
    pub notes: Vec<Note>,
}

impl Made {
    fn new(made: pantin_convert::Made, motion: &Motion, read: &[PathBuf]) -> Made {
        let pantin_convert::Made { clip, report, notes, .. } = made;
        Made {
            len: clip.len(),
            bytes: clip,
            json: report.to_json(motion),
            errors: report.to_text(motion),
            cell: report.to_cell(motion),
            frames: report.frames,
            channels: report.channels,
            read: read.to_vec(),
            notes,
        }
    }

    /// The same after its bytes were written: a report of many keeps them no longer.
    pub fn without_bytes(self) -> Made {
        Made { bytes: Vec::new(), ..self }
    }

    /// The fields of a report.
    pub fn fields(&self) -> Map<String, Value> {
        let warnings: Vec<String> = self.notes.iter().filter(|note| note.is_warning()).map(words::sentence).collect();
        let infos: Vec<String> = self.notes.iter().filter(|note| !note.is_warning()).map(words::sentence).collect();
        let typed = |note: &Note| {
            let mut fields = note.fields();
            fields.insert("text".into(), words::sentence(note).into());
            fields
        };
        let diagnostics: Vec<Map<String, Value>> = self.notes.iter().map(typed).collect();
        let mut fields = self.json.clone();
        fields.insert("bytes".into(), json!(self.len));
        fields.insert("warnings".into(), json!(warnings));
        fields.insert("notes".into(), json!(infos));
        fields.insert("diagnostics".into(), json!(diagnostics));
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

/// Prints the notes of several motions, each under its label. A note that several of them have is printed once.
pub(super) fn say_of_each<'a>(all: impl Iterator<Item = (&'a str, &'a [Note])>) {
    let mut sentences: Vec<(String, &str, usize)> = Vec::new();
    let mut places: HashMap<String, usize> = HashMap::new();
    let mut motions = 0;
    for (label, notes) in all {
        motions += 1;
        for note in notes {
            let sentence = words::line(note);
            // Each warning names its file, but for those about a body, whose file many lines name.
            let place = match note.is_warning() && note.kind != NoteKind::Retarget {
                true => sentences.len(),
                false => *places.entry(sentence.clone()).or_insert(sentences.len()),
            };
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
    let (mut prepared, read) = prepare(arguments)?;
    let before = prepared.notes.len();
    prepared.find_footsteps().with_context(|| arguments.input.display().to_string())?;
    arguments.say(&prepared.notes[before..]);
    arguments.check_outputs(&read)?;
    let coding = shared_coding(std::slice::from_ref(&prepared));
    let made = code(arguments, &prepared, &read, &coding, progress)?;
    arguments.say(&made.notes[prepared.notes.len()..]);
    // A clip opens with its own rig alone: a new one beside an old one would be lost.
    let rig = arguments.rig_out.as_deref().map(|path| (path, prepared.rig.as_slice()));
    let outputs: Vec<(&Path, &[u8])> = rig.into_iter().chain([(arguments.output(), made.bytes.as_slice())]).collect();
    output::write_together(&outputs)?;
    Ok(made)
}

/// Imports one file and applies the edits, but for footsteps: they depend on the direction that is up, on which several motions agree first.
/// Returns also every file that was read.
pub(super) fn prepare(arguments: &Arguments) -> Result<(Prepared, Vec<PathBuf>)> {
    let disk = memory::disk();
    let prepared = arguments.recipe().prepare(&disk, &arguments.input)?;
    let read = disk.read_so_far();
    read.iter().for_each(|path| detail!("read {}", path.display()));
    arguments.say(&prepared.notes);
    Ok((prepared, read))
}

/// The clip of a prepared motion in a coding.
pub(super) fn code(
    arguments: &Arguments,
    prepared: &Prepared,
    read: &[PathBuf],
    coding: &Coding,
    progress: Progress<'_>,
) -> Result<Made> {
    let made = prepared.code(coding, &mut |part| progress(part));
    let made = made.with_context(|| format!("{}: not written", arguments.output().display()))?;
    Ok(Made::new(made, &prepared.motion, read))
}
