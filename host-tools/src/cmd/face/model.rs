//! `pantin face model`

use crate::cmd::check_read;
use crate::face::blueprint::Blueprint;
use crate::face::{Face, compact, error, outside};
use crate::import::Files;
use crate::output::{Wanted, check, note, refuse_foreign, report, write_together};
use anyhow::Result;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Write the model that devices play: of Pantin's own face, or of a glTF's mesh and its morph targets.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin face model -o face.model
  pantin face model -o cube.model cube.glb")]
pub struct Arguments {
    /// A .glb or .gltf whose first mesh with morph targets is used instead of Pantin's face
    mesh: Option<PathBuf>,
    /// The file to write
    #[arg(short, long)]
    output: PathBuf,
    /// Also write the names that drive the face to this file, one per line
    #[arg(long, value_name = "FILE")]
    names: Option<PathBuf>,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    refuse_foreign(&arguments.output, Wanted::Model)?;
    let inputs: Vec<&Path> = arguments.mesh.iter().map(PathBuf::as_path).collect();
    let outputs: Vec<&Path> =
        [Some(&arguments.output), arguments.names.as_ref()].into_iter().flatten().map(PathBuf::as_path).collect();
    if let Some(names) = &arguments.names {
        refuse_foreign(names, Wanted::Names)?;
    }
    check(&inputs, &outputs)?;
    let files = Files::default();
    let blueprint: Blueprint = match &arguments.mesh {
        Some(path) => outside::model(path, &files)?,
        None => Face::new()?.blueprint,
    };
    check_read(&files, &outputs)?;
    let bytes = compact::encode(&blueprint)?;
    let moved: usize = blueprint.shapes.iter().map(|shape| shape.deltas.len()).sum();
    let whole = blueprint.shapes.len() * (blueprint.middles + blueprint.pairs);
    let error = error::greatest(&blueprint, &bytes)?;
    report(json!({
        "bytes": bytes.len(),
        "vertices": blueprint.vertices(),
        "units": blueprint.shapes.len(),
        "names": blueprint.names.len(),
        "stored_deltas": moved,
        "deltas": whole,
        "max_error_units": error.most,
        "max_error_percent_of_size": error.part * 100.0,
    }));
    note!(
        "{} bytes: {} vertices, {} units, {} names",
        bytes.len(),
        blueprint.vertices(),
        blueprint.shapes.len(),
        blueprint.names.len()
    );
    note!("{moved} of {whole} deltas are stored; as floats all of them would take {} bytes", whole * 12);
    note!("greatest error {:.5} units, {:.4} % of the size, over mixtures of weights", error.most, error.part * 100.0);
    let names = blueprint.name_list();
    let contents = [&bytes[..], names.as_bytes()];
    write_together(&outputs.into_iter().zip(contents).collect::<Vec<_>>())
}
