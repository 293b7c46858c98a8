//! `pantin machine`

use super::bank::is_bank_name;
use crate::memory;
use crate::open::is_bank;
use crate::output::{self, Wanted, note, refuse_foreign};
use crate::play::session::Session;
use crate::play::settings::Settings;
use crate::play::steering;
use crate::play::terminal::Terminal;
use crate::words;
use anyhow::{Context, Result, bail, ensure};
use pantin::Bank;
use pantin_pictures::machine::{Compiled, Source, Text, Warning, compile, graph};
use serde_json::json;
use std::io::{IsTerminal, stdin, stdout};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Time between two looks at the files that are watched.
const LOOK: Duration = Duration::from_millis(200);

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
  pantin machine character.toml --watch                    plays it, and every change of the file

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
    /// Play the machine in the terminal, as `pantin play` does, and make it again whenever its file or its bank changes: the new one starts with the inputs that are held. An error is shown while the last one goes on
    #[arg(long)]
    watch: bool,
}

/// A machine that was made.
struct Built {
    compiled: Compiled,
    /// The picture of its states, as SVG.
    graph: String,
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
    if arguments.watch {
        ensure!(stdin().is_terminal() && stdout().is_terminal(), "--watch needs a terminal for its pictures and keys");
        output::take_stdout();
    }
    output::check(&[&arguments.input], &arguments.outputs())?;
    ensure!(!is_bank_name(&arguments.input), "{place}: a bank; the state machine is a .toml file, and --bank names the bank");
    let (built, bank) = arguments.build(&memory::read(&arguments.input)?)?;
    arguments.write(&built)?;
    let Compiled { bank: whole, warnings, clips, states, transitions, table_bytes } = built.compiled;
    for warning in &warnings {
        let location = warning.location.as_ref().map_or(place.clone(), ToString::to_string);
        note!("{location}: warning: {}", words::with_advice(&warning.text, warning.remedy));
    }
    let sentence = |warning: &Warning| words::with_advice(&warning.to_string(), warning.remedy);
    output::report(json!({
        "states": states,
        "transitions": transitions,
        "table_bytes": table_bytes,
        "bytes": whole.len(),
        "warnings": warnings.iter().map(sentence).collect::<Vec<String>>(),
    }));
    let count = format!("{states} states, {transitions} transitions, a table of {table_bytes} bytes");
    match &arguments.output {
        Some(output) => note!("{}: {count}; {} bytes with {clips} clips", output.display(), whole.len()),
        None if arguments.watch => {}
        None => note!("{place}: {count}; checked, and no bank written (-o writes it)"),
    }
    if arguments.watch { arguments.watch(whole, &bank) } else { Ok(()) }
}

impl Arguments {
    fn outputs(&self) -> Vec<&Path> {
        self.output.iter().chain(&self.graph).map(PathBuf::as_path).collect()
    }

    /// Makes the machine of a text, and returns it with the path of the bank whose clips it plays.
    fn build(&self, text: &[u8]) -> Result<(Built, PathBuf)> {
        let place = self.input.display().to_string();
        let file = Text::new(&place, text)?;
        let source = Source::parse(&file)?;
        let beside = |path: &PathBuf| self.input.parent().unwrap_or(Path::new("")).join(path);
        let path = self.bank.clone().or_else(|| source.bank.as_ref().map(beside));
        let path = path.with_context(|| {
            format!("{place}: no bank; write `bank = \"FILE.ptb\"` above the states, or give --bank FILE.ptb")
        })?;
        output::check(&[&path], &self.outputs())?;
        let bytes = memory::read(&path)?;
        if !is_bank(&bytes) {
            bail!("{}: not a bank; `pantin convert --same-form` and `pantin pack` make one", path.display());
        }
        Bank::new_checked(&bytes).with_context(|| path.display().to_string())?;
        let built = Built { compiled: compile(&source, &file, &bytes)?, graph: graph::svg(&source) };
        Ok((built, path))
    }

    /// Writes what is to be written.
    fn write(&self, built: &Built) -> Result<()> {
        let files = [(&self.output, built.compiled.bank.as_slice()), (&self.graph, built.graph.as_bytes())];
        let files: Vec<(&Path, &[u8])> = files.into_iter().filter_map(|(path, bytes)| Some((path.as_deref()?, bytes))).collect();
        output::write_together(&files)
    }

    /// Plays the machine, and each that changed files give.
    fn watch(&self, whole: Vec<u8>, bank: &Path) -> Result<()> {
        let settings = Settings::of_environment()?;
        let name = self.input.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let mut session = Session::new(Terminal::enter(settings.colours)?, settings, false, None);
        let changed = |path: &Path| std::fs::metadata(path).and_then(|data| data.modified()).ok();
        let mut bank = bank.to_owned();
        // A file that is not there is being written.
        let mut last = (std::fs::read(&self.input).ok(), changed(&bank));
        let mut looked = Instant::now();
        let mut remake = || {
            if looked.elapsed() < LOOK {
                return None;
            }
            looked = Instant::now();
            let now = (Some(std::fs::read(&self.input).ok()?), Some(changed(&bank)?));
            if now == last {
                return None;
            }
            last = now;
            let made = self.build(last.0.as_deref().unwrap_or_default()).and_then(|(built, path)| {
                self.write(&built)?;
                bank = path;
                last.1 = changed(&bank);
                Ok(built.compiled.bank)
            });
            Some(made)
        };
        steering::watch(whole, &name, &mut session, &mut remake)
    }
}
