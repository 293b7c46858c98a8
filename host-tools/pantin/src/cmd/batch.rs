//! `pantin convert FOLDER -o FOLDER`: every motion in and below a folder.
//!
//! A clip that is up to date carries its source's modification time in seconds, and in the microseconds beside them a fingerprint of
//! the source, the options and this program. So nothing but clips is written, and whatever loses the time (an edit, a copy) converts again.

use super::convert::{Arguments, Made, Progress, convert, say_of_each};
use super::is_free;
use crate::memory;
use crate::output::{self, note, outln};
use crate::words;
use anyhow::{Context, Result, bail, ensure};
use pantin_convert::import;
use rayon::prelude::*;
use serde_json::{Map, Value, json};
use std::collections::{BTreeSet, HashMap};
use std::ffi::{OsStr, OsString};
use std::fs::{self, File};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// Letters of an animation's name that its clip's file keeps.
const LONGEST_NAME: usize = 60;

/// A file's outcome.
enum Outcome {
    Converted { made: Box<Made>, seconds: f64 },
    UpToDate,
    Refused(String),
}

/// Converts the folder `arguments.input` into the folder `arguments.output`. Fails if a file did.
pub fn run(arguments: &Arguments) -> Result<()> {
    let (from, to) = (&arguments.input, arguments.output());
    ensure!(arguments.output.is_some(), "{}: a folder; --output names the folder for its clips", from.display());
    ensure!(arguments.rig_out.is_none(), "--rig-out names one file, so it goes with one motion");
    ensure!(!to.is_file(), "{}: a file; a folder's clips need a folder", to.display());
    let found = Found::below(from, to)?;
    let tasks = with_options_that_apply(arguments, tasks(arguments, &found.motions)?)?;
    let label = |task: &Arguments| task.input.strip_prefix(from).unwrap_or(&task.input).display().to_string();
    let labels: Vec<String> = tasks.iter().map(label).collect();
    convert_all(arguments, tasks, labels, Some(found.others))
}

/// Converts several files, each to a clip of its name: in the folder `--output`, or beside it.
pub fn run_several(arguments: &Arguments) -> Result<()> {
    let folder = arguments.output.as_deref();
    ensure!(arguments.rig_out.is_none(), "--rig-out names one file, so it goes with one motion");
    folder.map_or(Ok(()), names_folder)?;
    let mut tasks = Vec::new();
    for input in std::iter::once(&arguments.input).chain(&arguments.more) {
        ensure!(!input.is_dir(), "{}: a folder; convert a folder in a command of its own", input.display());
        let clip = input.with_extension("ptn");
        let name = clip.file_name().filter(|_| input.as_os_str() != "-");
        let name = name.with_context(|| format!("{}: no file name for the clip", input.display()))?;
        let output = folder.map_or_else(|| clip.clone(), |folder| folder.join(name));
        tasks.push(arguments.for_file(input.clone(), output));
    }
    one_clip_each(&tasks, |task| task.input.display().to_string())?;
    let tasks = with_options_that_apply(arguments, tasks)?;
    let labels: Vec<String> = tasks.iter().map(|task| task.input.display().to_string()).collect();
    convert_all(arguments, tasks, labels, None)
}

/// Converts every animation of a file, each to a clip of its name.
pub fn run_animations(arguments: &Arguments) -> Result<()> {
    let input = &arguments.input;
    ensure!(input.as_os_str() != "-", "--animation all reads its input several times, so it needs a file");
    ensure!(arguments.rig_out.is_none(), "--rig-out names one file, so it goes with one animation");
    let own = input.with_extension("ptn");
    let output = arguments.output.as_deref().unwrap_or(&own);
    // `-o walk.ptn` gives walk-NAME.ptn; everything else is a folder.
    let prefix = match output.extension().is_some_and(|extension| extension == "ptn") && !output.is_dir() {
        true => Some(output.file_stem().unwrap_or_default().to_os_string()),
        false => {
            names_folder(output)?;
            None
        }
    };
    let format = import::format(&memory::disk(), input)?;
    ensure!(format.has_animations, "{}: --animation all: the file holds one motion", input.display());
    let (mut tasks, mut names) = (Vec::new(), Vec::new());
    let entries = import::list(&memory::disk(), input, &arguments.recipe().import)?;
    for (number, name) in chosen_animations(input, &entries)? {
        let file = file_name(prefix.as_deref(), &name, &number);
        let output = if prefix.is_some() { output.with_file_name(file) } else { output.join(file) };
        let mut task = arguments.for_file(input.clone(), output);
        names.push(animation_label(&number, &name));
        task.animation = Some(number);
        tasks.push(task);
    }
    one_clip_each(&tasks, |task| format!("animation {}", task.animation.as_deref().unwrap_or_default()))?;
    convert_all(arguments, tasks, names, None)
}

