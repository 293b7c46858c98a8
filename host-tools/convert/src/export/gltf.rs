//! glTF out, as .glb: a node a joint, and one animation with a key at every frame.
//!
//! Lengths are metres, as glTF has it. A skin names the joints, so that readers make an armature of them. Scalars become the morph weights of a mesh of one point, whose targets bear their names: any
//! reader of morph weights finds them. Events stand in the animation's `extras`, as `{"events": [{"time": 0.5, "name": "step"}]}`. End Sites are nodes called like their parents, with `/end` behind.

use crate::fk::{local, quaternion};
use crate::motion::Motion;
use anyhow::{Context, Result, ensure};
use serde_json::{Value, json};
use std::borrow::Cow;

/// glTF's names for numbers: f32, and a mesh of points.
const FLOAT: u32 = 5126;
const POINTS: u32 = 0;

/// `motion` as the bytes of a .glb.
pub fn write(motion: &Motion) -> Result<Vec<u8>> {
    ensure!(motion.rig.channels() > 0, "nothing moves, so there is no animation to write");
    let mut file = Writer::default();
    let seconds: Vec<f64> = (0..motion.frames).map(|frame| frame as f64 * motion.frame_time).collect();
    let times = file.accessor("SCALAR", 1, &seconds, true);
    joints(motion, times, &mut file);
    skin(motion, &mut file);
    scalars(motion, times, &mut file);
    file.events = motion.events.iter().map(|event| json!({"time": seconds[event.frame], "name": event.name})).collect();
    file.finish()
}

#[derive(Default)]
struct Writer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    nodes: Vec<Value>,
    roots: Vec<usize>,
    meshes: Vec<Value>,
    skins: Vec<Value>,
    samplers: Vec<Value>,
    channels: Vec<Value>,
    /// Events of the animation, which glTF has no place for but `extras`.
    events: Vec<Value>,
}

impl Writer {
    /// Adds numbers, `components` an element, and returns the accessor's index.
    fn accessor(&mut self, kind: &str, components: usize, numbers: &[f64], bounded: bool) -> usize {
        let offset = self.bytes.len();
        self.bytes.extend(numbers.iter().flat_map(|&x| (x as f32).to_le_bytes()));
        self.views.push(json!({"buffer": 0, "byteOffset": offset, "byteLength": self.bytes.len() - offset}));
        let mut accessor = json!({
            "bufferView": self.views.len() - 1, "componentType": FLOAT, "count": numbers.len() / components, "type": kind,
        });
        if bounded {
            // Of f64: how an f32 is written depends on features of serde_json that another crate may ask for.
            let of = |pick: fn(f32, f32) -> f32, from: f32| -> Vec<f64> {
                let along = |i: usize| numbers.iter().skip(i).step_by(components).fold(from, |x, &y| pick(x, y as f32));
                (0..components).map(along).map(f64::from).collect()
            };
            accessor["min"] = json!(of(f32::min, f32::MAX));
            accessor["max"] = json!(of(f32::max, f32::MIN));
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn animate(&mut self, node: usize, path: &str, times: usize, output: usize) {
        self.samplers.push(json!({"input": times, "interpolation": "LINEAR", "output": output}));
        self.channels.push(json!({"sampler": self.samplers.len() - 1, "target": {"node": node, "path": path}}));
    }

    fn finish(self) -> Result<Vec<u8>> {
        let mut root = json!({
            "asset": {"version": "2.0", "generator": concat!("pantin ", env!("CARGO_PKG_VERSION"))},
            "scene": 0,
            "scenes": [{"nodes": self.roots}],
            "nodes": self.nodes,
            "animations": [{"name": "motion", "samplers": self.samplers, "channels": self.channels}],
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": self.bytes.len()}],
        });
        if !self.events.is_empty() {
            root["animations"][0]["extras"] = json!({"events": self.events});
        }
        if !self.meshes.is_empty() {
            root["meshes"] = json!(self.meshes);
        }
        if !self.skins.is_empty() {
            root["skins"] = json!(self.skins);
        }
        let header = gltf::binary::Header { magic: *b"glTF", version: 2, length: 0 };
        let glb = gltf::Glb { header, json: Cow::Owned(serde_json::to_vec(&root)?), bin: Some(Cow::Owned(self.bytes)) };
        glb.to_vec().context("the .glb cannot be put together")
    }
}

/// A node for each joint, with its index. The root's tracks are always there, so that readers know the figure by them.
fn joints(motion: &Motion, times: usize, file: &mut Writer) {
    let rig = &motion.rig;
    let metres = rig.cm_per_unit / 100.0;
    let firsts = rig.first_channels();
    let mut children = vec![Vec::new(); rig.joints.len()];
    for (index, joint) in rig.joints.iter().enumerate() {
        joint.parent.map_or(&mut file.roots, |parent| &mut children[parent]).push(index);
    }
    for (index, joint) in rig.joints.iter().enumerate() {
        let mut before = [0.0, 0.0, 0.0, 1.0];
        let (mut places, mut turns) = (Vec::new(), Vec::new());
        for frame in 0..motion.frames {
            let (turn, place) = local(joint, |channel| motion.values[firsts[index] + channel][frame]);
            let turn = quaternion(&turn);
            // Of the two quaternions that turn alike, the nearer: readers mix those that follow each other.
            let dot: f64 = (0..4).map(|i| turn[i] * before[i]).sum();
            before = if dot < 0.0 { turn.map(|x| -x) } else { turn };
            turns.extend(before);
            places.extend(place.map(|x| x * metres));
        }
        let mut node = json!({"name": rig.joint_name(index), "translation": places[..3], "rotation": turns[..4]});
        if !children[index].is_empty() {
            node["children"] = json!(children[index]);
        }
        file.nodes.push(node);
        let kinds = &joint.kinds;
        if index == 0 || kinds.iter().any(|kind| kind.is_position()) {
            let output = file.accessor("VEC3", 3, &places, false);
            file.animate(index, "translation", times, output);
        }
        if index == 0 || kinds.iter().any(|kind| !kind.is_position()) {
            let output = file.accessor("VEC4", 4, &turns, false);
            file.animate(index, "rotation", times, output);
        }
    }
}

/// A skin that names the joints: by it readers such as Blender know that the nodes are bones of one armature.
fn skin(motion: &Motion, file: &mut Writer) {
    let count = motion.rig.joints.len();
    if count > 0 {
        file.skins.push(json!({"name": "figure", "joints": (0..count).collect::<Vec<_>>()}));
    }
}

fn scalars(motion: &Motion, times: usize, file: &mut Writer) {
    let names: Vec<&str> = motion.rig.scalars.iter().map(|scalar| scalar.name.as_str()).collect();
    if names.is_empty() {
        return;
    }
    let point = file.accessor("VEC3", 3, &[0.0; 3], true);
    let first = motion.rig.joint_channels();
    let of_frame = |frame: usize| motion.values[first..].iter().map(move |values| values[frame]);
    let weights: Vec<f64> = (0..motion.frames).flat_map(of_frame).collect();
    file.meshes.push(json!({
        "name": "scalars",
        "primitives": [{"attributes": {"POSITION": point}, "mode": POINTS, "targets": vec![json!({"POSITION": point}); names.len()]}],
        "weights": weights[..names.len()],
        "extras": {"targetNames": names},
    }));
    let node = file.nodes.len();
    file.nodes.push(json!({"name": "scalars", "mesh": 0}));
    file.roots.push(node);
    let output = file.accessor("SCALAR", 1, &weights, false);
    file.animate(node, "weights", times, output);
}
