//! `pantin convert A B C --same-form -o FOLDER`: clips of one rig which one figure renderer plays in turn.

use super::batch::regular;
use super::convert::{Arguments, Made, code, prepare};
use super::convert_bank::agree;
use crate::output::{self, Wanted, note, outln, refuse_foreign};
use anyhow::{Context, Result, bail, ensure};
use pantin_convert::{Prepared, of_one_rig, shared_coding};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Converts all motions in one coding and writes their clips into the folder `arguments.output`. Writes nothing if any of
/// them cannot be converted.
pub fn run(arguments: &Arguments) -> Result<()> {
    let folder = arguments.output();
    ensure!(!folder.is_file(), "{}: a file; --same-form needs a folder", folder.display());
    arguments.rig_out.iter().try_for_each(|path| refuse_foreign(path, Wanted::Rig))?;
    let tasks = tasks(arguments)?;
    let outputs: Vec<&Path> = arguments.rig_out.as_deref().into_iter().chain(tasks.iter().map(Arguments::output)).collect();
    let inputs: Vec<&Path> = tasks.iter().flat_map(Arguments::inputs).collect();
    if arguments.dry_run {
        let pairs = tasks.iter().map(|task| (task.input.display(), task.output().display()));
        pairs.into_iter().try_for_each(|(input, output)| outln!("{input} would become {output}"))?;
        note!("nothing was written");
        return Ok(());
    }
    output::make_folder(folder)?;
    tasks.iter().try_for_each(|task| regular(task.output()))?;
    output::check(&inputs, &outputs)?;
    let (mut prepared, read): (Vec<Prepared>, Vec<Vec<PathBuf>>) =
        tasks.iter().map(prepare).collect::<Result<Vec<_>>>()?.into_iter().unzip();
    let labels: Vec<String> = tasks.iter().map(|task| task.input.display().to_string()).collect();
    agree(&mut prepared, &labels, arguments.up_is_given())?;
    of_one_rig(&prepared, &labels, "--same-form needs one rig")?;
    let coding = shared_coding(&prepared);
    let bar = output::Pieces::new(tasks.len(), "clips")?;
    let code = |((task, prepared), read): ((&Arguments, &Prepared), &Vec<PathBuf>)| {
        let piece = bar.begin();
        code(task, prepared, read, &coding, &|part| piece.set(part))
    };
    let made = tasks.iter().zip(&prepared).zip(&read).map(code).collect::<Result<Vec<_>>>()?;
    bar.finish();
    let read: Vec<&Path> = read.iter().flatten().map(PathBuf::as_path).collect();
    output::check(&read, &outputs)?;
    let clips = tasks.iter().zip(&made).map(|(task, made)| (task.output(), made.bytes.as_slice()));
    let rig = arguments.rig_out.as_deref().map(|path| (path, prepared[0].rig.as_slice()));
    output::write_together(&rig.into_iter().chain(clips).collect::<Vec<_>>())?;
    if output::is_json() {
        let object = |(task, made): (&Arguments, &Made)| {
            let mut fields = made.fields();
            fields.insert("file".into(), task.input.display().to_string().into());
            Value::Object(fields)
        };
        output::report(json!({"clips": tasks.iter().zip(&made).map(object).collect::<Vec<_>>()}));
    }
    for (task, made) in tasks.iter().zip(&made) {
        made.sentence(task.output()).lines().for_each(|line| note!("{line}"));
    }
    let count = coding.exponential_joints();
    note!("{} clips of one form: length exponent {}, {count} joints as exponential maps", made.len(), coding.length_exponent());
    Ok(())
}

/// The arguments for each motion. Its clip has its name.
fn tasks(arguments: &Arguments) -> Result<Vec<Arguments>> {
    let mut named: HashMap<PathBuf, &Path> = HashMap::new();
    let mut tasks = Vec::new();
    for input in std::iter::once(&arguments.input).chain(&arguments.more) {
        ensure!(!input.is_dir(), "{}: a folder; --same-form needs motion files", input.display());
        let name = input.file_stem().with_context(|| format!("{}: no file name", input.display()))?;
        // Appended, because a name may have a dot of its own.
        let mut file = name.to_owned();
        file.push(".ptn");
        let output = arguments.output().join(file);
        if let Some(other) = named.insert(output.clone(), input) {
            bail!("{} and {}: both would be written to {}", other.display(), input.display(), output.display());
        }
        tasks.push(arguments.for_motion(input.clone(), output));
    }
    Ok(tasks)
}
