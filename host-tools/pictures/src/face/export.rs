//! Exports the face: as glTF with morph targets, or one pose as OBJ.

use super::Face;
use super::exact;
use super::head::Vector;
use super::pose::{self, Pairs};
use anyhow::{Context, Result};
use serde_json::json;
use std::borrow::Cow;
use std::fmt::Write;

/// glTF's component types.
const FLOAT: u32 = 5126;
const SHORT: u32 = 5123;
/// Metres per millimetre: glTF's unit is the metre.
const METRES: f64 = 1e-3;

/// Returns the triangles of both halves.
pub fn triangles(face: &Face) -> Vec<[usize; 3]> {
    let half = &face.blueprint.triangles;
    let images = half.iter().map(|&[a, b, c]| [a, c, b].map(|index| face.blueprint.mirror(index)));
    half.iter().copied().chain(images).collect()
}

/// Returns a pose as OBJ, in millimetres: points with their names as comments, faces, and curves as lines.
pub fn obj(face: &Face, pairs: &Pairs) -> Result<String> {
    let mut out = String::from("# Pantin's face, in millimetres\no face\n");
    for (index, [x, y, z]) in exact::places(&face.blueprint, pairs).into_iter().enumerate() {
        writeln!(out, "v {x:.4} {y:.4} {z:.4} # {}", face.head.label(index))?;
    }
    for [a, b, c] in triangles(face) {
        writeln!(out, "f {} {} {}", a + 1, b + 1, c + 1)?;
    }
    for curve in &face.blueprint.curves {
        let image: Vec<usize> = curve.points.iter().map(|&index| face.blueprint.mirror(index)).collect();
        for points in std::iter::once(&curve.points).chain(curve.paired.then_some(&image)) {
            let closing = points.first().filter(|_| curve.closed);
            let numbers: Vec<String> = points.iter().chain(closing).map(|index| (index + 1).to_string()).collect();
            writeln!(out, "l {}", numbers.join(" "))?;
        }
    }
    Ok(out)
}

/// Returns a pose as .glb: the mesh, with one morph target per unit. Rotations become straight displacements, because glTF has no others.
pub fn glb(face: &Face, pairs: &Pairs) -> Result<Vec<u8>> {
    let mut file = Buffers::default();
    let places = exact::places(&face.blueprint, pairs);
    let corners: Vec<usize> = triangles(face).into_iter().flatten().collect();
    let position = file.places(&places);
    let indices = file.indices(&corners);
    let (mut names, mut targets) = (Vec::new(), Vec::new());
    for name in targets_of(face) {
        let mut full: Pairs = pairs.clone();
        pose::add(&face.blueprint, name, 1.0, &mut full)?;
        let ways: Vec<Vector> =
            exact::places(&face.blueprint, &full).iter().zip(&places).map(|(to, from)| super::head::minus(*to, *from)).collect();
        targets.push(json!({"POSITION": file.places(&ways)}));
        names.push(name);
    }
    let root = json!({
        "asset": {"version": "2.0", "generator": concat!("pantin ", env!("CARGO_PKG_VERSION"))},
        "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"name": "face", "mesh": 0}],
        "meshes": [{
            "name": "face", "weights": vec![0.0; names.len()], "extras": {"targetNames": names},
            "primitives": [{"attributes": {"POSITION": position}, "indices": indices, "targets": targets}],
        }],
        "accessors": file.accessors, "bufferViews": file.views, "buffers": [{"byteLength": file.bytes.len()}],
    });
    let header = gltf::binary::Header { magic: *b"glTF", version: 2, length: 0 };
    let glb = gltf::Glb { header, json: Cow::Owned(serde_json::to_vec(&root)?), bin: Some(Cow::Owned(file.bytes)) };
    glb.to_vec().context("the .glb cannot be put together")
}

/// The names of the units, for each side where they have sides. Rotations of the head are omitted: they move no point of the mesh.
fn targets_of(face: &Face) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    let sided = |shape: usize| face.blueprint.shapes[shape].sided;
    for drive in &face.blueprint.names {
        let own = drive.gain == 1.0 && drive.name.starts_with(&face.blueprint.shapes[drive.shape].name);
        let both = sided(drive.shape) && drive.sides == [true, true];
        if own && !both && !drive.name.starts_with("head_") && !names.contains(&drive.name.as_str()) {
            names.push(&drive.name);
        }
    }
    names
}

#[derive(Default)]
struct Buffers {
    bytes: Vec<u8>,
    views: Vec<serde_json::Value>,
    accessors: Vec<serde_json::Value>,
}

impl Buffers {
    fn places(&mut self, places: &[Vector]) -> usize {
        let metres: Vec<[f32; 3]> = places.iter().map(|place| place.map(|x| (x * METRES) as f32)).collect();
        let bound =
            |pick: fn(f32, f32) -> f32| [0, 1, 2].map(|axis| metres.iter().map(|place| place[axis]).reduce(pick).unwrap_or(0.0));
        let (least, most) = (bound(f32::min), bound(f32::max));
        self.add(metres.iter().flatten().flat_map(|x| x.to_le_bytes()).collect());
        let view = self.views.len() - 1;
        self.accessors.push(
            json!({"bufferView": view, "componentType": FLOAT, "count": places.len(), "type": "VEC3", "min": least, "max": most}),
        );
        self.accessors.len() - 1
    }

    fn indices(&mut self, indices: &[usize]) -> usize {
        self.add(indices.iter().flat_map(|&index| (index as u16).to_le_bytes()).collect());
        let view = self.views.len() - 1;
        self.accessors.push(json!({"bufferView": view, "componentType": SHORT, "count": indices.len(), "type": "SCALAR"}));
        self.accessors.len() - 1
    }

    fn add(&mut self, bytes: Vec<u8>) {
        let offset = self.bytes.len();
        self.views.push(json!({"buffer": 0, "byteOffset": offset, "byteLength": bytes.len()}));
        self.bytes.extend(bytes);
        // Accessors start at multiples of their component's size.
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
    }
}
