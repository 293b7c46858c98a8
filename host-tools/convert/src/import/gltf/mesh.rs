//! The first mesh with morph targets, or the first of all: points, triangles, targets by name.

use super::accessor::{indices, numbers};
use super::file::{COMPRESSED_TRIANGLES, File, has_compressed_triangles};
use super::scalars::target_names;
use crate::import::{Files, ImportOptions, Request};
use anyhow::{Context, Result, ensure};
use gltf::json::mesh::Semantic;
use gltf::json::validation::Checked;
use std::path::Path;

/// A mesh, in the file's units.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Places.
    pub points: Vec<[f64; 3]>,
    /// Corners.
    pub triangles: Vec<[usize; 3]>,
    /// For each target the way of each point.
    pub targets: Vec<Vec<[f64; 3]>>,
    /// The targets' names.
    pub names: Vec<String>,
}

/// Reads it from `files`. Parts of the mesh follow each other.
pub fn read(path: &Path, files: &dyn Files) -> Result<Mesh> {
    let options = ImportOptions::new();
    let request = Request::new(files, &options);
    let file = File::open(path, &request.read(path)?, &request)?;
    let with_targets = |mesh: &&gltf::json::Mesh| {
        mesh.primitives.iter().any(|part| part.targets.as_ref().is_some_and(|targets| !targets.is_empty()))
    };
    let meshes = &file.root.meshes;
    let mesh = meshes.iter().find(with_targets).or(meshes.first()).with_context(|| format!("{}: no mesh", path.display()))?;
    let mut out = Mesh::default();
    for (number, part) in mesh.primitives.iter().enumerate() {
        let first = out.points.len();
        let position = part.attributes.get(&Checked::Valid(Semantic::Positions));
        let position = position.with_context(|| format!("{}: part {number} of the mesh has no POSITION", path.display()))?;
        let compressed = has_compressed_triangles(&file.root);
        let without_bytes = file.root.accessors.get(position.value()).is_some_and(|accessor| accessor.buffer_view.is_none());
        ensure!(
            !(compressed && without_bytes),
            "{}: part {number} of the mesh is compressed ({COMPRESSED_TRIANGLES}), which is not read here: write the file without compression",
            path.display()
        );
        out.points.extend(places(&file, position.value())?);
        let count = out.points.len() - first;
        let corners = match part.indices {
            Some(index) => indices(&file, index.value())?,
            None => (0..count).collect(),
        };
        ensure!(corners.iter().all(|&corner| corner < count), "{}: an index of the mesh is outside", path.display());
        out.triangles.extend(corners.as_chunks::<3>().0.iter().map(|corners| corners.map(|corner| first + corner)));
        for (target, morph) in part.targets.iter().flatten().enumerate() {
            if out.targets.len() <= target {
                out.targets.push(Vec::new());
            }
            let ways = morph.positions.map(|index| places(&file, index.value())).transpose()?.unwrap_or_default();
            ensure!(
                ways.is_empty() || ways.len() == count,
                "{}: target {target} has {} points, its mesh {count}",
                path.display(),
                ways.len()
            );
            out.targets[target].resize(first, [0.0; 3]);
            out.targets[target].extend(ways);
        }
    }
    out.targets.iter_mut().for_each(|ways| ways.resize(out.points.len(), [0.0; 3]));
    let named = target_names(mesh);
    let prefix = mesh.name.clone().unwrap_or_else(|| "mesh".into());
    out.names = (0..out.targets.len())
        .map(|index| named.get(index).cloned().unwrap_or_else(|| format!("{prefix}.weights[{index}]")))
        .collect();
    Ok(out)
}

fn places(file: &File, accessor: usize) -> Result<Vec<[f64; 3]>> {
    Ok(numbers(file, accessor, 3)?.as_chunks().0.to_vec())
}
