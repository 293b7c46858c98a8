//! Meshes of other programs: points of an .obj, and a glTF's morph targets as a model.

use super::blueprint::{Blueprint, Drive, Shape};
use super::head::{Vector, cross, minus, plus, unit};
use super::paper::shape;
use crate::import::Files;
use crate::import::gltf::mesh::{self, Mesh};
use anyhow::{Context, Result, bail, ensure};
use pantin_face::shape::Interpolation;
use std::path::Path;

/// Maximum coordinate of a vertex of the device, in steps.
const MOST_STEPS: f64 = i16::MAX as f64;

/// Reads the points of an .obj.
pub fn obj_points(text: &str) -> Result<Vec<Vector>> {
    let point = |(number, line): (usize, &str)| -> Option<Result<Vector>> {
        let mut words = line.split('#').next()?.split_whitespace();
        (words.next()? == "v").then(|| {
            let mut next = || -> Result<f64> { Ok(words.next().context("expected x, y and z")?.parse()?) };
            (|| anyhow::Ok([next()?, next()?, next()?]))().with_context(|| format!("line {}", number + 1))
        })
    };
    text.lines().enumerate().filter_map(point).collect()
}

/// Reads a mesh: an .obj, a .wfm (Candide), or the first mesh of a glTF.
pub fn mesh(path: &Path, files: &Files) -> Result<Mesh> {
    let place = || path.display().to_string();
    let extension = path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase);
    let read = match extension.as_deref() {
        Some("glb" | "gltf") => return mesh::read(path, files),
        Some("obj") => obj as fn(&str) -> Result<Mesh>,
        Some("wfm") => wfm,
        _ => bail!("{}: expected a mesh: .obj, .glb, .gltf or .wfm", place()),
    };
    // Comments of old files are in Latin-1.
    let mesh = read(&String::from_utf8_lossy(&files.read(path)?)).with_context(place)?;
    let count = mesh.points.len();
    ensure!(count > 0 && !mesh.triangles.is_empty(), "{}: no triangles", place());
    ensure!(
        mesh.triangles.iter().flatten().all(|&corner| corner < count),
        "{}: a triangle has a vertex that is not there",
        place()
    );
    Ok(mesh)
}

/// Reads points and faces of an .obj; faces of more than three corners become fans.
pub fn obj(text: &str) -> Result<Mesh> {
    let points = obj_points(text)?;
    let mut triangles = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let mut words = line.split('#').next().unwrap_or("").split_whitespace();
        if words.next() != Some("f") {
            continue;
        }
        let corner = |word: &str| -> Result<usize> {
            let index: i64 = word.split('/').next().unwrap_or("").parse()?;
            // Negative numbers count from the end.
            let index = if index < 0 { points.len() as i64 + index } else { index - 1 };
            usize::try_from(index).context("vertices count from 1")
        };
        let corners = words.map(corner).collect::<Result<Vec<_>>>().with_context(|| format!("line {}", number + 1))?;
        triangles.extend(corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]]));
    }
    Ok(Mesh { points, triangles, ..Mesh::default() })
}

/// Reads the vertices and the faces of a Candide model.
pub fn wfm(text: &str) -> Result<Mesh> {
    let rows = |title: &str| -> Result<Vec<Vec<f64>>> {
        let (_, rest) = text.split_once(title).with_context(|| format!("no {title}"))?;
        let mut lines = rest.lines().skip(1).map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
        let count: usize = lines.next().and_then(|line| line.parse().ok()).with_context(|| format!("{title}: no count"))?;
        let row = |line: &str| line.split_whitespace().take(3).map(|word| Ok(word.parse::<f64>()?)).collect::<Result<Vec<_>>>();
        let rows = lines.take(count).map(row).collect::<Result<Vec<_>>>().with_context(|| title.to_string())?;
        ensure!(rows.len() == count && rows.iter().all(|row| row.len() == 3), "{title}: expected {count} rows of three numbers");
        Ok(rows)
    };
    let triple = |row: &Vec<f64>| [row[0], row[1], row[2]];
    let points = rows("VERTEX LIST:")?.iter().map(triple).collect();
    let triangles = rows("FACE LIST:")?.iter().map(|row| triple(row).map(|x| x as usize)).collect();
    Ok(Mesh { points, triangles, ..Mesh::default() })
}

/// Reads the points of a .glb that `pantin face export` wrote, in millimetres.
pub fn glb_points(path: &Path) -> Result<Vec<Vector>> {
    Ok(mesh::read(path, &Files::default())?.points.iter().map(|place| place.map(|x| x * 1000.0)).collect())
}

/// Returns the first mesh of a glTF among `files` that has morph targets, one shape per target. All its points are stored, none is a mirror image.
pub fn model(path: &Path, files: &Files) -> Result<Blueprint> {
    let mesh = mesh::read(path, files)?;
    ensure!(!mesh.targets.is_empty(), "{}: no mesh with morph targets", path.display());
    let shapes: Vec<Shape> = mesh.targets.iter().zip(&mesh.names).map(|(ways, name)| of_target(ways, name)).collect();
    let drive = |(index, name): (usize, &String)| Drive { name: name.clone(), shape: index, sides: [true, false], gain: 1.0 };
    let names = mesh.names.iter().enumerate().map(drive).collect();
    Ok(Blueprint {
        middles: mesh.points.len(),
        pairs: 0,
        fraction_bits: fraction_bits(&mesh),
        normals: normals(&mesh),
        outline: mesh.triangles.len(),
        triangles: mesh.triangles,
        points: mesh.points,
        shapes,
        names,
        ..Blueprint::default()
    })
}

/// A morph target as a shape.
pub fn of_target(ways: &[Vector], name: &str) -> Shape {
    Shape {
        deltas: ways.iter().copied().enumerate().filter(|(_, way)| *way != [0.0; 3]).collect(),
        ..shape(name, Interpolation::Linear, false)
    }
}

/// The finest step with which the sum of all targets fits 16 bits.
pub fn fraction_bits(mesh: &Mesh) -> i8 {
    let farthest = (0..mesh.points.len()).flat_map(|index| {
        let reach =
            |axis: usize| mesh.points[index][axis].abs() + mesh.targets.iter().map(|ways| ways[index][axis].abs()).sum::<f64>();
        [reach(0), reach(1), reach(2)]
    });
    let farthest = farthest.fold(1e-6, f64::max);
    (MOST_STEPS / farthest).log2().floor().clamp(-24.0, 24.0) as i8
}

/// Unit normals of the points of a mesh, means of the triangles around them weighted by area.
pub fn normals(mesh: &Mesh) -> Vec<Vector> {
    let mut sums = vec![[0.0; 3]; mesh.points.len()];
    for &corners in &mesh.triangles {
        let [a, b, c] = corners.map(|corner| mesh.points[corner]);
        let normal = cross(minus(b, a), minus(c, a));
        corners.into_iter().for_each(|corner| sums[corner] = plus(sums[corner], normal, 1.0));
    }
    sums.into_iter().map(unit).collect()
}
