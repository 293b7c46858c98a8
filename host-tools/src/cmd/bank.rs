//! `pantin pack`, `pantin unpack` and `pantin list`: many clips of one rig in one file.

use crate::budget;
use crate::encode::bank::{self, Named};
use crate::input;
use crate::output::{self, Wanted, clean, note, outln, refuse_foreign};
use anyhow::{Context, Result, ensure};
use pantin::Bank;
use serde_json::json;
use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

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
}

/// List the clips of a bank: names, frames, rates and bytes.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  pantin list moves.ptb")]
pub struct List {
    /// The bank
    input: PathBuf,
}

/// Whether the file is a bank by its content.
pub fn is_bank(bytes: &[u8]) -> bool {
    bytes.starts_with(&pantin::codec::layout::BANK_MAGIC)
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
    let apart = arguments.rig.as_deref().map(input::read).transpose()?;
    let mut clips = Vec::new();
    let mut needed = false;
    for path in &arguments.inputs {
        let place = path.display().to_string();
        let bytes = input::read(path)?;
        // With its own rig, or the one given.
        let opened = pantin::Clip::with_rig(&bytes, apart.as_deref().unwrap_or(&[]));
        opened.with_context(|| match &apart {
            None => format!("{place} (--rig FILE names the rig of a clip without one)"),
            Some(_) => place.clone(),
        })?;
        let own = bank::rig_of(&bytes)?;
        needed |= own.is_empty();
        let rig = if own.is_empty() { apart.clone().unwrap_or_default() } else { own };
        clips.push(Named { name: name_of(path)?, place, clip: bytes, rig });
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
    output::report(json!({"clips_in_bank": count, "bytes": len, "rig_bytes": rig}));
    note!("{}: {count} clips, {len} bytes, of which {rig} are the rig", path.display());
}

/// The name of a clip in a bank.
pub fn name_of(path: &Path) -> Result<String> {
    let name = path.file_stem().filter(|_| path.as_os_str() != "-").map(|name| name.to_string_lossy().into_owned());
    name.with_context(|| format!("{}: no file name, so the clip has no name in the bank", path.display()))
}

/// Runs `pantin unpack`.
pub fn unpack(arguments: &Unpack) -> Result<()> {
    let place = || arguments.input.display().to_string();
    let bytes = input::read(&arguments.input)?;
    let bank = open(&arguments.input, &bytes)?;
    ensure!(!arguments.output.is_file(), "{}: a file; the clips need a folder", arguments.output.display());
    for name in &arguments.clips {
        ensure!(bank.find(name).is_some(), "{}: no clip `{name}`; `pantin list` prints the names", place());
    }
    let chosen =
        |entry: &pantin::BankEntry| arguments.clips.is_empty() || arguments.clips.iter().any(|name| name == entry.name());
    // Each file has the rig again.
    let bytes_of = |entry: &pantin::BankEntry| entry.bytes().len() as u64 + bank.rig_bytes().len() as u64;
    let all: u64 = bank.entries().filter(chosen).map(|entry| bytes_of(&entry)).sum();
    output::check_size(&arguments.output, all)?;
    budget::check_bytes_held(all).with_context(place)?;
    let mut files: Vec<(PathBuf, Vec<u8>)> = Vec::new();
    let mut lower = HashSet::new();
    for (number, entry) in bank.entries().enumerate().filter(|(_, entry)| chosen(entry)) {
        let context = || format!("{}: clip {}", place(), clean(entry.name()));
        bank.open(&entry).with_context(context)?;
        let clip = bank::with_rig(entry.bytes(), bank.rig_bytes()).with_context(context)?;
        let file = arguments.output.join(super::batch::file_name(None, entry.name(), &number.to_string()));
        super::batch::regular(&file)?;
        let new = lower.insert(file.to_string_lossy().to_lowercase());
        ensure!(new, "{}: another clip is written to {} too", context(), file.display());
        files.push((file, clip));
    }
    fs::create_dir_all(&arguments.output).with_context(|| arguments.output.display().to_string())?;
    let outputs: Vec<(&Path, &[u8])> = files.iter().map(|(path, clip)| (path.as_path(), clip.as_slice())).collect();
    output::check(&[&arguments.input], &outputs.iter().map(|(path, _)| *path).collect::<Vec<_>>())?;
    output::write_together(&outputs)?;
    let written: Vec<_> = files.iter().map(|(path, _)| path.display().to_string()).collect();
    output::report(json!({"written": written}));
    note!("{}: {} clips written to {}", place(), files.len(), arguments.output.display());
    Ok(())
}

fn open<'a>(path: &Path, bytes: &'a [u8]) -> Result<Bank<'a>> {
    let place = || path.display().to_string();
    ensure!(is_bank(bytes), "{}: not a bank; `pantin pack` makes one", place());
    Bank::new_checked(bytes).with_context(place)
}

/// Runs `pantin list`.
pub fn list(arguments: &List) -> Result<()> {
    let bytes = input::read(&arguments.input)?;
    print(&arguments.input, &bytes)
}

/// Lists the clips of a bank.
pub fn print(path: &Path, bytes: &[u8]) -> Result<()> {
    let bank = open(path, bytes)?;
    let mut rows = Vec::new();
    for entry in bank.entries() {
        let clip = bank.open(&entry).with_context(|| format!("{}: clip {}", path.display(), clean(entry.name())))?;
        rows.push((entry, clip));
    }
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
        output::report(json!({"clips": clips, "rig_bytes": bank.rig_bytes().len(), "file_bytes": bytes.len()}));
        return Ok(());
    }
    let wide = rows.iter().map(|(entry, _)| clean(entry.name()).chars().count()).max().unwrap_or(0).max(4);
    outln!("{:wide$} {:>7} {:>7} {:>9} {:>7} {:>9}", "clip", "frames", "fps", "seconds", "events", "bytes")?;
    for (entry, clip) in &rows {
        let looped = if clip.looped() { "  loop" } else { "" };
        let (name, frames, events, len) = (clean(entry.name()), clip.frames(), clip.event_count(), entry.bytes().len());
        outln!("{name:wide$} {frames:7} {:7} {:9.3} {events:7} {len:9}{looped}", fps(clip), seconds(clip))?;
    }
    outln!("{} clips, {} bytes, of which {} are the rig", rows.len(), bytes.len(), bank.rig_bytes().len())?;
    Ok(())
}
