//! `pantin convert FOLDER -o moves.ptb`: motions of one rig as one bank.

use super::bank::said;
use super::batch;
use super::convert::{Arguments, Made, Prepared, prepare_without_footsteps, say_of_each, shared_coding};
use super::convert_list::{self, Line};
use crate::output::{self, Wanted, note, outln, refuse_foreign};
use anyhow::{Context, Result, bail, ensure};
use pantin_convert::budget;
use pantin_convert::encode::bank::{self, Named};
use pantin_convert::encode::same_rig::difference;
use pantin_convert::import::{self, list};
use rayon::prelude::*;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// One clip of the bank to be.
struct Task {
    name: String,
    label: String,
    /// The line of the list that names it.
    line: Option<String>,
    arguments: Arguments,
}

/// Converts all motions and writes the bank. Writes nothing if any of them cannot be converted.
pub fn run(arguments: &Arguments) -> Result<()> {
    let output = arguments.output();
    refuse_foreign(output, Wanted::Bank)?;
    ensure!(arguments.rig_out.is_none(), "--rig-out: a bank holds its rig");
    let tasks = tasks(arguments)?;
    let inputs: Vec<&Path> = tasks.iter().flat_map(|task| task.arguments.inputs()).collect();
    output::check(&inputs, &[output])?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.jobs.unwrap_or(0).into()).build()?;
    let held = AtomicUsize::new(0);
    let prepare = |task: &Task| {
        let prepared = prepare_without_footsteps(&task.arguments);
        // The message names the motion.
        let prepared = match &task.line {
            Some(line) => prepared.with_context(|| line.clone())?,
            None => prepared?,
        };
        let values = prepared.motion.frames * (prepared.motion.rig.channels() + 1);
        budget::check_numbers(held.fetch_add(values, Ordering::Relaxed) + values, "all motions of the bank together")?;
        Ok(prepared)
    };
    let bar = output::progress(tasks.len() as u64, "reading {wide_bar} {pos} of {len} motions {eta} left")?;
    let prepare = |task: &Task| prepare(task).inspect(|_| bar.inc(1));
    let mut prepared: Vec<Prepared> =
        pool.install(|| tasks.par_iter().with_max_len(1).map(prepare).collect::<Result<Vec<_>>>())?;
    bar.finish_and_clear();
    agree_on_up(&mut prepared, arguments.up_is_given())?;
    tasks.iter().zip(&mut prepared).try_for_each(|(task, prepared)| prepared.find_footsteps(&task.arguments))?;
    let labels: Vec<String> = tasks.iter().map(|task| task.label.clone()).collect();
    of_one_rig(&prepared, &labels, "a bank holds clips of one rig")?;
    let shared = arguments.same_form.then(|| shared_coding(&prepared, arguments));
    let bar = output::Pieces::new(tasks.len(), "clips")?;
    let code = |(task, prepared): (&Task, &Prepared)| {
        let own = || shared_coding(std::slice::from_ref(prepared), arguments);
        let piece = bar.begin();
        let coding = shared.clone().unwrap_or_else(own);
        prepared.code(&task.arguments, &coding, &|part| piece.set(part)).with_context(|| task.label.clone())
    };
    let made: Vec<Made> = pool.install(|| {
        tasks.par_iter().with_max_len(1).zip(prepared.par_iter().with_max_len(1)).map(code).collect::<Result<Vec<_>>>()
    })?;
    bar.finish();
    let read: Vec<PathBuf> = prepared.iter().flat_map(|prepared| prepared.read.clone()).collect();
    output::check(&read.iter().map(PathBuf::as_path).collect::<Vec<_>>(), &[output])?;
    // Equal bytes, or `encode` refuses them.
    let mut rigs: Vec<Arc<[u8]>> = Vec::new();
    for prepared in &prepared {
        let same = rigs.last().filter(|last| last[..] == prepared.rig[..]).map(Arc::clone);
        rigs.push(same.unwrap_or_else(|| Arc::from(prepared.rig.as_slice())));
    }
    let named = |((task, made), rig): ((&Task, &Made), &Arc<[u8]>)| Named {
        name: task.name.clone(),
        place: task.label.clone(),
        clip: made.bytes.clone(),
        rig: Arc::clone(rig),
    };
    let clips: Vec<Named> = tasks.iter().zip(&made).zip(&rigs).map(named).collect();
    let bytes = bank::encode(&clips)?;
    output::write_together(&[(output, &bytes)])?;
    if !output::is_json() && !output::is_quiet() {
        for (task, made) in tasks.iter().zip(&made) {
            outln!("{}: {} frames, {} bytes, {}", task.name, made.frames, made.bytes.len(), made.cell)?;
        }
    }
    for (task, made) in tasks.iter().zip(&made) {
        made.warnings.iter().for_each(|warning| note!("{}: warning: {warning}", task.label));
    }
    say_of_each(tasks.iter().zip(&made).map(|(task, made)| (task.label.as_str(), made.notes.as_slice())));
    let object = |(task, made): (&Task, &Made)| {
        let mut fields = made.fields();
        fields.insert("name".into(), task.name.as_str().into());
        fields.insert("file".into(), task.arguments.input.display().to_string().into());
        fields.insert("notes".into(), json!(made.notes));
        Value::Object(fields)
    };
    output::report(json!({"clips": tasks.iter().zip(&made).map(object).collect::<Vec<_>>()}));
    said(output, &bytes, &clips);
    Ok(())
}

