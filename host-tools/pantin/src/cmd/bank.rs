//! `pantin pack`, `pantin unpack` and `pantin list`: many clips of one rig in one file.

use super::info::memory_fields;
use crate::memory;
use crate::open::is_bank;
use crate::output::{self, Staged, Wanted, clean, note, outln, refuse_foreign};
use crate::words;
use anyhow::{Context, Result, bail, ensure};
use pantin::{Bank, BankEntry};
use pantin_animator::machine::{Machine, Table};
use pantin_convert::bank::{self, CheckedRig, Named};
use pantin_convert::facts::MemoryNeeds;
use pantin_pictures::machine::playback::has_machine;
use serde_json::json;
use std::collections::HashMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Put clips of one rig into one file, a bank, from which a program opens them by name.
///
/// A clip's name in the bank is its file's name without .ptn. The rig is stored once.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin pack walk.ptn run.ptn jump.ptn -o moves.ptb
  pantin pack clips/*.ptn -o moves.ptb
  pantin pack walk.ptn run.ptn --rig figure.rig -o moves.ptb
  pantin convert captures -o moves.ptb --same-form     converts and packs in one step

Clips of one bank can differ in form; those that `pantin convert --same-form` made share one figure renderer.")]
pub struct Pack {
    /// The clips
    #[arg(required = true)]
    inputs: Vec<PathBuf>,
    /// The bank to write
    #[arg(short, long)]
    output: PathBuf,
    /// The rig of clips that were made with --rig-out
    #[arg(long)]
    rig: Option<PathBuf>,
}

/// Write the clips of a bank as files, each with its rig.
///
/// Each clip goes into NAME.ptn. Characters that are no part of a file's name everywhere become _, and the command prints which names change.
/// The names come from the bank, so a file that exists is replaced only with --replace; without it, nothing is written.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin unpack moves.ptb -o clips
  pantin unpack moves.ptb -o clips --clip walk --clip run")]
pub struct Unpack {
    /// The bank
    input: PathBuf,
    /// The folder for the clips, which is made if it is missing
    #[arg(short, long)]
    output: PathBuf,
    /// Only the clip of this name. May be given several times
    #[arg(long = "clip", value_name = "NAME")]
    clips: Vec<String>,
    /// Replace files that exist in the folder
    #[arg(long)]
    replace: bool,
}

/// List the clips of a bank: names, frames, rates and bytes.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  pantin list moves.ptb")]
pub struct List {
    /// The bank
    input: PathBuf,
}

/// Whether an output is to be a bank, by its name.
pub fn is_bank_name(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("ptb"))
}

/// Runs `pantin pack`.
pub fn pack(arguments: &Pack) -> Result<()> {
    refuse_foreign(&arguments.output, Wanted::Bank)?;
    let inputs: Vec<&Path> = arguments.inputs.iter().chain(&arguments.rig).map(PathBuf::as_path).collect();
    output::check(&inputs, &[&arguments.output])?;
    let apart = arguments.rig.as_deref().map(memory::read).transpose()?;
    let mut clips: Vec<Named> = Vec::new();
    let (mut needed, mut held) = (false, 0);
    for path in &arguments.inputs {
        let place = path.display().to_string();
        let bytes = memory::read(path)?;
        ensure!(!is_bank(&bytes), "{place}: a bank already; `pantin unpack {place} -o FOLDER` writes its clips as files");
        // With its own rig, or the one given.
        let opened = pantin::Clip::with_rig(&bytes, apart.as_deref().unwrap_or(&[]));
        opened.with_context(|| match &apart {
            None => format!("{place} (--rig FILE names the rig of a clip without one)"),
            Some(_) => place.clone(),
        })?;
        let own = bank::rig_of(&bytes)?;
        needed |= own.is_empty();
        let rig = if own.is_empty() { apart.as_deref().unwrap_or_default() } else { &own };
        // Clips of one figure share its bytes.
        let rig = clips.last().map(|clip| &clip.rig).filter(|last| last[..] == *rig).map_or_else(|| Arc::from(rig), Arc::clone);
        let clip = bank::without_rig(&bytes, &CheckedRig::new(&rig)?).with_context(|| place.clone())?;
        held += clip.len() as u64;
        memory::limit().check_bytes_held(held)?;
        clips.push(Named { name: name_of(path)?, place, clip, rig });
    }
    ensure!(needed || apart.is_none(), "--rig has no effect: every clip has its own");
    let bytes = bank::encode(&clips)?;
    output::write_together(&[(&arguments.output, &bytes)])?;
    said(&arguments.output, &bytes, &clips);
    Ok(())
}

/// Reports a bank that was written.
pub fn said(path: &Path, bytes: &[u8], clips: &[Named]) {
    let rig = clips.first().map_or(0, |clip| clip.rig.len());
    let (count, len) = (clips.len(), bytes.len());
    let mut files: HashMap<String, &str> = HashMap::new();
    for (number, Named { name, .. }) in clips.iter().enumerate() {
        let file = file_name(name, number);
        if let Some(other) = files.insert(file.to_lowercase(), name) {
            note!(
                "warning: the clips `{other}` and `{name}` would both be unpacked to {file}: `pantin unpack --clip` writes one of them"
            );
        }
    }
    let travel = Bank::new_checked(bytes).ok().and_then(|bank| bank::travel(&bank, memory::limit()).ok().flatten());
    if let Some(note) = travel {
        note!("{}: {}", path.display(), words::line(&note));
    }
    output::report(json!({"clips_in_bank": count, "bytes": len, "rig_bytes": rig}));
    note!("{}: {count} clips, {len} bytes, of which {rig} are the rig", path.display());
}

/// The name of a clip in a bank.
pub fn name_of(path: &Path) -> Result<String> {
    let stem = path.file_stem().filter(|_| path.as_os_str() != "-");
    let stem = stem.with_context(|| format!("{}: no file name, so the clip has no name in the bank", path.display()))?;
    let name = stem.to_string_lossy().into_owned();
    if stem.to_str().is_none() {
        note!("warning: {}: its name is not UTF-8; the bank has the clip as `{name}`", path.display());
    }
    Ok(name)
}

/// A clip's name as it is shown.
fn shown<'a>(entry: &BankEntry<'a>) -> &'a str {
    if entry.name().is_empty() { "(a name that is not UTF-8)" } else { entry.name() }
}

/// The file into which a clip is unpacked.
fn file_name(name: &str, number: usize) -> String {
    super::batch::file_name(None, name, &number.to_string()).to_string_lossy().into_owned()
}

/// The clips to unpack and their files. Fails for two clips that have one file.
fn files<'a>(arguments: &Unpack, bank: &Bank<'a>) -> Result<Vec<(BankEntry<'a>, PathBuf)>> {
    let place = || arguments.input.display().to_string();
    for name in &arguments.clips {
        ensure!(bank.find(name).is_some(), "{}: no clip `{name}`; `pantin list` prints the names", place());
    }
    let chosen = |entry: &BankEntry| arguments.clips.is_empty() || arguments.clips.iter().any(|name| name == entry.name());
    let mut files = Vec::new();
    let mut lower: HashMap<String, &str> = HashMap::new();
    for (number, entry) in bank.entries().enumerate().filter(|(_, entry)| chosen(entry)) {
        let name = file_name(entry.name(), number);
        // Some file systems ignore the case of letters.
        if let Some(other) = lower.insert(name.to_lowercase(), shown(&entry)) {
            bail!(
                "{}: the clips `{other}` and `{}` would both be written to {name}; --clip writes one of them, into a folder of its own",
                place(),
                shown(&entry)
            );
        }
        files.push((entry, arguments.output.join(name)));
    }
    Ok(files)
}

/// Runs `pantin unpack`.
pub fn unpack(arguments: &Unpack) -> Result<()> {
    let (place, folder) = (|| arguments.input.display().to_string(), &arguments.output);
    ensure!(folder.as_os_str() != "-", "-o -: a bank has several clips, and standard output takes one; name a folder");
    let bytes = memory::read(&arguments.input)?;
    let bank = open(&arguments.input, &bytes)?;
    ensure!(!folder.is_file(), "{}: a file; the clips need a folder", folder.display());
    let files = files(arguments, &bank)?;
    // Each file has the rig again.
    let all: u64 = files.iter().map(|(entry, _)| entry.bytes().len() as u64 + bank.rig_bytes().len() as u64).sum();
    output::check_size(folder, all)?;
    let context = |entry: &BankEntry| format!("{}: clip {}", place(), shown(entry));
    for (entry, file) in &files {
        bank.open(entry).with_context(|| context(entry))?;
        super::batch::regular(file)?;
        ensure!(
            arguments.replace || super::is_free(file),
            "{}: exists; --replace replaces it, another folder keeps it",
            file.display()
        );
    }
    output::make_folder(folder)?;
    output::check(&[&arguments.input], &files.iter().map(|(_, path)| path.as_path()).collect::<Vec<_>>())?;
    let (rig, mut staged) = (CheckedRig::of(&bank), Vec::with_capacity(files.len()));
    let bar = output::progress(files.len() as u64, "{wide_bar} {pos} of {len} clips {eta} left")?;
    for (entry, path) in &files {
        let clip = bank::with_rig(entry.bytes(), &rig).with_context(|| context(entry))?;
        let mut file = Staged::create(path)?;
        file.write_all(&clip)?;
        file.close()?;
        staged.push(file);
        bar.inc(1);
    }
    output::commit(staged)?;
    bar.finish_and_clear();
    for (entry, path) in &files {
        let name = path.file_name().unwrap_or_default();
        if name != &*format!("{}.ptn", entry.name()) {
            note!("the clip `{}` has another name as a file: {}", shown(entry), name.display());
        }
    }
    let written: Vec<_> = files.iter().map(|(_, path)| path.display().to_string()).collect();
    let machine = has_machine(&bytes);
    if machine {
        note!("warning: {}: the bank's state machine stays in it: clips hold none", place());
    }
    output::report(json!({"written": written, "state_machine_left": machine}));
    note!("{}: {} clips written to {}", place(), files.len(), folder.display());
    Ok(())
}

fn open<'a>(path: &Path, bytes: &'a [u8]) -> Result<Bank<'a>> {
    let place = || path.display().to_string();
    ensure!(is_bank(bytes), "{}: not a bank; `pantin pack` makes one", place());
    Bank::new_checked(bytes).with_context(place)
}

/// Runs `pantin list`.
pub fn list(arguments: &List) -> Result<()> {
    let bytes = memory::read(&arguments.input)?;
    print(&arguments.input, &bytes)
}

/// Lists the clips of a bank.
pub fn print(path: &Path, bytes: &[u8]) -> Result<()> {
    let bank = open(path, bytes)?;
    let mut rows = Vec::new();
    for entry in bank.entries() {
        let clip = bank.open(&entry).with_context(|| format!("{}: clip {}", path.display(), shown(&entry)))?;
        rows.push((entry, clip));
    }
    let memory = MemoryNeeds::of_bank(&bank).with_context(|| path.display().to_string())?;
    let fps = |clip: &pantin::Clip| (1e11 / f64::from(clip.frame_time_ns())).round() / 100.0;
    let seconds = |clip: &pantin::Clip| (clip.duration_ns() as f64 / 1e6).round() / 1000.0;
    if output::is_json() {
        let object = |(entry, clip): &(pantin::BankEntry, pantin::Clip)| {
            json!({
                "name": entry.name(),
                "frames": clip.frames(),
                "fps": fps(clip),
                "seconds": seconds(clip),
                "looped": clip.looped(),
                "events": clip.event_count(),
                "bytes": entry.bytes().len(),
            })
        };
        let clips: Vec<_> = rows.iter().map(object).collect();
        let mut object = json!({"clips": clips, "rig_bytes": bank.rig_bytes().len(), "file_bytes": bytes.len()});
        for (name, value) in memory_fields(&memory) {
            object[name] = value;
        }
        if let Some(table) = machine(path, bytes)? {
            object["machine"] = facts_of(&table, &rows);
        }
        output::report(object);
        return Ok(());
    }
    let wide = rows.iter().map(|(entry, _)| clean(shown(entry)).chars().count()).max().unwrap_or(0).max(4);
    outln!("{:wide$} {:>7} {:>7} {:>9} {:>7} {:>9}", "clip", "frames", "fps", "seconds", "events", "bytes")?;
    for (entry, clip) in &rows {
        let looped = if clip.looped() { "  loop" } else { "" };
        let (name, frames, events, len) = (clean(shown(entry)), clip.frames(), clip.event_count(), entry.bytes().len());
        outln!("{name:wide$} {frames:7} {:7} {:9.3} {events:7} {len:9}{looped}", fps(clip), seconds(clip))?;
    }
    outln!("{} clips, {} bytes, of which {} are the rig", rows.len(), bytes.len(), bank.rig_bytes().len())?;
    let most: Vec<String> =
        memory_fields(&memory).iter().map(|(name, value)| format!("{} {value}", name.replace('_', " "))).collect();
    outln!("the most that a clip needs: {}", most.join(", "))?;
    if let Some(table) = machine(path, bytes)? {
        let facts = facts_of(&table, &rows);
        let words = |list: &serde_json::Value| {
            let names = list.as_array().map_or(&[][..], Vec::as_slice).iter();
            names.filter_map(|name| name.as_str().or(name["name"].as_str()).map(clean)).collect::<Vec<_>>().join(", ")
        };
        outln!("")?;
        outln!("state machine")?;
        let list = ["states", "inputs", "parameters", "layers", "events"].map(|field| (field, words(&facts[field])));
        for (field, words) in list.into_iter().filter(|(_, words)| !words.is_empty()) {
            outln!("  {field:11} {words}")?;
        }
        outln!("  {:11} {}", "starts in", clean(table.state_name(Machine::new(table).state())))?;
    }
    Ok(())
}

/// The table of a bank's state machine, if it has one; a damaged one is an error.
fn machine<'a>(path: &Path, bytes: &'a [u8]) -> Result<Option<Table<'a>>> {
    if !has_machine(bytes) {
        return Ok(None);
    }
    Ok(Some(Table::of_bank(bytes).with_context(|| path.display().to_string())?))
}

/// What a state machine has: names of its states and their clips, inputs, parameters, layers, and the events of its clips.
fn facts_of(table: &Table<'_>, rows: &[(pantin::BankEntry<'_>, pantin::Clip<'_>)]) -> serde_json::Value {
    let clip = |index: u8| rows.get(usize::from(index)).map_or("", |(entry, _)| entry.name());
    let states = (0..table.states() as u8).filter_map(|state| Some((state, table.state(state)?)));
    let mut events: Vec<String> = Vec::new();
    for (_, row) in states.clone() {
        let own = rows.get(usize::from(row.clip)).map_or(Vec::new(), |(_, clip)| pantin_convert::events::of_clip(clip));
        events.extend(own.into_iter().map(|event| event.name).filter(|name| !name.is_empty()));
    }
    events.sort();
    events.dedup();
    let parameter = |index: u8| {
        let [least, most, first] = table.range(index);
        json!({"name": table.parameter_name(index), "range": [least, most], "first": first})
    };
    let layers = (0..table.layers()).filter_map(|layer| table.layer(layer));
    json!({
        "states": states.map(|(state, row)| json!({"name": table.state_name(state), "clip": clip(row.clip)})).collect::<Vec<_>>(),
        "inputs": (0..table.inputs() as u8).map(|input| table.input_name(input)).collect::<Vec<_>>(),
        "parameters": (0..table.parameters() as u8).map(parameter).collect::<Vec<_>>(),
        "layers": layers.map(|row| json!({"name": clip(row.clip), "input": table.input_name(row.input)})).collect::<Vec<_>>(),
        "events": events,
    })
}
