//! Small glTF files of our own: curves that convert exactly, scales, accessors, several animations, and what is refused.

use crate::noise::Noise;
use crate::told::Told;
use base64::Engine as _;
use pantin_convert::fit::bounds::Bounds;
use pantin_convert::fit::channelwise;
use pantin_convert::import::{Disk, ImportOptions, InMemory};
use pantin_convert::motion::{Keys, Kind, Motion};
use pantin_convert::{channel_error, encode, expand, export, fk, import};
use pantin_pictures::face::outside;
use serde_json::{Value, json};
use std::path::PathBuf;

/// A file in the making: accessors over one buffer.
pub struct Builder {
    pub root: Value,
    bytes: Vec<u8>,
}

impl Builder {
    /// These nodes, the first of which is the scene's only root.
    pub fn new(nodes: Value) -> Builder {
        let root = json!({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": nodes,
            "accessors": [], "bufferViews": [], "buffers": [{"byteLength": 0}],
            "animations": [{"samplers": [], "channels": []}],
        });
        Builder { root, bytes: Vec::new() }
    }

    fn push(&mut self, part: &str, value: Value) -> usize {
        let list = self.root[part].as_array_mut().unwrap();
        list.push(value);
        list.len() - 1
    }

    fn raw(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        let view = json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()});
        let view = self.push("bufferViews", view);
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.push("accessors", json!({"bufferView": view, "componentType": component, "count": count, "type": kind}))
    }

    fn floats(&mut self, kind: &str, numbers: &[f32]) -> usize {
        let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
        let components = match kind {
            "SCALAR" => 1,
            "VEC3" => 3,
            _ => 4,
        };
        self.raw(&bytes, 5126, kind, numbers.len() / components)
    }

    pub fn animate(&mut self, node: usize, path: &str, interpolation: &str, times: &[f32], values: &[f32]) {
        let input = self.floats("SCALAR", times);
        let kind = match path {
            "rotation" => "VEC4",
            "weights" => "SCALAR",
            _ => "VEC3",
        };
        let output = self.floats(kind, values);
        let animation = self.root["animations"].as_array_mut().unwrap().last_mut().unwrap();
        let samplers = animation["samplers"].as_array_mut().unwrap();
        samplers.push(json!({"input": input, "interpolation": interpolation, "output": output}));
        let sampler = samplers.len() - 1;
        let channel = json!({"sampler": sampler, "target": {"node": node, "path": path}});
        animation["channels"].as_array_mut().unwrap().push(channel);
    }

    pub fn text(&self) -> String {
        let mut root = self.root.clone();
        let data = base64::engine::general_purpose::STANDARD.encode(&self.bytes);
        root["buffers"][0]["byteLength"] = json!(self.bytes.len());
        root["buffers"][0]["uri"] = json!(format!("data:application/octet-stream;base64,{data}"));
        root.to_string()
    }

    fn load(&self, name: &str) -> Told {
        load(name, &self.text(), &ImportOptions::new()).unwrap_or_else(|error| panic!("{name}: {error:#}"))
    }
}

fn load(name: &str, text: &str, options: &ImportOptions) -> anyhow::Result<Told> {
    let path = std::env::temp_dir().join(format!("pantin-gltf-{name}-{}.gltf", std::process::id()));
    std::fs::write(&path, text).unwrap();
    let loaded = crate::told::load(&path, options);
    std::fs::remove_file(&path).unwrap();
    loaded
}

fn channel(motion: &Motion, name: &str) -> usize {
    let found = (0..motion.rig.channels()).find(|&index| motion.rig.channel_name(index) == name);
    found.unwrap_or_else(|| panic!("no channel {name}"))
}

/// A root that walks on a spline whose keys are mostly between frames, and a face.
fn spline() -> Builder {
    let mut builder = Builder::new(json!([
        {"name": "hips", "children": [1]}, {"name": "head", "translation": [0, 0.75, 0], "mesh": 0},
    ]));
    let primitive = json!({"attributes": {}, "targets": [{}, {}]});
    builder.root["meshes"] = json!([{"primitives": [primitive], "extras": {"targetNames": ["smile", "blink"]}}]);
    // In tangent, value, out tangent.
    let places = [
        [0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.5, 0.25, 1.0],
        [1.0, -0.5, 1.0],
        [0.5, 1.25, 1.0],
        [0.25, 0.0, -1.0],
        [0.0, 0.5, 0.0],
        [0.25, 0.75, 2.0],
        [0.0, 0.0, 0.0],
    ];
    builder.animate(0, "translation", "CUBICSPLINE", &[0.0, 0.71, 2.0], places.as_flattened());
    builder.animate(1, "weights", "LINEAR", &[0.0, 0.33, 1.57, 2.0], &[0.0, 0.0, 1.0, 0.5, 0.25, 0.125, 0.0, 1.0]);
    builder
}

