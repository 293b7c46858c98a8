//! `pantin face`: one file a sub-command.

mod compare;
mod export;
mod fit;
mod model;
mod sheet;
mod speak;

use anyhow::Result;

/// Work with Pantin's face: draw its units, compare interpolations, write its model, decompose poses and motions into units, let it speak.
#[derive(clap::Args)]
pub struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(clap::Subcommand)]
enum Command {
    Compare(compare::Arguments),
    Export(export::Arguments),
    Fit(fit::Arguments),
    Model(model::Arguments),
    Sheet(sheet::Arguments),
    Speak(speak::Arguments),
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    match &arguments.command {
        Command::Compare(arguments) => compare::run(arguments),
        Command::Export(arguments) => export::run(arguments),
        Command::Fit(arguments) => fit::run(arguments),
        Command::Model(arguments) => model::run(arguments),
        Command::Sheet(arguments) => sheet::run(arguments),
        Command::Speak(arguments) => speak::run(arguments),
    }
}

/// Refuses an output that is no PNG: `pantin face sheet` and `compare` write nothing else.
fn face_picture(output: &std::path::Path, command: &str) -> Result<()> {
    let png = output.extension().is_none_or(|extension| extension.eq_ignore_ascii_case("png"));
    anyhow::ensure!(png, "{}: `pantin {command}` writes a PNG; expected a name that ends in .png", output.display());
    Ok(())
}