/// `PREFIX-NAME.ptn`, or `NAME.ptn` in a folder. What a file system or a shell would read as more than a letter becomes `_`; an
/// animation without a name has its number.
pub(super) fn file_name(prefix: Option<&OsStr>, name: &str, number: &str) -> OsString {
    let safe = |c: char| if c.is_alphanumeric() || "-_+=() .".contains(c) { c } else { '_' };
    let mut clean: String = name.chars().map(safe).take(LONGEST_NAME).collect::<String>().trim_matches([' ', '.', '-']).into();
    if clean.is_empty() {
        clean = number.into();
    }
    let device = ["con", "prn", "aux", "nul"].contains(&clean.to_lowercase().as_str())
        || ["com", "lpt"].iter().any(|port| clean.to_lowercase().strip_prefix(port).is_some_and(|rest| rest.len() == 1));
    if device {
        clean.push('_');
    }
    let mut file = OsString::new();
    if let Some(prefix) = prefix {
        file.push(prefix);
        file.push("-");
    }
    file.push(clean + ".ptn");
    file
}

/// Fails unless several clips can go into `output`.
fn names_folder(output: &Path) -> Result<()> {
    let clip = output.extension().is_some_and(|extension| extension == "ptn") && !output.is_dir();
    ensure!(!clip && !output.is_file() && output.as_os_str() != "-", "{}: a file; several clips need a folder", output.display());
    Ok(())
}

/// Leaves `--animation` and `--skeleton` to the motions that they apply to. Fails if there is none: then the option is a mistake.
fn with_options_that_apply(arguments: &Arguments, mut tasks: Vec<Arguments>) -> Result<Vec<Arguments>> {
    let given = [arguments.animation.is_some(), arguments.skeleton.is_some()];
    if given == [false; 2] {
        return Ok(tasks);
    }
    let mut used = [false; 2];
    for task in &mut tasks {
        // A pipe is read once, by the conversion, which refuses what does not apply; so is what has no known format.
        let format = if task.input.is_file() { import::format(&memory::disk(), &task.input).ok() } else { None };
        let takes = format.map_or([true; 2], |format| [format.has_animations, format.has_skeleton]);
        task.animation.take_if(|_| !takes[0]);
        task.skeleton.take_if(|_| !takes[1]);
        used.iter_mut().zip(takes).for_each(|(used, takes)| *used |= takes);
    }
    ensure!(used[0] || !given[0], "--animation: none of these files holds several motions");
    ensure!(used[1] || !given[1], "--skeleton: none of these files is an .amc");
    Ok(tasks)
}

/// Refuses tasks that would write one clip, before anything is written.
fn one_clip_each(tasks: &[Arguments], label: impl Fn(&Arguments) -> String) -> Result<()> {
    let mut named: HashMap<String, &Arguments> = HashMap::new();
    for task in tasks {
        // Some file systems ignore the case of letters.
        if let Some(other) = named.insert(task.output().to_string_lossy().to_lowercase(), task) {
            let output = task.output().display();
            bail!(
                "{} and {}: both would be written to {output}; convert one of them in a command of its own",
                label(other),
                label(task)
            );
        }
    }
    Ok(())
}

/// Refuses an output of many that is there and is no regular file: a pipe would wait for a reader.
pub(super) fn regular(output: &Path) -> Result<()> {
    let regular = output.metadata().map_or(true, |found| found.is_file());
    ensure!(regular, "{}: no regular file; move it away, or choose another folder", output.display());
    Ok(())
}

fn animation_label(number: &str, name: &str) -> String {
    if name.is_empty() { number.into() } else { format!("{number} ({name})") }
}

/// The animations of a file that move something, by number and name. Fails if a name is another one's number, which would choose it.
pub(super) fn chosen_animations(input: &Path, entries: &[import::animations::Entry]) -> Result<Vec<(String, String)>> {
    let mut chosen = Vec::new();
    for (number, entry) in entries.iter().enumerate() {
        let (number, name) = (number.to_string(), entry.name.clone().unwrap_or_default());
        if entry.frames == 0 {
            let label = animation_label(&number, &name);
            note!("{}: warning: animation {label} moves nothing that a clip holds: left out", input.display());
            continue;
        }
        let ambiguous = entries.iter().any(|other| other.name.as_ref() == Some(&number));
        ensure!(!ambiguous, "{}: an animation has the name `{number}`, which is another one's number", input.display());
        chosen.push((number, name));
    }
    ensure!(!chosen.is_empty(), "{}: no animation, so nothing moves", input.display());
    Ok(chosen)
}

