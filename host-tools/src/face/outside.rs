//! Meshes of other programs: points of an .obj, and a glTF's morph targets as a model.

use super::blueprint::{Blueprint, Drive, Shape};
use super::head::{Vector, cross, minus, plus, unit};
use super::paper::shape;
use crate::import::Files;
use crate::import::gltf::mesh::{self, Mesh};
use anyhow::{Context, Result, ensure};
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

fn of_target(ways: &[Vector], name: &str) -> Shape {
    Shape {
        deltas: ways.iter().copied().enumerate().filter(|(_, way)| *way != [0.0; 3]).collect(),
        ..shape(name, Interpolation::Linear, false)
    }
}

/// The finest step with which the sum of all targets fits 16 bits.
fn fraction_bits(mesh: &Mesh) -> i8 {
    let farthest = (0..mesh.points.len()).flat_map(|index| {
        let reach =
            |axis: usize| mesh.points[index][axis].abs() + mesh.targets.iter().map(|ways| ways[index][axis].abs()).sum::<f64>();
        [reach(0), reach(1), reach(2)]
    });
    let farthest = farthest.fold(1e-6, f64::max);
    (MOST_STEPS / farthest).log2().floor().clamp(-24.0, 24.0) as i8
}

fn normals(mesh: &Mesh) -> Vec<Vector> {
    let mut sums = vec![[0.0; 3]; mesh.points.len()];
    for &corners in &mesh.triangles {
        let [a, b, c] = corners.map(|corner| mesh.points[corner]);
        let normal = cross(minus(b, a), minus(c, a));
        corners.into_iter().for_each(|corner| sums[corner] = plus(sums[corner], normal, 1.0));
    }
    sums.into_iter().map(unit).collect()
}
