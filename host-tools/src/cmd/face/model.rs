//! `pantin face model`

use crate::cmd::write_whole;
use crate::face::blueprint::Blueprint;
use crate::face::{Face, compact, error, outside};
use anyhow::Result;
use std::path::PathBuf;

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
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    let blueprint: Blueprint = match &arguments.mesh {
        Some(path) => outside::model(path)?,
        None => Face::new()?.blueprint,
    };
    let bytes = compact::encode(&blueprint)?;
    let moved: usize = blueprint.shapes.iter().map(|shape| shape.deltas.len()).sum();
    let whole = blueprint.shapes.len() * (blueprint.middles + blueprint.pairs);
    println!(
        "{} bytes: {} vertices, {} units, {} names",
        bytes.len(),
        blueprint.vertices(),
        blueprint.shapes.len(),
        blueprint.names.len()
    );
    println!("{moved} of {whole} deltas are stored; as floats all of them would take {} bytes", whole * 12);
    let error = error::greatest(&blueprint, &bytes)?;
    println!("greatest error {:.5} units, {:.4} % of the size, over mixtures of weights", error.most, error.part * 100.0);
    write_whole(&arguments.output, &bytes)
}
