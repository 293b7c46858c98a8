//! `pantin`: the host tool. One file a command in `cmd`; this file only dispatches.

use clap::{Parser, Subcommand};
use pantin_tools::{cmd, output};
use std::process::ExitCode;

/// What shells report of a program that a closed pipe ended, as in `pantin info walk.ptn | head -1`.
const READER_GONE: u8 = 141;

/// Character motion for small machines: converts motion files to clips and back, plays and draws them.
#[derive(Parser)]
#[command(name = "pantin", version, arg_required_else_help = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Convert(Box<cmd::convert::Arguments>),
    Expand(cmd::expand::Arguments),
    Face(cmd::face::Arguments),
    FlashImage(cmd::flash_image::Arguments),
    Info(cmd::info::Arguments),
    Play(cmd::play::Arguments),
    Render(Box<cmd::render::Arguments>),
    Serve(cmd::serve::Arguments),
    Stream(cmd::stream::Arguments),
    Train(cmd::train::Arguments),
    Update(cmd::update::Arguments),
}

fn main() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Convert(arguments) => cmd::convert::run(&arguments),
        Command::Expand(arguments) => cmd::expand::run(&arguments),
        Command::Face(arguments) => cmd::face::run(&arguments),
        Command::FlashImage(arguments) => cmd::flash_image::run(&arguments),
        Command::Info(arguments) => cmd::info::run(&arguments),
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
