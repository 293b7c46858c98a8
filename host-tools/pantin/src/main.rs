//! `pantin`: the host tool. One file a command in `cmd`; this file only dispatches.

use anyhow::{Context, Error, Result};
use clap::{CommandFactory, Parser, Subcommand};
use pantin_convert::{Memory, parse_size};
use pantin_tools::{cmd, memory, output};
use serde_json::json;
use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

/// What shells report of a program that a closed pipe ended, as in `pantin info walk.ptn | head -1`.
const READER_GONE: u8 = 141;
/// The command line is wrong.
const WRONG_USE: u8 = 2;

/// Character motion for small machines: converts motion files to clips and back, plays and draws them.
#[derive(Parser)]
#[command(name = "pantin", version, arg_required_else_help = true)]
#[command(
    after_help = "Exit codes: 0 done; 1 failed, with the reason on standard error; 2 the command line is wrong; 141 the reader of \
standard output went away.
`-` is standard input as an input, and standard output as an output.
With --json, standard output is one JSON object; where standard output is itself the output, the object goes to standard error. A
command that fails prints the reason there too, as `error`."
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
    /// Print only results and errors: no notes, warnings or progress
    #[arg(short, long, global = true, conflicts_with = "verbose", help_heading = "Messages")]
    quiet: bool,
    /// Print details too: files read and written with their sizes, and the time taken
    #[arg(short, long, global = true, help_heading = "Messages")]
    verbose: bool,
    /// Print what the command reports as one JSON object, errors included
    #[arg(long, global = true, help_heading = "Messages")]
    json: bool,
    /// Refuse what takes more memory: a size such as 500MB or 4GB
    #[arg(long, global = true, value_name = "SIZE", default_value = "1GB", value_parser = parse_size, help_heading = "Limits")]
    max_memory: u64,
    /// Refuse to write more than this to an output
    #[arg(long, global = true, value_name = "SIZE", default_value = "1GB", value_parser = parse_size, help_heading = "Limits")]
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
    List(cmd::bank::List),
    Machine(cmd::machine::Arguments),
    /// Print the manual page of pantin, or of one of its commands
    #[command(after_help = "Examples:\n  pantin man > pantin.1\n  pantin man convert | man -l -")]
    Man {
        /// The command
        command: Option<String>,
    },
    Pack(cmd::bank::Pack),
    Play(cmd::play::Arguments),
    Render(Box<cmd::render::Arguments>),
    Serve(cmd::serve::Arguments),
    Steer(cmd::steer::Arguments),
    Stream(cmd::stream::Arguments),
    Unpack(cmd::bank::Unpack),
    Update(cmd::update::Arguments),
}

impl Command {
    /// As it is called on the command line.
    fn name(&self) -> &'static str {
        match self {
            Command::Completions { .. } => "completions",
            Command::Convert(_) => "convert",
            Command::Expand(_) => "expand",
            Command::Face(_) => "face",
            Command::FlashImage(_) => "flash-image",
            Command::Info(_) => "info",
            Command::List(_) => "list",
            Command::Machine(_) => "machine",
            Command::Man { .. } => "man",
            Command::Pack(_) => "pack",
            Command::Play(_) => "play",
            Command::Render(_) => "render",
            Command::Serve(_) => "serve",
            Command::Steer(_) => "steer",
            Command::Stream(_) => "stream",
            Command::Unpack(_) => "unpack",
            Command::Update(_) => "update",
        }
    }
}

