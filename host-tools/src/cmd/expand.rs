//! `pantin expand`.

use super::{Files, default_output, format_of};
use crate::expand::{Expanded, expand};
use crate::export::{self, bvh::Columns};
use crate::motion::Frames;
use crate::output::{self, Staged, Wanted, note, refuse_foreign};
use anyhow::{Context, Result, bail};
use pantin::Clip;
use serde_json::json;
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
  pantin expand walk.ptn --format csv -o - | head -1
  pantin expand walk.ptn --rig figure.rig -o walk.bvh
  pantin expand walk.ptn -o walk.glb
  pantin expand face.ptn -o face.csv
  pantin expand walk.ptn -o walk.h
  pantin expand walk.ptn -o src/walk.rs")]
pub struct Arguments {
    /// The clip
    input: PathBuf,
    /// The file to write: .bvh, .glb (glTF), .csv, .h or .rs [default: the clip's name, ending in .bvh, or in .csv without joints;
    /// a file that is there already is kept]
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// The format, where the output's name does not say it, as in `-o -`
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// The rig of a clip that was made with --rig-out
    #[arg(long)]
    rig: Option<PathBuf>,
}

/// What the file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// Biovision hierarchy
    Bvh,
    /// Binary glTF
    Glb,
    /// A table
    Csv,
    /// A C header
    H,
    /// A Rust module
    Rs,
}

impl Arguments {
    /// Checks the output before any work.
    fn check(&self, output: &Path) -> Result<()> {
        let inputs: Vec<&Path> = [self.input.as_path()].into_iter().chain(self.rig.as_deref()).collect();
        output::check(&inputs, &[output])?;
        refuse_foreign(output, Wanted::Motion)
    }

    /// The name of an output that the user does not name.
    fn default_output(&self, clip: &Clip) -> Result<PathBuf> {
        let format = match self.format {
            Some(Format::Bvh) => "bvh",
            Some(Format::Glb) => "glb",
            Some(Format::Csv) => "csv",
            Some(Format::H) => "h",
            Some(Format::Rs) => "rs",
            None if clip.rig().joint_count() == 0 => "csv",
            None => "bvh",
        };
        let output = default_output(&self.input, format)?;
        self.check(&output)?;
        Ok(output)
    }
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    if let Some(output) = &arguments.output {
        arguments.check(output)?;
        format_of(output, arguments.format)?;
    }
    let files = Files::read(&arguments.input, arguments.rig.as_deref())?;
    let place = || arguments.input.display().to_string();
    let clip = files.open_alone().with_context(place)?;
    let output = &match &arguments.output {
        Some(output) => output.clone(),
        None => arguments.default_output(&clip)?,
    };
    let Some(format) = format_of(output, arguments.format)? else {
        bail!("{}: expected a name that ends in .bvh, .glb, .csv, .h or .rs, or --format", output.display());
    };
    // Standard output has no name.
    let named = if output.as_os_str() == "-" { &arguments.input } else { output };
    let stem = named.file_stem().unwrap_or_default().to_string_lossy();
    let expanded = Expanded::new(&clip);
    // A digit and a comma or a space a value; four bytes a number in glTF; as text, a digit and a comma a byte.
    let values = expanded.frames() as u64 * (expanded.rig().channels() as u64 + 1);
    let least = match format {
        Format::Glb => 4 * values,
        Format::H | Format::Rs => 3 * files.clip_len() as u64,
        Format::Bvh | Format::Csv => 2 * values,
    };
    output::check_size(output, least)?;
    if clip.event_count() > 0 && !matches!(format, Format::H | Format::Rs) {
        note!("{}: {} events are left out: this kind of file holds none here", output.display(), clip.event_count());
    }
    let mut out = Staged::create(output)?;
    match format {
        Format::Bvh => export::bvh::write(&expanded, Columns::ThreeRotations, &mut out).with_context(place)?,
        Format::Csv => export::table::write(&expanded, &mut out).with_context(place)?,
        Format::Glb => out.write_all(&export::gltf::write(&expand(&clip).with_context(place)?).with_context(place)?)?,
        Format::H => out.write_all(export::source::c_header(&clip, files.clip(), &stem)?.as_bytes())?,
        Format::Rs => out.write_all(export::source::rust_module(&clip, files.clip(), &stem)?.as_bytes())?,
    }
    output::commit(vec![out])?;
    output::report(json!({"frames": clip.frames(), "channels": expanded.rig().channels()}));
    if arguments.output.is_none() {
        note!("{}: written", output.display());
    }
    Ok(())
}