/// A guess of which way is up may fail for a motion on the floor: those of one figure share that of most of them.
pub fn agree_on_up(prepared: &mut [Prepared], given: bool) -> Result<()> {
    let count = |up| prepared.iter().filter(|prepared| prepared.motion.rig.up == up).count();
    let most = prepared.iter().map(|prepared| prepared.motion.rig.up).max_by_key(|&up| (count(up), std::cmp::Reverse(up.byte())));
    let Some(most) = most.filter(|&up| !given && count(up) < prepared.len()) else { return Ok(()) };
    let others = prepared.len() - count(most);
    note!("up: {others} of {} motions look as if another axis were up; all take {}", prepared.len(), import::up::text(most));
    for prepared in prepared {
        prepared.set_up(most)?;
    }
    Ok(())
}

/// Refuses motions of different rigs; `why` says what needs one.
pub fn of_one_rig(prepared: &[Prepared], labels: &[String], why: &str) -> Result<()> {
    for (label, other) in labels.iter().zip(prepared).skip(1) {
        if let Some(difference) = difference(&prepared[0].motion.rig, &other.motion.rig).with_context(|| label.clone())? {
            bail!("{label}: another rig than {}: {difference}; {why}", labels[0]);
        }
    }
    Ok(())
}

/// The clips: of a folder's motions, of several files, or of a file's animations.
fn tasks(arguments: &Arguments) -> Result<Vec<Task>> {
    let task = |input: PathBuf, name: String, label: String| {
        let arguments = arguments.for_file(input, arguments.output().to_path_buf());
        Task { name, label, line: None, arguments }
    };
    let input = &arguments.input;
    if arguments.animation.as_deref() == Some("all") {
        ensure!(arguments.more.is_empty() && !input.is_dir(), "--animation all takes one file");
        let entries = list::list(input, arguments.fps())?;
        let tasks = batch::chosen_animations(input, &entries)?.into_iter().map(|(number, name)| {
            let name = if name.is_empty() { number.clone() } else { name };
            let label = format!("{}: animation {name}", input.display());
            let mut task = task(input.clone(), name, label);
            task.arguments.animation = Some(number);
            task
        });
        return Ok(tasks.collect());
    }
    if convert_list::is_list(input) {
        ensure!(arguments.more.is_empty(), "{}: a list; convert a list in a command of its own", input.display());
        ensure!(
            !arguments.edits.any() && arguments.animation.is_none(),
            "{}: the lines of a list say how each motion is cut and changed; leave those options out of the command",
            input.display()
        );
        let of_line = |(place, line): (String, Line)| {
            let name = line.name.map_or_else(|| super::bank::name_of(&line.motion), Ok).with_context(|| place.clone())?;
            let label = format!("{place}: {}", line.motion.display());
            let mut task = task(line.motion, name, label);
            (task.arguments.edits, task.arguments.animation, task.line) = (line.edits, line.animation, Some(place));
            Ok(task)
        };
        return convert_list::read(input)?.into_iter().map(of_line).collect();
    }
    let (base, inputs) = if input.is_dir() {
        ensure!(arguments.more.is_empty(), "{}: a folder; convert a folder in a command of its own", input.display());
        (Some(input), batch::motions(input)?)
    } else {
        (None, std::iter::once(input).chain(&arguments.more).cloned().collect())
    };
    let named = |path: PathBuf| {
        let label = path.display().to_string();
        let name = match base {
            // Folders below are part of a name.
            Some(base) => path.strip_prefix(base).unwrap_or(&path).with_extension("").to_string_lossy().replace('\\', "/"),
            None => super::bank::name_of(&path)?,
        };
        Ok(task(path, name, label))
    };
    inputs.into_iter().map(named).collect()
}
