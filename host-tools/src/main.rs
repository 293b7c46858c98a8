//! `pantin`: the host tool. One file a command in `cmd`; this file only dispatches.

use anyhow::{Context, Result};
use clap::{CommandFactory, Parser, Subcommand};
use pantin_tools::{budget, cmd, output};
use std::path::Path;
use std::process::ExitCode;

/// What shells report of a program that a closed pipe ended, as in `pantin info walk.ptn | head -1`.
const READER_GONE: u8 = 141;

/// Character motion for small machines: converts motion files to clips and back, plays and draws them.
#[derive(Parser)]
#[command(name = "pantin", version, arg_required_else_help = true)]
#[command(
    after_help = "Exit codes: 0 done; 1 failed, with the reason on standard error; 2 the command line is wrong; 141 the reader of \
standard output went away.
`-` is standard input as an input, and standard output as an output."
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
    /// Refuse what takes more memory: a size such as 500MB or 4GB
    #[arg(long, global = true, value_name = "SIZE", default_value = "1GB", value_parser = budget::parse, help_heading = "Limits")]
    max_memory: u64,
    /// Refuse to write more than this to an output
    #[arg(long, global = true, value_name = "SIZE", default_value = "1GB", value_parser = budget::parse, help_heading = "Limits")]
    max_output: u64,
}

#[derive(Subcommand)]
enum Command {
    /// Print a completion script for a shell
    #[command(after_help = "Example:\n  pantin completions bash > ~/.local/share/bash-completion/completions/pantin")]
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    Convert(Box<cmd::convert::Arguments>),
    Expand(cmd::expand::Arguments),
    Face(cmd::face::Arguments),
    FlashImage(cmd::flash_image::Arguments),
    Info(cmd::info::Arguments),
    /// Print the manual page of pantin, or of one of its commands
    #[command(after_help = "Examples:\n  pantin man > pantin.1\n  pantin man convert | man -l -")]
    Man {
        /// The command
        command: Option<String>,
    },
    Play(cmd::play::Arguments),
    Render(Box<cmd::render::Arguments>),
    Serve(cmd::serve::Arguments),
    Stream(cmd::stream::Arguments),
    Train(cmd::train::Arguments),
    Update(cmd::update::Arguments),
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    budget::set(arguments.max_memory);
    output::set_most_bytes(arguments.max_output);
    let result = match arguments.command {
        Command::Completions { shell } => completions(shell),
        Command::Convert(arguments) => cmd::convert::run(&arguments),
        Command::Expand(arguments) => cmd::expand::run(&arguments),
        Command::Face(arguments) => cmd::face::run(&arguments),
        Command::FlashImage(arguments) => cmd::flash_image::run(&arguments),
        Command::Info(arguments) => cmd::info::run(&arguments),
        Command::Man { command } => manual(command.as_deref()),
        Command::Play(arguments) => cmd::play::run(&arguments),
        Command::Render(arguments) => cmd::render::run(&arguments),
        Command::Serve(arguments) => cmd::serve::run(&arguments),
        Command::Stream(arguments) => cmd::stream::run(&arguments),
        Command::Train(arguments) => cmd::train::run(&arguments),
        Command::Update(arguments) => cmd::update::run(&arguments),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(_) if output::reader_gone() => ExitCode::from(READER_GONE),
        Err(error) => {
            output::print_note(format_args!("pantin: {error:#}"));
            ExitCode::FAILURE
        }
    }
}

fn completions(shell: clap_complete::Shell) -> Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "pantin", &mut script);
    output::write_whole(Path::new("-"), &script)
}

fn manual(command: Option<&str>) -> Result<()> {
    let all = Arguments::command();
    let chosen = match command {
        Some(name) => {
            all.find_subcommand(name).with_context(|| format!("no command `{name}`; pantin --help lists them"))?.clone()
        }
        None => all,
    };
    let title = command.map_or_else(|| "pantin".into(), |name| format!("pantin-{name}"));
    let mut page = Vec::new();
    clap_mangen::Man::new(chosen).title(&title).render(&mut page)?;
    output::write_whole(Path::new("-"), &page)
}
