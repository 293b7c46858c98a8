//! `pantin convert FOLDER -o moves.ptb`: motions of one rig as one bank.

use super::bank::said;
use super::batch;
use super::convert::{Arguments, Made, code, prepare, say_of_each};
use super::convert_list::{self, ListEntry};
use crate::memory;
use crate::output::{self, Wanted, note, outln, refuse_foreign};
use crate::words;
use anyhow::{Context, Result, ensure};
use pantin_convert::bank::{self, Named};
use pantin_convert::import::list;
use pantin_convert::{Prepared, agree_on_up, of_one_rig, shared_coding};
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
        let prepared = prepare(&task.arguments);
        // The message names the motion.
        let prepared = match &task.line {
            Some(line) => prepared.with_context(|| line.clone())?,
            None => prepared?,
        };
        let motion = &prepared.0.motion;
        let values = motion.frames * (motion.rig.channels() + 1);
        memory::limit().check_numbers(held.fetch_add(values, Ordering::Relaxed) + values, "all motions of the bank together")?;
        Ok(prepared)
    };
    if arguments.dry_run {
        return dry_run(output, &tasks);
    }
    let bar = output::progress(tasks.len() as u64, "reading {wide_bar} {pos} of {len} motions {eta} left")?;
    let prepare = |task: &Task| prepare(task).inspect(|_| bar.inc(1));
    let prepared = pool.install(|| tasks.par_iter().with_max_len(1).map(prepare).collect::<Result<Vec<_>>>())?;
    let (mut prepared, read): (Vec<Prepared>, Vec<Vec<PathBuf>>) = prepared.into_iter().unzip();
    bar.finish_and_clear();
    let labels: Vec<String> = tasks.iter().map(|task| task.label.clone()).collect();
    agree(&mut prepared, &labels, arguments.up_is_given())?;
    of_one_rig(&prepared, &labels, "a bank holds clips of one rig")?;
    let shared = arguments.same_form.then(|| shared_coding(&prepared));
    let bar = output::Pieces::new(tasks.len(), "clips")?;
    let code = |((task, prepared), read): ((&Task, &Prepared), &Vec<PathBuf>)| {
        let own = || shared_coding(std::slice::from_ref(prepared));
        let piece = bar.begin();
        let coding = shared.clone().unwrap_or_else(own);
        code(&task.arguments, prepared, read, &coding, &|part| piece.set(part)).with_context(|| task.label.clone())
    };
    let made: Vec<Made> = pool.install(|| {
        let all = tasks.par_iter().with_max_len(1).zip(prepared.par_iter().with_max_len(1)).zip(read.par_iter().with_max_len(1));
        all.map(code).collect::<Result<Vec<_>>>()
    })?;
    bar.finish();
    output::check(&read.iter().flatten().map(PathBuf::as_path).collect::<Vec<_>>(), &[output])?;
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
    say_of_each(tasks.iter().zip(&made).map(|(task, made)| (task.label.as_str(), made.notes.as_slice())));
    let object = |(task, made): (&Task, &Made)| {
        let mut fields = made.fields();
        fields.insert("name".into(), task.name.as_str().into());
        fields.insert("file".into(), task.arguments.input.display().to_string().into());
        Value::Object(fields)
    };
    output::report(json!({"clips": tasks.iter().zip(&made).map(object).collect::<Vec<_>>()}));
    said(output, &bytes, &clips);
    Ok(())
}

/// Prints which motions would become clips of the bank.
fn dry_run(output: &Path, tasks: &[Task]) -> Result<()> {
    if !output::is_json() {
        tasks.iter().try_for_each(|task| outln!("{} would become {}", task.label, task.name))?;
    }
    let clips: Vec<Value> =
        tasks.iter().map(|task| json!({"file": task.arguments.input.display().to_string(), "name": task.name})).collect();
    output::report(json!({"would_write": [output.display().to_string()], "clips": clips}));
    note!("{}: would hold {} clips; nothing was written", output.display(), tasks.len());
    Ok(())
}

/// Lets all motions share the direction that is up, and finds footsteps in each, which depend on it.
pub fn agree(prepared: &mut [Prepared], labels: &[String], up_is_given: bool) -> Result<()> {
    if let Some(note) = agree_on_up(prepared, up_is_given)? {
        note!("{}", words::line(&note));
    }
    labels.iter().zip(prepared).try_for_each(|(label, prepared)| prepared.find_footsteps().with_context(|| label.clone()))
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
        let entries = list(&memory::disk(), input, &arguments.recipe().import)?;
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
        let of_line = |(place, line): (String, ListEntry)| {
            let name = line.name.clone().map_or_else(|| super::bank::name_of(&line.motion), Ok).with_context(|| place.clone())?;
            let label = format!("{place}: {}", line.motion.display());
            let mut task = task(line.motion.clone(), name, label);
            task.arguments.take_line(line).with_context(|| place.clone())?;
            task.line = Some(place);
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