fn main() -> ExitCode {
    let begun = Instant::now();
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return not_understood(&error),
    };
    memory::set_limit(Memory::new(arguments.max_memory));
    output::set_most_bytes(arguments.max_output);
    output::set_reporting(arguments.quiet, arguments.verbose, arguments.json);
    let name = arguments.command.name();
    let result = match arguments.command {
        Command::Completions { shell } => completions(shell),
        Command::Convert(arguments) => cmd::convert::run(&arguments),
        Command::Expand(arguments) => cmd::expand::run(&arguments),
        Command::Face(arguments) => cmd::face::run(&arguments),
        Command::FlashImage(arguments) => cmd::flash_image::run(&arguments),
        Command::Info(arguments) => cmd::info::run(&arguments),
        Command::List(arguments) => cmd::bank::list(&arguments),
        Command::Machine(arguments) => cmd::machine::run(&arguments),
        Command::Man { command } => manual(command.as_deref()),
        Command::Pack(arguments) => cmd::bank::pack(&arguments),
        Command::Play(arguments) => cmd::play::run(&arguments),
        Command::Render(arguments) => cmd::render::run(&arguments),
        Command::Serve(arguments) => cmd::serve::run(&arguments),
        Command::Steer(arguments) => cmd::steer::run(&arguments),
        Command::Stream(arguments) => cmd::stream::run(&arguments),
        Command::Unpack(arguments) => cmd::bank::unpack(&arguments),
        Command::Update(arguments) => cmd::update::run(&arguments),
    };
    output::remove_empty_folders();
    match result.and_then(|()| output::finish(name)) {
        Ok(()) => {
            output::print_detail(format_args!("{name}: {:.2} s", begun.elapsed().as_secs_f64()));
            ExitCode::SUCCESS
        }
        Err(_) if output::reader_gone() => ExitCode::from(READER_GONE),
        Err(error) => {
            output::fail(name, &error);
            ExitCode::FAILURE
        }
    }
}

/// Prints help and the version, and what is wrong with a command line as every other error.
fn not_understood(error: &clap::Error) -> ExitCode {
    if !error.use_stderr() {
        return match error.print().and_then(|()| io::stdout().flush()) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => ExitCode::from(READER_GONE),
            Err(error) => {
                output::fail("", &Error::new(error).context("standard output"));
                ExitCode::FAILURE
            }
        };
    }
    let text = with_clean_arguments(error.to_string());
    if std::env::args_os().any(|argument| argument == "--json") {
        output::set_reporting(false, false, true);
        let reason = text.split("\n\nUsage:").next().unwrap_or_default();
        let reason = reason.strip_prefix("error: ").unwrap_or(reason).split_whitespace().collect::<Vec<_>>().join(" ");
        output::fail("", &Error::msg(reason));
    } else {
        match text.strip_prefix("error: ") {
            Some(text) => output::print_error_text(text.trim_end()),
            // A command without arguments gets its help.
            None => drop(error.print()),
        }
    }
    ExitCode::from(WRONG_USE)
}

/// The same text with the line breaks of arguments as escapes. Its own ones stay.
fn with_clean_arguments(text: String) -> String {
    let arguments: Vec<String> = std::env::args_os().map(|argument| argument.to_string_lossy().into_owned()).collect();
    // A message quotes an argument, or its value, or one of its values.
    let mut parts: Vec<&str> = arguments.iter().map(String::as_str).collect();
    parts.extend(arguments.iter().filter_map(|argument| argument.split_once('=')).map(|(_, value)| value));
    parts.extend(arguments.iter().flat_map(|argument| argument.split(['=', ','])));
    parts.retain(|part| part.contains(['\n', '\r']));
    parts.iter().fold(text, |text, part| text.replace(part, &output::clean(part)))
}

fn completions(shell: clap_complete::Shell) -> Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "pantin", &mut script);
    print_text("script", script)
}

fn manual(command: Option<&str>) -> Result<()> {
    let mut all = Arguments::command();
    // Options of all commands become part of each.
    all.build();
    let chosen = match command {
        Some(name) => {
            all.find_subcommand(name).with_context(|| format!("no command `{name}`; pantin --help lists them"))?.clone()
        }
        None => all,
    };
    let title = command.map_or_else(|| "pantin".into(), |name| format!("pantin-{name}"));
    let mut page = Vec::new();
    clap_mangen::Man::new(chosen).title(&title).render(&mut page)?;
    print_text("page", page)
}

/// Writes a text to standard output, or as a field of the report.
fn print_text(name: &str, text: Vec<u8>) -> Result<()> {
    if output::is_json() {
        output::report(json!({ name: String::from_utf8(text)? }));
        return Ok(());
    }
    output::write_whole(Path::new("-"), &text)
}
