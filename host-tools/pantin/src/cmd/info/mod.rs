//! `pantin info`.

mod channels;
mod fields;
mod report;

pub(super) use fields::memory_fields;
pub use fields::{CAPACITY, SMALL_CAPACITY};

use super::{Files, bank};
use crate::memory;
use crate::open::is_bank;
use crate::output::{self, outln};
use anyhow::{Context, Result, ensure};
use pantin_convert::import::{self, ImportOptions, animations};
use report::Report;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Print what a clip or a bank holds and how its bytes are used, or which animations a glTF, FBX or VRML file holds.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin info walk.ptn
  pantin info walk.ptn --json         `motion_bytes` is the file without its rig
  pantin info walk.ptn --against walk.bvh
  pantin info figure.glb")]
pub struct Arguments {
    /// The clip, or a .glb, .gltf, .fbx, .wrl or .x3dv
    input: PathBuf,
    /// The rig of a clip that was made with --rig-out
    #[arg(long)]
    rig: Option<PathBuf>,
    /// The motion that the clip was made of: print the greatest place, shell and rotation error of the clip, each with its joint and frame
    #[arg(long, value_name = "MOTION")]
    against: Option<PathBuf>,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    let input = arguments.input.display();
    if animations::chooses(&arguments.input) {
        ensure!(arguments.rig.is_none(), "{input}: --rig is for clips, and this is a motion");
        ensure!(arguments.against.is_none(), "{input}: --against is for clips, and this is a motion");
        return animations(&arguments.input);
    }
    let files = Files::read(&arguments.input, arguments.rig.as_deref())?;
    if is_bank(files.clip()) {
        ensure!(arguments.rig.is_none(), "{input}: --rig is for clips without one, and a bank holds its rig");
        ensure!(arguments.against.is_none(), "{input}: --against is for one clip, and this is a bank");
        return bank::print(&arguments.input, files.clip());
    }
    let clip = files.open_alone().with_context(|| input.to_string())?;
    let report = Report::of(&clip, files.clip_len(), arguments.against.as_deref())?;
    if output::is_json() {
        output::report(report.to_json());
        return Ok(());
    }
    report.print()
}

/// The animations of a file, one a line; `pantin convert --animation` takes their numbers or names.
pub fn animations(path: &Path) -> Result<()> {
    let entries = import::list(&memory::disk(), path, &ImportOptions::new().memory(memory::limit()))?;
    if output::is_json() {
        let object = |entry: &animations::Entry| json!({"name": entry.name, "frames": entry.frames, "fps": entry.fps, "seconds": entry.seconds(), "tracks": entry.tracks});
        output::report(json!({"animations": entries.iter().map(object).collect::<Vec<_>>()}));
        return Ok(());
    }
    for (number, entry) in entries.iter().enumerate() {
        let name = entry.name.as_deref().unwrap_or("without a name");
        let (frames, fps, tracks) = (entry.frames, (entry.fps * 1000.0).round() / 1000.0, entry.tracks);
        outln!("{number:3} {name}: {frames} frames at {fps} a second, {:.3} s, {tracks} tracks", entry.seconds())?;
    }
    Ok(())
}