/// Refuses outputs that are one of the sources by a link, or that are no regular files.
fn sources_stay(tasks: &[Arguments]) -> Result<()> {
    let mut sources = HashMap::new();
    for task in tasks {
        sources.insert(output::file_id(&task.input), task.input.clone());
        sources.extend(import::companions(&memory::disk(), &task.input).into_iter().map(|path| (output::file_id(&path), path)));
    }
    sources.remove(&None);
    for task in tasks {
        let output = task.output();
        regular(output)?;
        if let Some(source) = sources.get(&output::file_id(output)) {
            bail!("{}: is the input {} itself; choose another folder for the clips", output.display(), source.display());
        }
    }
    Ok(())
}

/// Converts all `tasks`, or those of the shard that is asked for, and reports a line for each under its label. Fails if one did.
fn convert_all(arguments: &Arguments, tasks: Vec<Arguments>, labels: Vec<String>, others: Option<usize>) -> Result<()> {
    // Of all, for other shards write at the same time.
    different_files(&tasks)?;
    sources_stay(&tasks)?;
    let (tasks, labels) = match arguments.shard {
        Some(shard) => (shard.of(tasks), shard.of(labels)),
        None => (tasks, labels),
    };
    let (tasks, labels) = (tasks.as_slice(), labels.as_slice());
    if arguments.dry_run {
        return dry_run(tasks, labels);
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.jobs.unwrap_or(0).into()).build()?;
    let bar = output::Pieces::new(tasks.len(), "files")?;
    let convert = |task: &Arguments| {
        let piece = bar.begin();
        outcome(task, &|part| piece.set(part))
    };
    // One at a time from the list, so that a long file does not hold back those behind it.
    let outcomes: Vec<Outcome> = pool.install(|| tasks.par_iter().with_max_len(1).map(convert).collect());
    bar.finish();
    let refused = outcomes.iter().filter(|outcome| matches!(outcome, Outcome::Refused(_))).count();
    if output::is_json() {
        let files: Vec<_> = tasks.iter().zip(&outcomes).map(|(task, outcome)| outcome.json(task)).collect();
        output::report(json!({"files": files}));
    } else if !output::is_quiet() {
        table(labels, &outcomes).iter().try_for_each(|line| outln!("{line}"))?;
    }
    for (file, outcome) in labels.iter().zip(&outcomes) {
        // The table and the JSON name them; without either, somebody must.
        if let Outcome::Refused(why) = outcome
            && output::is_quiet()
            && !output::is_json()
        {
            output::print_error(format_args!("{file}: {why}"));
        }
    }
    say_of_each(labels.iter().zip(&outcomes).filter_map(|(file, outcome)| match outcome {
        Outcome::Converted { made, .. } => Some((file.as_str(), made.notes.as_slice())),
        _ => None,
    }));
    let fresh = outcomes.iter().filter(|outcome| matches!(outcome, Outcome::UpToDate)).count();
    let done = outcomes.len() - refused - fresh;
    let others = others.map_or_else(String::new, |others| format!(", {others} other files passed over"));
    note!("{done} converted, {fresh} up to date, {refused} refused{others}");
    ensure!(refused == 0, "{refused} of {} files could not be converted", outcomes.len());
    Ok(())
}

/// Prints which clips would be written.
fn dry_run(tasks: &[Arguments], labels: &[String]) -> Result<()> {
    let mut files = Vec::new();
    for (task, label) in tasks.iter().zip(labels) {
        let (fresh, output) = (is_up_to_date(task, stamp(task)?.0), task.output().display().to_string());
        if !output::is_json() {
            let what = if fresh { "is up to date".into() } else { format!("would become {output}") };
            outln!("{label} {what}")?;
        }
        files.push(json!({"file": task.input.display().to_string(), "output": output, "up_to_date": fresh}));
    }
    output::report(json!({"files": files}));
    note!("nothing was written");
    Ok(())
}

