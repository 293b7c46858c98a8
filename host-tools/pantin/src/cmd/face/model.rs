//! `pantin face model`

use super::face_picture;
use crate::cmd::check_read;
use crate::memory;
use crate::output::{Wanted, check, note, refuse_foreign, report, write_together};
use anyhow::{Context, Result};
use pantin_convert::import::{self, Files};
use pantin_pictures::face::blueprint::Blueprint;
use pantin_pictures::face::{Face, cartoon, compact, error, onmesh, outside, points, sheet, small};
use serde_json::json;
use std::path::{Path, PathBuf};

/// Write the model that devices play: of Pantin's own face, of a mesh with feature points, or of a glTF's mesh and its morph targets.
///
/// With --points the paper's units are built on the mesh by its rules. Missing feature points are printed, with the units that need them.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin face model -o face.model
  pantin face model -o robot.model robot.obj --points robot.points --sheet robot.png
  pantin face model -o face.model --interpolation smile=spherical:40 --interpolation puff_cheeks=linear
  pantin face model -o cartoon.model --cartoon
  pantin face model -o eyes.model --cartoon eyes
  pantin face model -o small.model --small
  pantin face model -o cube.model cube.glb")]
pub struct Arguments {
    /// A mesh instead of Pantin's face: .obj, .wfm, .glb or .gltf with --points; without it the first mesh with morph targets of a .glb or .gltf
    mesh: Option<PathBuf>,
    /// The mesh's feature points: lines of an MPEG-4 number and a vertex counted from 0, as in `8.3 31`, or an .fdp of xface
    #[arg(long, value_name = "FILE", requires = "mesh", conflicts_with = "cartoon")]
    points: Option<PathBuf>,
    /// How a unit moves: linear, improved, eased, or spherical with an angle of 2 to 120 degrees; may be given several times
    #[arg(long, value_name = "UNIT=KIND[:DEGREES]")]
    interpolation: Vec<String>,
    /// A face of filled shapes instead of the wireframe head: cartoon (without a value), eyes or minimal, or that of a text file (docs/FACE.md)
    #[arg(long, value_name = "NAME|FILE", num_args = 0..=1, conflicts_with = "mesh")]
    cartoon: Option<Option<PathBuf>>,
    /// Leave out what a face of fewer than 96 pixels does not show: the same pictures on small displays, with less memory
    #[arg(long)]
    small: bool,
    /// Also draw each unit to this picture (PNG)
    #[arg(long, value_name = "FILE")]
    sheet: Option<PathBuf>,
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
    let inputs: Vec<&Path> =
        arguments.mesh.iter().chain(&arguments.points).chain(arguments.table()).map(PathBuf::as_path).collect();
    let outputs = [Some(&arguments.output), arguments.names.as_ref(), arguments.sheet.as_ref()];
    let outputs: Vec<&Path> = outputs.into_iter().flatten().map(PathBuf::as_path).collect();
    if let Some(sheet) = &arguments.sheet {
        face_picture(sheet, "face model --sheet")?;
    }
    if let Some(names) = &arguments.names {
        refuse_foreign(names, Wanted::Names)?;
    }
    check(&inputs, &outputs)?;
    let files = memory::disk();
    let mut blueprint: Blueprint = match (&arguments.mesh, &arguments.points) {
        (Some(path), Some(points)) => on_mesh(path, points, &files)?,
        (Some(path), None) => outside::model(path, &files)?,
        (None, _) => match &arguments.cartoon {
            Some(table) => of_shapes(table.as_deref(), &files)?,
            None => Face::new()?.blueprint,
        },
    };
    blueprint.choose_all(&arguments.interpolation)?;
    if arguments.small {
        let small = small::small(&blueprint);
        if (small.vertices(), small.curves.len()) == (blueprint.vertices(), blueprint.curves.len()) {
            note!("--small has no effect: small displays show all of this face");
        }
        blueprint = small;
    }
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
    let mut picture = Vec::new();
    if arguments.sheet.is_some() {
        sheet::of_model(&mut picture, &blueprint, &bytes)?;
    }
    let named = arguments.names.as_ref().map(|_| names.as_bytes());
    let contents = [Some(&bytes[..]), named, arguments.sheet.as_ref().map(|_| &picture[..])];
    write_together(&outputs.into_iter().zip(contents.into_iter().flatten()).collect::<Vec<_>>())
}

impl Arguments {
    /// The file of a face of filled shapes.
    fn table(&self) -> Option<&PathBuf> {
        self.cartoon.iter().flatten().find(|path| path.to_str().and_then(cartoon::named).is_none())
    }
}

/// The face of filled shapes of a table.
fn of_shapes(table: Option<&Path>, files: &dyn Files) -> Result<Blueprint> {
    let face = Face::new()?;
    let Some(path) = table else { return cartoon::build(&face.head, &face.blueprint, cartoon::TABLE) };
    if let Some(own) = path.to_str().and_then(cartoon::named) {
        return cartoon::build(&face.head, &face.blueprint, own);
    }
    let text = String::from_utf8(import::read_from(files, path)?).with_context(|| path.display().to_string())?;
    cartoon::build(&face.head, &face.blueprint, &text).with_context(|| path.display().to_string())
}

/// The paper's units on a mesh. Prints the feature points that are missing.
fn on_mesh(path: &Path, points: &Path, files: &dyn Files) -> Result<Blueprint> {
    let mesh = outside::mesh(path, files)?;
    let text = import::read_from(files, points)?;
    let points = points::parse(&String::from_utf8_lossy(&text)).with_context(|| points.display().to_string())?;
    let built = onmesh::build(&mesh, &points).with_context(|| path.display().to_string())?;
    if !built.missing.is_empty() {
        note!("missing feature points, and the units that need them: {}", onmesh::list(&built.missing));
    }
    Ok(built.blueprint)
}
