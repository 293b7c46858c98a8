//! `pantin expand`.

use super::{Files, write_whole};
use crate::expand::expand;
use crate::export;
use anyhow::{Context, Result, bail};
use std::path::PathBuf;

/// Turn a clip back into per-frame motion: the same joints, channels and frames.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin expand walk.ptn -o walk.bvh
  pantin expand walk.ptn --rig figure.rig -o walk.bvh")]
pub struct Arguments {
    /// The clip
    input: PathBuf,
    /// The motion file to write: .bvh
    #[arg(short, long)]
    output: PathBuf,
    /// The rig of a clip that was made with --rig-out
    #[arg(long)]
    rig: Option<PathBuf>,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    let files = Files::read(&arguments.input, arguments.rig.as_deref())?;
    let clip = files.open().with_context(|| arguments.input.display().to_string())?;
    let motion = expand(&clip)?;
    match arguments.output.extension().and_then(|extension| extension.to_str()) {
        Some("bvh") => {
            let mut out = Vec::new();
            export::bvh::write(&motion, &mut out)?;
            write_whole(&arguments.output, &out)
        }
        _ => bail!("{}: expected a name that ends in .bvh", arguments.output.display()),
    }
}