/// Whether a task's clip is there, whole, and made of these sources by these options.
fn is_up_to_date(task: &Arguments, stamp: SystemTime) -> bool {
    fs::metadata(task.output()).and_then(|clip| clip.modified()).is_ok_and(|time| time == stamp) && is_whole(task.output())
}

/// The motion files in and below a folder, in the order of names.
pub(super) fn motions(folder: &Path) -> Result<Vec<PathBuf>> {
    Ok(Found::below(folder, Path::new(""))?.motions)
}

/// What a folder holds.
#[derive(Default)]
struct Found {
    motions: Vec<PathBuf>,
    others: usize,
}

impl Found {
    /// What is in and below `folder`, but for the folder `to` that is written. Fails if that is no motion.
    fn below(folder: &Path, to: &Path) -> Result<Found> {
        let mut found = Found::default();
        found.look(folder, to)?;
        ensure!(!found.motions.is_empty(), "{}: no motion files in it; {} others", folder.display(), found.others);
        Ok(found)
    }

    /// Looks in `folder` and below it, in the order of names; not in `skip`, where the clips go, nor behind links to folders.
    fn look(&mut self, folder: &Path, skip: &Path) -> Result<()> {
        let entries = fs::read_dir(folder).with_context(|| folder.display().to_string())?;
        let mut paths: Vec<PathBuf> = entries.map(|entry| Ok(entry?.path())).collect::<Result<_>>()?;
        paths.sort();
        for path in paths {
            let link = path.is_symlink();
            if path.is_dir() {
                if !link && path.canonicalize().ok() != skip.canonicalize().ok() {
                    self.look(&path, skip)?;
                }
            } else if path.is_file() && import::is_motion(&path) {
                self.motions.push(path);
            } else {
                self.others += 1;
            }
        }
        Ok(())
    }
}

/// The arguments for each file. Clips are called as their sources; where that gives several files one name, each of them keeps its
/// whole name in front of `.ptn`.
fn tasks(arguments: &Arguments, motions: &[PathBuf]) -> Result<Vec<Arguments>> {
    let below = |path: &'_ PathBuf| path.strip_prefix(&arguments.input).unwrap_or(path).to_path_buf();
    let mut whole = vec![false; motions.len()];
    let clip = |path: &PathBuf, whole: bool| match whole {
        true => {
            let mut name = below(path).into_os_string();
            name.push(".ptn");
            arguments.output().join(name)
        }
        false => arguments.output().join(below(path).with_extension("ptn")),
    };
    // Ends, for whole names are as different as the sources'.
    let clips = loop {
        let clips: Vec<PathBuf> = motions.iter().zip(&whole).map(|(path, &whole)| clip(path, whole)).collect();
        let shared = shared(&clips);
        if shared.iter().zip(&whole).all(|(&shared, &whole)| !shared || whole) {
            break clips;
        }
        whole.iter_mut().zip(shared).for_each(|(whole, shared)| *whole |= shared);
    };
    Ok(motions.iter().zip(clips).map(|(path, clip)| arguments.for_file(path.clone(), clip)).collect())
}

/// Whether another has the same name, on systems where `A.ptn` and `a.ptn` are one file by them.
fn shared(clips: &[PathBuf]) -> Vec<bool> {
    let key = |path: &PathBuf| match cfg!(any(windows, target_os = "macos")) {
        true => PathBuf::from(path.to_string_lossy().to_lowercase()),
        false => path.clone(),
    };
    let mut names: HashMap<PathBuf, usize> = HashMap::new();
    clips.iter().for_each(|path| *names.entry(key(path)).or_default() += 1);
    clips.iter().map(|path| names[&key(path)] > 1).collect()
}

/// Refuses links that lead two clips to one file.
fn different_files(tasks: &[Arguments]) -> Result<()> {
    let clips = || tasks.iter().map(Arguments::output);
    let mut files: HashMap<PathBuf, &Path> = HashMap::new();
    for clip in clips() {
        if let (true, Ok(file)) = (clip.is_symlink(), clip.canonicalize()) {
            let other = files.insert(file, clip);
            ensure!(other.is_none(), "{} and {}: both outputs are one file", other.unwrap_or(clip).display(), clip.display());
        }
    }
    for clip in clips().filter(|clip| !clip.is_symlink()) {
        let other = clip.canonicalize().ok().and_then(|file| files.get(&file).copied());
        ensure!(other.is_none(), "{} and {}: both outputs are one file", other.unwrap_or(clip).display(), clip.display());
    }
    Ok(())
}

