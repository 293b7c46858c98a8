//! `pantin face export`

use crate::face::{Face, export, pose};
use crate::output::{check, write_whole};
use anyhow::{Result, bail};
use std::path::PathBuf;

/// Write the face's mesh: .glb with one morph target per unit, or .obj.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin face export -o face.glb
  pantin face export -o joy.obj --pose joy=0.7,wink_left")]
pub struct Arguments {
    /// The file to write: .glb or .obj
    #[arg(short, long)]
    output: PathBuf,
    /// Units and their weights instead of the neutral pose
    #[arg(long, default_value = "", value_name = "UNIT=WEIGHT,...")]
    pose: String,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    check(&[], &[&arguments.output])?;
    let face = Face::new()?;
    let pairs = pose::parse(&face.blueprint, &arguments.pose)?;
    let bytes = match arguments.output.extension().and_then(|extension| extension.to_str()) {
        Some("glb") => export::glb(&face, &pairs)?,
        Some("obj") => export::obj(&face, &pairs)?.into_bytes(),
        _ => bail!("{}: expected a name that ends in .glb or .obj", arguments.output.display()),
    };
    write_whole(&arguments.output, &bytes)
}