#[test]
fn an_animation_of_nodes_outside_of_the_scene_alone_is_refused() {
    let mut builder = Builder::new(json!([{"name": "root"}, {"name": "other"}]));
    builder.animate(1, "translation", "LINEAR", &[0.0, 1.0], &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    let error = load("outside", &builder.text(), &ImportOptions::new()).err().unwrap();
    assert!(format!("{error:#}").contains("animations[0]: no channel moves a node of the scene, so nothing moves"), "{error:#}");
}

#[test]
fn cubic_and_straight_tracks_convert_without_a_fit() {
    let motion = spline().load("exact").motion;
    assert_eq!((motion.frames, motion.frame_time), (61, 1.0 / 30.0));
    assert!(motion.keys.iter().all(|keys| matches!(keys, Some(Keys::Pieces(_)))));
    // The first piece, by glTF's own formula.
    let z = &motion.values[channel(&motion, "hips.Zposition")];
    for (frame, value) in z.iter().enumerate().take(22) {
        let (length, t) = (f64::from(0.71f32), frame as f64 / 30.0 / f64::from(0.71f32));
        let (t2, t3) = (t * t, t * t * t);
        let expected = length * (t3 - 2.0 * t2 + t) * 1.0 + (3.0 * t2 - 2.0 * t3) * 1.0 + length * (t3 - t2) * 1.0;
        assert!((value - expected).abs() < 1e-12, "{frame}: {value}, not {expected}");
    }
    let bounds = Bounds::exact(&motion).unwrap();
    let rig = encode::rig::encode(&motion.rig).unwrap();
    let coded = channelwise::fit(&motion, &bounds, &|| ()).unwrap();
    let bytes = encode::clip::encode(&coded, &rig, true).unwrap();
    let report = channel_error::verify(&bytes, &rig, &motion, &bounds).unwrap();
    println!("{} bytes; {}", bytes.len(), report.worst.sentence(&motion));
    // Places are exact to a part of the figure's height.
    let height = import::units::figure_height_cm(&motion).unwrap() / motion.rig.cm_per_unit;
    for (channel, &bound) in bounds.greatest.iter().enumerate() {
        let is_place = motion.rig.channel_kinds()[channel].1.is_position();
        let range = pantin_convert::fit::bounds::range(&motion, channel).max(if is_place { height } else { 0.0 });
        assert!(bound <= range / 65536.0, "{}", motion.rig.channel_name(channel));
    }
    // A few numbers a key: 61 frames of 5 channels take 610 bytes at 16 bits.
    assert!(bytes.len() < 200, "{} bytes", bytes.len());
}

#[test]
fn steps_convert_without_a_fit_and_turn_on_their_frame() {
    let mut builder = Builder::new(json!([{"name": "lever"}]));
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let turns = [[0.0, 0.0, 0.0, 1.0], [half, 0.0, 0.0, half], [0.0, 0.0, 0.0, 1.0]];
    builder.animate(0, "rotation", "STEP", &[0.5, 0.6, 0.8], turns.as_flattened());
    let motion = builder.load("steps").motion;
    let angle = &motion.values[channel(&motion, "lever.Xrotation")];
    let expected = [0.0, 90.0, 90.0, 0.0];
    assert_eq!(motion.frames, 4, "keys 0.1 s apart are frames");
    assert!(angle.iter().zip(expected).all(|(angle, expected)| (angle - expected).abs() < 1e-4), "{angle:?}");
    let bounds = Bounds::exact(&motion).unwrap();
    let rig = encode::rig::encode(&motion.rig).unwrap();
    let bytes = encode::clip::encode(&channelwise::fit(&motion, &bounds, &|| ()).unwrap(), &rig, true).unwrap();
    channel_error::verify(&bytes, &rig, &motion, &bounds).unwrap();
}

#[test]
fn cubic_rotations_convert_without_a_fit_as_quaternions() {
    // The figure lies on its side in what carries it; keys are mostly between frames.
    let mut builder = Builder::new(json!([
        {"rotation": [0.6, 0, 0, 0.8], "children": [1]}, {"name": "hips", "children": [2]}, {"name": "head", "translation": [0, 0.75, 0]},
    ]));
    // In tangent, value, out tangent; the values are not of length 1, nor is what lies between.
    let turns = [
        [0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
        [1.0, 0.5, 0.0, 0.0],
        [0.5, 0.0, 1.0, -1.0],
        [0.5, 0.25, 0.25, 0.75],
        [0.0, -1.0, 0.25, 0.0],
        [0.0, 0.0, 0.5, 0.0],
        [-0.25, 0.5, 0.0, 0.5],
        [0.0, 0.0, 0.0, 0.0],
    ];
    builder.animate(1, "rotation", "CUBICSPLINE", &[0.0, 0.71, 2.0], turns.as_flattened());
    builder.animate(2, "rotation", "LINEAR", &[0.0, 2.0], &[0.0, 0.0, 0.6, 0.8, 0.0, 0.0, 0.6, 0.8]);
    let options = ImportOptions::new().quaternions(true);
    let motion = load("quaternions", &builder.text(), &options).unwrap().motion;
    let kinds = [Kind::Wquaternion, Kind::Xquaternion, Kind::Yquaternion, Kind::Zquaternion];
    assert_eq!(motion.rig.joints[0].kinds, kinds);
    let bounds = Bounds::exact(&motion).unwrap();
    let rig = encode::rig::encode(&motion.rig).unwrap();
    let bytes = encode::clip::encode(&channelwise::fit(&motion, &bounds, &|| ()).unwrap(), &rig, true).unwrap();
    channel_error::verify(&bytes, &rig, &motion, &bounds).unwrap();
    println!("{} bytes", bytes.len());
    // 61 frames of 4 components take 488 bytes at 16 bits.
    assert!(bytes.len() < 150, "{} bytes", bytes.len());
    // Both ways to read the file put the head at the same place.
    let angles = load("angles", &builder.text(), &ImportOptions::new()).unwrap().motion;
    assert!(Bounds::exact(&angles).unwrap_err().to_string().contains("CUBICSPLINE or STEP"));
    for frame in 0..61 {
        let [a, b] = [&motion, &angles].map(|motion| fk::positions(&motion.rig, &motion.values, frame));
        let far = a.iter().zip(&b).map(|(a, b)| fk::distance(*a, *b)).fold(0.0, f64::max);
        assert!(far < 1e-6, "{far} cm at {frame}");
    }
}

#[test]
fn scales_move_the_joints_below() {
    // Twice as large, then stretched along x by 3, and y grows from 1 to 2 in one second.
    let mut builder = Builder::new(json!([
        {"scale": [2, 2, 2], "translation": [0, 1, 0], "children": [1]},
        {"name": "a", "scale": [3, 1, 1], "rotation": [0, 0, 1, 1], "children": [2]},
        {"name": "b", "translation": [1, 1, 0], "children": [3]},
        {"name": "c", "translation": [1, 1, 0]},
    ]));
    builder.animate(1, "translation", "LINEAR", &[0.0, 1.0], &[0.0, 0.0, 0.0, 0.0, 0.0, 5.0]);
    builder.animate(2, "scale", "LINEAR", &[0.0, 1.0], &[1.0, 1.0, 1.0, 1.0, 2.0, 1.0]);
    let Told { motion, warnings, .. } = builder.load("scales");
    assert!(warnings.iter().any(|warning| warning.contains("the scale of `b` changes")), "{warnings:?}");
    assert_eq!(motion.rig.joints.len(), 3, "what only carries the figure is one joint with it");
    let last = fk::positions(&motion.rig, &motion.values, motion.frames - 1).map_each();
    let first = fk::positions(&motion.rig, &motion.values, 0).map_each();
    assert_eq!(first, [[0, 100, 0], [-200, 700, 0], [-400, 1300, 0]]);
    assert_eq!(last, [[0, 100, 1000], [-200, 700, 1000], [-600, 1300, 1000]]);
    let scale = channel(&motion, "b.scale.y");
    assert_eq!((motion.values[scale][0], motion.values[scale][motion.frames - 1]), (1.0, 2.0));
    let kinds: Vec<Kind> = motion.rig.joints[0].kinds.clone();
    assert_eq!(kinds, [Kind::Zposition, Kind::Zrotation]);
}

/// Whole centimetres.
trait MapEach {
    fn map_each(self) -> Vec<[i32; 3]>;
}

impl MapEach for Vec<[f64; 3]> {
    fn map_each(self) -> Vec<[i32; 3]> {
        let whole = |x: f64| {
            assert!((x - x.round()).abs() < 1e-3, "{x}");
            x.round() as i32
        };
        self.into_iter().map(|place| place.map(whole)).collect()
    }
}

#[test]
fn several_roots_get_one_above_them() {
    let mut builder = Builder::new(json!([{"name": "left"}, {"name": "right"}, {"name": "lamp"}]));
    builder.root["scenes"] = json!([{"nodes": [0, 1, 2]}]);
    builder.animate(0, "translation", "LINEAR", &[0.0, 1.0], &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    builder.animate(1, "translation", "LINEAR", &[0.0, 1.0], &[0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let Told { motion, warnings, units, .. } = builder.load("roots");
    let names: Vec<&str> = motion.rig.joints.iter().map(|joint| joint.name.as_str()).collect();
    assert_eq!(names, ["root", "left", "right"]);
    assert_eq!(units, "units: 100 cm, as the file says");
    assert_eq!(
        warnings,
        ["30 frames a second, as the keys are far apart; --fps overrides", "not used: 1 nodes that nothing moves"]
    );
}

#[test]
fn accessors_may_be_normalized_sparse_and_strided() {
    let mut builder = Builder::new(json!([{"name": "joint"}]));
    builder.animate(0, "rotation", "LINEAR", &[0.0, 0.1], &[0.0; 8]);
    let shorts: Vec<u8> = [0i16, 0, 0, 32767, 23170, 0, 0, 23170].iter().flat_map(|x| x.to_le_bytes()).collect();
    let turns = builder.raw(&shorts, 5122, "VEC4", 2);
    builder.root["accessors"][turns]["normalized"] = json!(true);
    builder.root["animations"][0]["samplers"][0]["output"] = json!(turns);
    // Places: zeros, but for the second, which stands behind a gap of 4 bytes.
    builder.animate(0, "translation", "LINEAR", &[0.0, 0.1], &[0.0; 6]);
    let index = builder.raw(&[1, 0, 0, 0], 5121, "SCALAR", 1);
    let places = builder.floats("VEC3", &[9.0, 7.0, 8.0, 6.0]);
    let view = |builder: &Builder, accessor: usize| builder.root["accessors"][accessor]["bufferView"].clone();
    let (index, values) = (view(&builder, index), view(&builder, places));
    let sparse = builder.push(
        "accessors",
        json!({"componentType": 5126, "count": 2, "type": "VEC3", "sparse": {
            "count": 1, "indices": {"bufferView": index, "componentType": 5121},
            "values": {"bufferView": values, "byteOffset": 4}}}),
    );
    builder.root["animations"][0]["samplers"][1]["output"] = json!(sparse);
    // Times: every other number of a strided view.
    let times = builder.floats("VEC4", &[0.0, 55.0, 0.1, 66.0]);
    let view = view(&builder, times).as_u64().unwrap() as usize;
    builder.root["bufferViews"][view]["byteStride"] = json!(8);
    builder.root["accessors"][times] = json!({"bufferView": view, "componentType": 5126, "count": 2, "type": "SCALAR"});
    builder.root["animations"][0]["samplers"][1]["input"] = json!(times);
    let motion = builder.load("accessors").motion;
    assert_eq!(motion.frames, 2);
    let end = |name: &str| motion.values[channel(&motion, name)][1];
    assert_eq!([end("joint.Xposition"), end("joint.Yposition"), end("joint.Zposition")], [7.0, 8.0, 6.0]);
    assert!((end("joint.Xrotation") - 90.0).abs() < 1e-3);
}

#[test]
fn what_turns_at_the_end_of_a_limb_has_an_end() {
    let mut builder = Builder::new(json!([
        {"name": "arm", "children": [1]}, {"name": "hand", "translation": [0, 0.5, 0], "children": [2]}, {"name": "ball", "mesh": 0},
    ]));
    let turns = [[0.0, 0.0, 0.0, 1.0], [0.6, 0.0, 0.0, 0.8]];
    for node in 0..3 {
        builder.animate(node, "rotation", "LINEAR", &[0.0, 0.1], turns.as_flattened());
    }
    let box_ =
        json!({"componentType": 5126, "count": 8, "type": "VEC3", "min": [-2, -1, 0], "max": [1, 1, 0.5], "bufferView": 0});
    let accessor = builder.push("accessors", box_);
    builder.root["meshes"] = json!([{"primitives": [{"attributes": {"POSITION": accessor}}]}]);
    let ends = |builder: &Builder| {
        let joints = builder.load("ends").motion.rig.joints;
        joints.into_iter().filter(|joint| joint.end_site).map(|joint| (joint.parent, joint.offset)).collect::<Vec<_>>()
    };
    assert_eq!(ends(&builder), [(Some(2), [-2.0, -1.0, 0.5])]);
    builder.root["nodes"][1]["children"] = json!(null);
    assert_eq!(ends(&builder), [(Some(1), [0.0, 0.25, 0.0])], "half as far as the bone before");
}

#[test]
fn an_animation_is_chosen_by_name_or_number() {
    let mut builder = spline();
    builder.root["animations"][0]["name"] = json!("walk");
    let mut other = builder.root["animations"][0].clone();
    other["name"] = json!("face");
    other["channels"].as_array_mut().unwrap().remove(0);
    builder.push("animations", other);
    let text = builder.text();
    let chosen = |wanted: &str| load("chosen", &text, &ImportOptions::new().animation(wanted));
    assert_eq!(chosen("walk").unwrap().motion.rig.channels(), 5);
    for wanted in ["face", "1"] {
        let motion = chosen(wanted).unwrap().motion;
        assert_eq!(motion.rig.channels(), 2);
        assert_eq!(motion.rig.joints.len(), 2, "the figure is the same for all animations of a file");
    }
    let error = format!("{:#}", chosen("run").unwrap_err());
    assert!(error.ends_with("no animation `run`: the file has 0 (walk), 1 (face)"), "{error}");
}

#[test]
fn what_is_exported_comes_back() {
    let motion = spline().load("export").motion;
    let bytes = export::gltf::write(&motion).unwrap();
    let gltf = gltf::Gltf::from_slice(&bytes).unwrap();
    assert_eq!(gltf.animations().next().unwrap().channels().count(), 3);
    let path = std::env::temp_dir().join(format!("pantin-gltf-back-{}.glb", std::process::id()));
    std::fs::write(&path, bytes).unwrap();
    let back = crate::told::load(&path, &ImportOptions::new()).unwrap().motion;
    std::fs::remove_file(&path).unwrap();
    assert_eq!((back.frames, back.frame_time), (motion.frames, motion.frame_time));
    assert_eq!(back.rig.scalars, motion.rig.scalars);
    for channel in 0..motion.rig.channels() {
        assert_eq!(back.rig.channel_name(channel), motion.rig.channel_name(channel));
        let off = motion.values[channel].iter().zip(&back.values[channel]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 2e-7, "{}: {off}", motion.rig.channel_name(channel));
    }
}

#[test]
fn a_buffer_beside_the_file_is_read_and_no_other() {
    let folder = std::env::temp_dir().join(format!("pantin-gltf-beside-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("a.gltf");
    let load = |uri: &str| {
        let mut root: Value = serde_json::from_str(&spline().text()).unwrap();
        root["buffers"][0]["uri"] = json!(uri);
        std::fs::write(&path, root.to_string()).unwrap();
        crate::told::load(&path, &ImportOptions::new()).map_err(|error| format!("{error:#}"))
    };
    std::fs::write(folder.join("the data.bin"), &spline().bytes).unwrap();
    assert_eq!(load("the%20data.bin").unwrap().motion.frames, 61);
    assert!(load("none.bin").unwrap_err().contains("none.bin: "));
    for uri in ["../a.bin", "/etc/hostname", "https://example.org/a.bin"] {
        assert!(load(uri).unwrap_err().contains("expected a data URI or the name of a file beside this one"));
    }
    assert!(load("data:;base64,AAAA").unwrap_err().contains("3 bytes; expected byteLength"));
    assert!(load("data:;base64,?").unwrap_err().contains("no base64"));
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn files_that_are_handed_over_are_all_that_there_is() {
    let mut root: Value = serde_json::from_str(&spline().text()).unwrap();
    root["buffers"][0]["uri"] = json!("data.bin");
    let load = |given: &[(&str, &[u8])]| {
        let files: InMemory = given.iter().map(|(name, bytes)| (*name, bytes.to_vec())).collect();
        crate::told::load_given(&files, "a.gltf").map(|imported| imported.motion.frames).map_err(|error| format!("{error:#}"))
    };
    let (text, data) = (root.to_string(), spline().bytes);
    assert_eq!(load(&[("a.gltf", text.as_bytes()), ("data.bin", &data)]), Ok(61));
    let alone = load(&[("a.gltf", text.as_bytes())]).unwrap_err();
    assert!(alone.ends_with("data.bin: not among the files given"), "{alone}");
    assert_eq!(load(&[]), Err("a.gltf: not among the files given".into()));
}

#[test]
fn what_is_wrong_is_refused_with_its_place() {
    let refused = |name: &str, damage: &dyn Fn(&mut Value), part: &str| {
        let mut root: Value = serde_json::from_str(&spline().text()).unwrap();
        damage(&mut root);
        let error = load(name, &root.to_string(), &ImportOptions::new()).expect_err(name);
        let error = format!("{error:#}");
        assert!(error.contains(&format!("pantin-gltf-{name}")), "{name}: no file in: {error}");
        assert!(error.contains(part), "{name}: no `{part}` in: {error}");
    };
    refused("cycle", &|root| root["nodes"][1]["children"] = json!([0]), "nodes[0]: the node stands below itself");
    refused("root", &|root| root["scenes"][0]["nodes"] = json!([1]), "scenes[0].nodes: node 1 is not the root of a tree");
    refused("loop", &|root| root["nodes"] = json!([{}, {"children": [1]}]), "nodes[1]: the node stands below itself");
    refused("parents", &|root| root["nodes"].as_array_mut().unwrap().push(json!({"children": [1]})), "a child of node 0 already");
    refused("child", &|root| root["nodes"][0]["children"] = json!([9]), "nodes[0].children[0]: ");
    refused("buffer", &|root| root["buffers"][0]["uri"] = Value::Null, "neither a uri nor a binary chunk");
    refused("view", &|root| root["bufferViews"][1]["byteLength"] = json!(1_000_000), "bufferView ends after its buffer");
    refused("count", &|root| root["accessors"][0]["count"] = json!(u64::MAX), "accessors[0]: it ends after its bufferView");
    refused("offset", &|root| root["accessors"][0]["byteOffset"] = json!(u64::MAX), "ends after its bufferView");
    refused(
        "zeros",
        &|root| {
            root["accessors"][0] = json!({"componentType": 5126, "count": 1u64 << 40, "type": "SCALAR",
                "sparse": {"count": 1, "indices": {"bufferView": 0, "componentType": 5121}, "values": {"bufferView": 0}}})
        },
        "at most 1048576",
    );
    refused("empty", &|root| root["accessors"][0]["count"] = json!(0), "no keys; expected one at least");
    refused("type", &|root| root["accessors"][1]["type"] = json!("SCALAR"), "type Scalar; expected Vec3");
    refused("kind", &|root| root["accessors"][1]["componentType"] = json!(7), "accessors[1].componentType");
    refused("few", &|root| root["accessors"][1]["count"] = json!(8), "do not make CubicSpline values for 3 keys");
    refused("sampler", &|root| root["animations"][0]["channels"][0]["sampler"] = json!(5), "animations[0].channels[0].sampler");
    refused(
        "path",
        &|root| root["animations"][0]["channels"][0]["target"]["path"] = json!("colour"),
        "channels[0]: unknown target path",
    );
    refused(
        "node",
        &|root| root["animations"][0]["channels"][1]["target"]["node"] = json!(2),
        "animations[0].channels[1].target.node: no such node",
    );
    refused("joints", &|root| root["skins"] = json!([{"joints": [0, 7]}]), "skins[0].joints[1]: ");
    refused("none", &|root| root["animations"] = json!([]), "no animation");
    refused("place", &|root| root["nodes"][1]["translation"] = json!([0, 1e12, 0]), "nodes[1]: its place");
    refused("mesh", &|root| drop(root["nodes"][1].as_object_mut().unwrap().remove("mesh")), "the node has no mesh");
}

#[test]
fn numbers_that_are_none_and_times_that_go_back_are_refused() {
    let refused = |times: &[f32], value: f32, part: &str| {
        let mut builder = Builder::new(json!([{"name": "joint"}]));
        let values: Vec<f32> = times.iter().flat_map(|_| [0.0, 0.0, value]).collect();
        builder.animate(0, "translation", "LINEAR", times, &values);
        let error = format!("{:#}", load("numbers", &builder.text(), &ImportOptions::new()).unwrap_err());
        assert!(error.contains(part), "no `{part}` in: {error}");
    };
    refused(&[0.0, 0.1], f32::NAN, "accessors[1]: element 0 is NaN");
    refused(&[0.0, 0.1], f32::INFINITY, "accessors[1]: element 0 is inf");
    refused(&[0.0, f32::NAN], 1.0, "accessors[0]: element 1 is NaN");
    refused(&[0.0, 0.2, 0.1], 1.0, "expected later than 0.2");
    refused(&[0.0, 0.0], 1.0, "expected later than 0 s");
    refused(&[0.0, 1e8], 1.0, "too long for a clip");
    refused(&[0.0, 3e5], 1.0, "animations[0]: 9000001 frames are too many for this figure");
    refused(&[0.0, 1e-6], 1.0, "frames a second, more than 1000; --fps takes fewer");
}

#[test]
fn a_track_of_one_key_is_one_frame() {
    let mut builder = Builder::new(json!([{"name": "joint"}]));
    builder.animate(0, "translation", "LINEAR", &[2.5], &[1.0, 2.0, 3.0]);
    let motion = builder.load("one").motion;
    assert_eq!((motion.frames, motion.rig.channels()), (1, 0));
    assert_eq!(motion.rig.joints[0].offset, [1.0, 2.0, 3.0]);
}

#[test]
fn damaged_binaries_never_panic() {
    let bytes = export::gltf::write(&spline().load("damage").motion).unwrap();
    let path: PathBuf = std::env::temp_dir().join(format!("pantin-gltf-damaged-{}.glb", std::process::id()));
    let mut noise = Noise(1);
    let mut below = |count| noise.below(count);
    for round in 0..600 {
        let mut damaged = bytes.clone();
        match round % 3 {
            0 => damaged.truncate(below(bytes.len())),
            // Mostly digits: they are counts, offsets and indices.
            1 => (0..3).for_each(|_| damaged[below(1900)] = b'0' + below(10) as u8),
            _ => (0..4).for_each(|_| damaged[below(bytes.len())] = below(256) as u8),
        }
        std::fs::write(&path, &damaged).unwrap();
        match crate::told::load(&path, &ImportOptions::new()) {
            Ok(read) => assert!(read.motion.values.iter().flatten().all(|value| value.is_finite())),
            Err(error) => assert!(format!("{error:#}").contains("pantin-gltf-damaged"), "{error:#}"),
        }
    }
    std::fs::remove_file(&path).unwrap();
}

#[test]
fn a_clip_expands_to_glb() {
    let motion = spline().load("clip").motion;
    let bounds = Bounds::exact(&motion).unwrap();
    let rig = encode::rig::encode(&motion.rig).unwrap();
    let bytes = encode::clip::encode(&channelwise::fit(&motion, &bounds, &|| ()).unwrap(), &rig, false).unwrap();
    let expanded = expand::expand(&pantin::Clip::new_checked(&bytes).unwrap()).unwrap();
    assert!(gltf::Gltf::from_slice(&export::gltf::write(&expanded).unwrap()).is_ok());
}

/// What stands still below a moving joint moves it, turned or not: its place is in the joint's channels.
#[test]
fn a_still_armature_carries_the_joints_that_move() {
    let turned = [0.0, std::f64::consts::FRAC_1_SQRT_2, 0.0, std::f64::consts::FRAC_1_SQRT_2];
    for (rotation, wanted) in [([0.0, 0.0, 0.0, 1.0], [3.0, 1.25, 0.5]), (turned, [3.5, 1.25, 0.0])] {
        let mut builder = Builder::new(json!([
            {"name": "Armature", "translation": [3, 1, 0], "rotation": rotation, "children": [1]},
            {"name": "hips", "children": [2]}, {"name": "leg", "translation": [0, -1, 0]},
        ]));
        builder.animate(1, "translation", "LINEAR", &[0.0, 1.0], &[0.0, 0.0, 0.0, 0.0, 0.25, 0.5]);
        let imported = builder.load("armature");
        assert!(imported.error_cm < 1e-4, "{} cm", imported.error_cm);
        let motion = imported.motion;
        let hips = motion.rig.joints.iter().position(|joint| joint.name == "hips").unwrap();
        let last = fk::positions(&motion.rig, &motion.values, motion.frames - 1)[hips];
        let wanted = wanted.map(|metres| 100.0 * metres);
        assert!((0..3).all(|axis| (last[axis] - wanted[axis]).abs() < 1e-4), "{last:?}, expected {wanted:?}");
    }
}

#[test]
fn events_stand_in_the_extras_of_an_animation() {
    let mut builder = spline();
    builder.root["animations"][0]["extras"] = json!({
        "events": [{"time": 1.0, "name": "step"}, {"time": 0.5, "name": "clap"}, {"time": 9.0, "name": "late"}, {"name": "never"}, 7],
        "markers": [{"time": 2.0, "name": "end"}],
    });
    let imported = builder.load("events");
    let left_out = |warning: &String| {
        warning == "1 of the animation's events are left out; of the first: a time of 9 s, outside the animation"
    };
    assert!(imported.warnings.iter().any(left_out), "{:?}", imported.warnings);
    let motion = imported.motion;
    let found = |motion: &Motion| motion.events.iter().map(|event| (event.frame, event.name.clone())).collect::<Vec<_>>();
    assert_eq!(found(&motion), [(15, "clap".into()), (30, "step".into()), (60, "end".into())]);
    let path = std::env::temp_dir().join(format!("pantin-gltf-events-back-{}.glb", std::process::id()));
    std::fs::write(&path, export::gltf::write(&motion).unwrap()).unwrap();
    assert_eq!(found(&crate::told::load(&path, &ImportOptions::new()).unwrap().motion), found(&motion));
    std::fs::remove_file(&path).unwrap();
}

#[test]
fn a_mesh_whose_points_are_missing_is_refused() {
    let text = json!({
        "asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 3}}]}],
        "animations": [{"samplers": [], "channels": []}],
    });
    let error = format!("{:#}", load("points", &text.to_string(), &ImportOptions::new()).unwrap_err());
    assert!(error.contains("meshes[0]: no such accessor"), "{error}");
}

#[test]
fn versions_and_required_extensions_that_are_not_read_are_refused_by_name() {
    let with = |change: &dyn Fn(&mut Value)| {
        let mut builder = spline();
        change(&mut builder.root);
        load("versions", &builder.text(), &ImportOptions::new()).map_err(|error| format!("{error:#}"))
    };
    for (version, least, wanted) in [
        ("1.0", None, Some("asset.version is `1.0`")),
        ("3.0", None, Some("asset.version is `3.0`")),
        ("two", None, Some("asset.version is `two`")),
        ("2.1", Some("2.1"), Some("asset.minVersion is `2.1`")),
        ("2.1", Some("x"), Some("asset.minVersion is `x`")),
        ("2.0", None, None),
        ("2.1", None, None),
        ("2.1", Some("2.0"), None),
    ] {
        let read = with(&|root| {
            root["asset"]["version"] = json!(version);
            least.into_iter().for_each(|least| root["asset"]["minVersion"] = json!(least));
        });
        match wanted {
            Some(wanted) => {
                let said = read.err().unwrap_or_else(|| panic!("{version} {least:?} is read"));
                assert!(said.contains(wanted) && said.contains("glTF 2.0 is read"), "{said}");
            }
            None => drop(read.unwrap()),
        }
    }
    for (name, is_read) in [
        ("KHR_materials_unlit", true),
        ("KHR_texture_transform", true),
        ("KHR_mesh_quantization", true),
        ("KHR_draco_mesh_compression", true),
        ("EXT_meshopt_compression", false),
        ("KHR_meshopt_compression", false),
        ("KHR_animation_pointer", false),
        ("ACME_limbs", false),
    ] {
        let read = with(&|root| {
            root["extensionsRequired"] = json!(["KHR_materials_unlit", name]);
            root["extensionsUsed"] = json!(["KHR_materials_unlit", name]);
        });
        assert_eq!(read.is_ok(), is_read, "{name}");
        assert!(read.err().is_none_or(|said| said.contains(&format!("extensionsRequired: `{name}`"))), "{name}");
    }
    // A mesh whose points are in an extension's own bytes is no mesh of points at zero.
    let mut builder = spline();
    builder.root["accessors"].as_array_mut().unwrap().push(json!({"componentType": 5126, "count": 3, "type": "VEC3"}));
    let points = builder.root["accessors"].as_array().unwrap().len() - 1;
    builder.root["meshes"] = json!([{"primitives": [{"attributes": {"POSITION": points}}]}]);
    builder.root["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
    // Its motion does not need them.
    assert_eq!(builder.load("draco").motion.values, spline().load("plain").motion.values);
    let folder = tempfile::TempDir::new().unwrap();
    let path = folder.path().join("draco.gltf");
    std::fs::write(&path, builder.text()).unwrap();
    let said = format!("{:#}", outside::mesh(&path, &Disk::default()).err().unwrap());
    assert!(said.contains("part 0 of the mesh is compressed (KHR_draco_mesh_compression)"), "{said}");
}

#[test]
fn bytes_behind_a_binary_are_left_out_with_a_warning() {
    let motion = spline().load("behind").motion;
    let mut bytes = export::gltf::write(&motion).unwrap();
    let length = bytes.len();
    let folder = tempfile::TempDir::new().unwrap();
    let path = folder.path().join("behind.glb");
    let mut warnings = vec![];
    for behind in [&b""[..], b"more"] {
        bytes.extend(behind);
        std::fs::write(&path, &bytes).unwrap();
        let read = crate::told::load(&path, &ImportOptions::new()).unwrap();
        assert_eq!(read.motion, crate::told::load(&path, &ImportOptions::new()).unwrap().motion);
        warnings.push(read.warnings.iter().filter(|warning| warning.contains("left out") && warning.contains("head")).count());
    }
    assert_eq!(warnings, [0, 1]);
    let read = crate::told::load(&path, &ImportOptions::new()).unwrap();
    assert!(read.warnings[0].contains(&format!("4 bytes stand after the {length}")), "{:?}", read.warnings);
}