fn outcome(task: &Arguments, progress: Progress<'_>) -> Outcome {
    let begun = std::time::Instant::now();
    let convert = || -> Result<Outcome> {
        let (stamp, taken) = stamp(task)?;
        if is_up_to_date(task, stamp) {
            return Ok(Outcome::UpToDate);
        }
        let output = task.output().display();
        ensure!(
            !task.keeps_existing || is_free(task.output()),
            "{output}: exists; --output FOLDER replaces clips in that folder"
        );
        if let Some(folder) = task.output().parent() {
            output::make_folder(folder)?;
        }
        let made = convert(task, progress)?;
        // A file that the fingerprint does not cover may change unseen: then the clip is made again each time.
        if made.read.iter().all(|path| taken.contains(path)) {
            File::options().write(true).open(task.output())?.set_modified(stamp).context("cannot set the clip's time")?;
        }
        Ok(Outcome::Converted { made: Box::new(made.without_bytes()), seconds: begun.elapsed().as_secs_f64() })
    };
    match catch_unwind(AssertUnwindSafe(convert)) {
        Ok(Ok(outcome)) => outcome,
        Ok(Err(error)) => Outcome::Refused(words::explanation(&error).replace('\n', " ")),
        Err(_) => Outcome::Refused("a fault of this program stopped the conversion; please report it".into()),
    }
}

/// Whether the clip opens, its checksum included.
fn is_whole(path: &Path) -> bool {
    memory::read(path).is_ok_and(|bytes| pantin::Clip::new_checked(&bytes).is_ok())
}

/// The time that a clip carries if it was made of these sources, by these options and this program; and the sources.
fn stamp(task: &Arguments) -> Result<(SystemTime, BTreeSet<PathBuf>)> {
    let mut hasher = DefaultHasher::new();
    let mut take = |path: &Path| -> Result<Duration> {
        let file = fs::metadata(path).with_context(|| path.display().to_string())?;
        let time = file.modified()?.duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
        (path.file_name(), file.len(), time).hash(&mut hasher);
        Ok(time)
    };
    take(&std::env::current_exe()?)?;
    let time = take(&task.input)?;
    let inputs = task.inputs();
    let companions = inputs.iter().flat_map(|path| import::companions(&memory::disk(), path));
    let sources: BTreeSet<PathBuf> = inputs.iter().map(|path| path.to_path_buf()).chain(companions).collect();
    for path in &sources {
        // One that is missing fails the conversion, if it is needed.
        let _ = take(path);
    }
    format!("{task:?}").hash(&mut hasher);
    let micros = hasher.finish() % 1_000_000;
    match SystemTime::UNIX_EPOCH.checked_add(Duration::from_secs(time.as_secs()) + Duration::from_micros(micros)) {
        Some(stamp) => Ok((stamp, sources)),
        None => bail!("{}: its modification time is out of range", task.input.display()),
    }
}

impl Outcome {
    fn json(&self, task: &Arguments) -> Value {
        let mut object = self.fields();
        object.insert("file".into(), task.input.display().to_string().into());
        object.insert("output".into(), task.output().display().to_string().into());
        if let Some(animation) = &task.animation {
            object.insert("animation".into(), animation.as_str().into());
        }
        object.into()
    }

    fn fields(&self) -> Map<String, Value> {
        let fields = match self {
            Outcome::Converted { made, seconds } => {
                let mut fields = made.fields();
                fields.insert("error".into(), made.cell.as_str().into());
                fields.insert("seconds".into(), json!(seconds));
                fields.into()
            }
            Outcome::UpToDate => json!({"up_to_date": true}),
            Outcome::Refused(why) => json!({"refused": why}),
        };
        if let Value::Object(fields) = fields { fields } else { Map::new() }
    }
}

/// A line a file.
fn table(names: &[String], outcomes: &[Outcome]) -> Vec<String> {
    let wide = names.iter().map(|name| name.chars().count()).max().unwrap_or(0).max(4);
    let mut out = vec![format!("{:wide$} {:>7} {:>9}  {:26} {:>7}", "file", "frames", "bytes", "greatest error", "s")];
    for (name, outcome) in names.iter().zip(outcomes) {
        out.push(match outcome {
            Outcome::Converted { made, seconds } => {
                format!("{name:wide$} {:7} {:9}  {:26} {seconds:7.1}", made.frames, made.len, made.cell)
            }
            Outcome::UpToDate => format!("{name:wide$} up to date"),
            Outcome::Refused(why) => format!("{name:wide$} REFUSED: {why}"),
        });
    }
    out
}
