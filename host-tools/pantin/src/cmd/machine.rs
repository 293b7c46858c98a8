//! `pantin machine`

use super::bank::is_bank_name;
use crate::memory;
use crate::open::is_bank;
use crate::output::{self, Wanted, note, refuse_foreign};
use crate::words;
use anyhow::{Context, Result, anyhow, bail, ensure};
use pantin::Bank;
use pantin_animator::machine::{FEET_SECTION, SECTION};
use pantin_convert::bank;
use pantin_pictures::machine::{Source, Text, graph, make};
use serde_json::json;
use std::path::{Path, PathBuf};

/// Put a state machine into a bank: states that play its clips, and transitions by inputs, events, parameters and ends of clips.
///
/// The file is TOML (see firmware/animator/MACHINE.md). Firmware plays the machine with the crate pantin-animator.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin convert idle.bvh walk.bvh run.bvh jump.bvh --same-form --footsteps -o moves.ptb
  pantin machine character.toml -o character.ptb
  pantin machine character.toml --bank moves.ptb -o character.ptb --graph character.svg
  pantin machine character.toml                            only checks
  pantin machine character.toml --graph character.svg      checks and draws

A small machine:
  bank = \"moves.ptb\"

  [[state]]
  name = \"idle\"
  transitions = [{ to = \"walk\", input = \"go\" }]

  [[state]]
  name = \"walk\"
  transitions = [{ to = \"idle\", released = \"go\", seconds = 0.4 }]")]
pub struct Arguments {
    /// The state machine: a .toml file
    input: PathBuf,
    /// The bank to write, with the state machine in it: .ptb. Without it the file is only checked
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// The bank with the clips, instead of the one that the file names
    #[arg(long)]
    bank: Option<PathBuf>,
    /// Draw states and transitions: an .svg file
    #[arg(long, value_name = "FILE")]
    graph: Option<PathBuf>,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    let place = arguments.input.display().to_string();
    if let Some(output) = &arguments.output {
        refuse_foreign(output, Wanted::Bank)?;
    }
    if let Some(graph) = &arguments.graph {
        refuse_foreign(graph, Wanted::Picture)?;
        let svg = graph.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("svg"));
        ensure!(svg || graph.as_os_str() == "-", "{}: the graph is written as .svg", graph.display());
    }
    let outputs: Vec<&Path> = arguments.output.iter().chain(&arguments.graph).map(PathBuf::as_path).collect();
    output::check(&[&arguments.input], &outputs)?;
    ensure!(!is_bank_name(&arguments.input), "{place}: a bank; the state machine is a .toml file, and --bank names the bank");
    let text = memory::read(&arguments.input)?;
    let text = String::from_utf8(text).map_err(|_| anyhow!("{place}: not text (UTF-8)"))?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let file = Text { name: &place, text };
    let source = Source::parse(&file)?;
    let beside = |path: &PathBuf| arguments.input.parent().unwrap_or(Path::new("")).join(path);
    let path = arguments.bank.clone().or_else(|| source.bank.as_ref().map(beside));
    let path =
        path.with_context(|| format!("{place}: no bank; write `bank = \"FILE.ptb\"` above the states, or give --bank FILE.ptb"))?;
    output::check(&[&path], &outputs)?;
    let bytes = memory::read(&path)?;
    if !is_bank(&bytes) {
        bail!("{}: not a bank; `pantin convert --same-form` and `pantin pack` make one", path.display());
    }
    let bank = Bank::new_checked(&bytes).with_context(|| path.display().to_string())?;
    let made = make(&source, &file, &bank)?;
    let feet = made.feet.as_deref();
    let whole = bank::without_section(&bytes, FEET_SECTION)?;
    let whole = bank::with_section(&whole, SECTION, &made.table)?;
    let whole = feet.map_or(Ok(whole.clone()), |feet| bank::with_section(&whole, FEET_SECTION, feet))?;
    let picture = graph::svg(&source);
    let files = [(&arguments.output, whole.as_slice()), (&arguments.graph, picture.as_bytes())];
    let files: Vec<(&Path, &[u8])> = files.into_iter().filter_map(|(path, bytes)| Some((path.as_deref()?, bytes))).collect();
    output::write_together(&files)?;
    let warnings: Vec<String> = made.warnings.iter().map(|warning| words::with_advice(&warning.text, warning.remedy)).collect();
    warnings.iter().for_each(|warning| note!("{place}: warning: {warning}"));
    let transitions = source.any.len() + source.states.iter().map(|state| state.transitions.len()).sum::<usize>();
    output::report(json!({
        "states": source.states.len(),
        "transitions": transitions,
        "table_bytes": made.table.len(),
        "bytes": whole.len(),
        "warnings": warnings,
    }));
    let count = format!("{} states, {transitions} transitions, a table of {} bytes", source.states.len(), made.table.len());
    match &arguments.output {
        Some(output) => note!("{}: {count}; {} bytes with {} clips", output.display(), whole.len(), bank.len()),
        None => note!("{place}: {count}; checked, and no bank written (-o writes it)"),
    }
    Ok(())
}
