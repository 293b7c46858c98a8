//! `pantin face sheet`

use super::face_picture;
use crate::output::{check, write_whole};
use anyhow::Result;
use pantin_pictures::face::{Face, sheet};
use std::path::PathBuf;

/// Draw every unit and emotion of the face, labelled.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  pantin face sheet -o sheet.png")]
pub struct Arguments {
    /// The picture to write (PNG)
    #[arg(short, long)]
    output: PathBuf,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    face_picture(&arguments.output, "face sheet")?;
    check(&[], &[&arguments.output])?;
    let mut out = Vec::new();
    sheet::units(&mut out, &Face::new()?)?;
    write_whole(&arguments.output, &out)
}
