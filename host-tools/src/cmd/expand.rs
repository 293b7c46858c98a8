//! `pantin expand`.

use super::Files;
use crate::expand::{Expanded, expand};
use crate::export::{self, bvh::Columns};
use crate::motion::Frames;
use crate::output::{self, Staged, Wanted, refuse_foreign};
use anyhow::{Context, Result, bail};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Turn a clip back into per-frame motion, or into source text for firmware.
///
/// The output's extension selects the format: .bvh has the same joints and frames, and three rotations a joint; .glb is a
/// tree of nodes, with scalars as morph weights; .csv has one row per frame with the time in seconds and
/// all channels' values; .h and .rs hold the clip's bytes, their length, the frame rate and the channels' names.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin expand walk.ptn -o walk.bvh
  pantin expand walk.ptn --rig figure.rig -o walk.bvh
  pantin expand walk.ptn -o walk.glb
  pantin expand face.ptn -o face.csv
  pantin expand walk.ptn -o walk.h
  pantin expand walk.ptn -o src/walk.rs")]
pub struct Arguments {
    /// The clip
    input: PathBuf,
    /// The file to write: .bvh, .glb (glTF), .csv, .h or .rs
    #[arg(short, long)]
    output: PathBuf,
    /// The rig of a clip that was made with --rig-out
    #[arg(long)]
    rig: Option<PathBuf>,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    let output = &arguments.output;
    let inputs: Vec<&Path> = [arguments.input.as_path()].into_iter().chain(arguments.rig.as_deref()).collect();
    output::check(&inputs, &[output])?;
    refuse_foreign(output, Wanted::Motion)?;
    let files = Files::read(&arguments.input, arguments.rig.as_deref())?;
    let place = || arguments.input.display().to_string();
    let clip = files.open().with_context(place)?;
    let stem = arguments.output.file_stem().unwrap_or_default().to_string_lossy();
    let expanded = Expanded::new(&clip);
    // A digit and a comma or a space a value; four bytes a number in glTF; as text, a digit and a comma a byte.
    let values = expanded.frames() as u64 * (expanded.rig().channels() as u64 + 1);
    let least = match output.extension().and_then(|extension| extension.to_str()) {
        Some("glb") => 4 * values,
        Some("h" | "rs") => 3 * files.clip_len() as u64,
        _ => 2 * values,
    };
    output::check_size(output, least)?;
    let mut out = Staged::create(output)?;
    match arguments.output.extension().and_then(|extension| extension.to_str()) {
        Some("bvh") => export::bvh::write(&expanded, Columns::ThreeRotations, &mut out).with_context(place)?,
        Some("csv") => export::table::write(&expanded, &mut out).with_context(place)?,
        Some("glb") => out.write_all(&export::gltf::write(&expand(&clip).with_context(place)?).with_context(place)?)?,
        Some("h") => out.write_all(export::source::c_header(&clip, files.clip(), &stem)?.as_bytes())?,
        Some("rs") => out.write_all(export::source::rust_module(&clip, files.clip(), &stem)?.as_bytes())?,
        _ => bail!("{}: expected a name that ends in .bvh, .glb, .csv, .h or .rs", arguments.output.display()),
    }
    output::commit(vec![out])
}
