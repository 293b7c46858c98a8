//! What other programs must read of ours, and joints whose rotation a bound on places would not see.

use super::outputs::{Folder, err};
use pantin_convert::import::ImportOptions;
use serde_json::{Value, json};

/// A figure whose arm turns by 60 degrees about one axis and ends without an End Site.
const LEAF: &str = "HIERARCHY
ROOT hip
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT arm
  {
    OFFSET 0 40 0
    CHANNELS 1 Xrotation
  }
}
MOTION
Frames: 4
Frame Time: 0.0333333
0 90 0 0 0 0 0
0 90 0 0 0 0 20
0 90 0 0 0 0 40
0 90 0 0 0 0 60
";

#[test]
fn a_leaf_without_an_end_site_gets_one() {
    let folder = Folder::new();
    folder.put("leaf.bvh", LEAF);
    let loaded = crate::told::load(&folder.path("leaf.bvh"), &ImportOptions::new()).unwrap();
    let site = loaded.motion.rig.joints.last().unwrap();
    assert!(site.end_site && site.parent == Some(1) && site.offset == [0.0, 40.0, 0.0], "{site:?}");
    assert_eq!(loaded.warnings.iter().filter(|warning| warning.contains("End Site")).count(), 1, "{:?}", loaded.warnings);
    folder.done(&["convert", "leaf.bvh", "-o", "leaf.ptn", "--cm-per-unit", "1"]);
    folder.done(&["expand", "leaf.ptn", "-o", "back.bvh"]);
    let back = crate::told::load(&folder.path("back.bvh"), &ImportOptions::new()).unwrap().motion;
    let arm = back.rig.joints.iter().position(|joint| joint.name == "arm").unwrap();
    let turned = &back.values[back.rig.first_channels()[arm]];
    // Half a cm at 40 cm is 0.7 degrees.
    for (frame, &angle) in turned.iter().enumerate() {
        assert!((angle - 20.0 * frame as f64).abs() < 1.0, "frame {frame}: {angle}");
    }
    // An End Site of length 0 says that turning does not count.
    folder.put("zero.bvh", LEAF.replace("CHANNELS 1 Xrotation", "CHANNELS 1 Xrotation End Site { OFFSET 0 0 0 }"));
    let loaded = crate::told::load(&folder.path("zero.bvh"), &ImportOptions::new()).unwrap();
    assert_eq!(loaded.motion.rig.joints.len(), 3);
    assert!(loaded.warnings.iter().all(|warning| !warning.contains("End Site")), "{:?}", loaded.warnings);
}

#[test]
fn exported_bvh_has_three_rotations_a_joint() {
    let folder = Folder::new();
    folder.put("leaf.bvh", LEAF);
    folder.done(&["convert", "leaf.bvh", "-o", "leaf.ptn"]);
    folder.done(&["expand", "leaf.ptn", "-o", "back.bvh"]);
    let text = String::from_utf8(folder.get("back.bvh")).unwrap();
    let lines: Vec<&str> = text.lines().filter(|line| line.trim_start().starts_with("CHANNELS")).collect();
    assert!(lines.len() == 2 && lines.iter().all(|line| line.matches("rotation").count() == 3), "{lines:?}");
}

#[test]
fn joints_with_quaternions_become_bvh_and_tables() {
    let folder = Folder::new();
    let (head, _) = LEAF.split_once("0 90").unwrap();
    let rows: Vec<String> = (0..4).map(|frame| format!("0 90 0 0 0 0 {} 0 0\n", 20 * frame)).collect();
    folder.put("leaf.bvh", head.replace("1 Xrotation", "3 Xrotation Yrotation Zrotation") + &rows.concat());
    let options = ["--rotations", "quaternion", "--max-joint-error", "0.1", "--cm-per-unit", "1"];
    folder.done(&[&["convert", "leaf.bvh", "-o", "leaf.ptn"][..], &options].concat());
    folder.done(&["expand", "leaf.ptn", "-o", "back.bvh"]);
    let back = crate::told::load(&folder.path("back.bvh"), &ImportOptions::new()).unwrap().motion;
    let first = back.rig.first_channels()[back.rig.joints.iter().position(|joint| joint.name == "arm").unwrap()];
    for frame in 0..4 {
        // The rig has lost the order of the angles: z, x, y.
        let [z, x, y] = [0, 1, 2].map(|slot| back.values[first + slot][frame]);
        assert!(z.abs() < 0.2 && (x - 20.0 * frame as f64).abs() < 0.2 && y.abs() < 0.2, "frame {frame}: {z} {x} {y}");
    }
    // The hip rests.
    folder.done(&["expand", "leaf.ptn", "-o", "leaf.csv"]);
    let table = String::from_utf8(folder.get("leaf.csv")).unwrap();
    let columns: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let real = columns.iter().position(|name| *name == "hip.Wquaternion").unwrap();
    for row in table.lines().skip(1) {
        assert_eq!(row.split(',').skip(real).take(4).collect::<Vec<_>>(), ["1", "0", "0", "0"]);
    }
}

#[test]
fn joints_that_bvh_cannot_name_are_said_and_stay_apart() {
    let folder = Folder::new();
    let joints =
        "joint {a} offset 0 1 0 channels Xrotation\njoint _a_ parent {a} offset 0 1 0\njoint a}} parent {a} offset 1 0 0\n";
    folder.put("names.keys", format!("keyframes 1\nfps 30\nframes 2\n{joints}keys linear {{a}}.Xrotation\n 0 0\n 1 9\n"));
    folder.done(&["convert", "names.keys", "-o", "names.ptn"]);
    let said = err(&folder.done(&["expand", "names.ptn", "-o", "names.bvh"]));
    assert!(said.contains("`{a}` is called `_a__2`") && said.contains("`a}}` is called `a__`"), "{said}");
    let text = String::from_utf8(folder.get("names.bvh")).unwrap();
    for joint in ["ROOT _a__2\n", "JOINT _a_\n", "JOINT a__\n"] {
        assert!(text.contains(joint), "{text}");
    }
}

fn json_of(bytes: &[u8]) -> Value {
    serde_json::from_slice(&gltf::Glb::from_slice(bytes).unwrap().json).unwrap()
}

#[test]
fn exported_glb_has_a_skin_and_a_named_animation() {
    let folder = Folder::new();
    folder.put("leaf.bvh", LEAF);
    folder.done(&["convert", "leaf.bvh", "-o", "leaf.ptn"]);
    folder.done(&["expand", "leaf.ptn", "-o", "leaf.glb"]);
    let root = json_of(&folder.get("leaf.glb"));
    assert_eq!(root["skins"][0]["joints"], json!([0, 1, 2]));
    assert!(root["animations"][0]["name"].as_str().is_some_and(|name| !name.is_empty()));
    gltf::Gltf::from_slice(&folder.get("leaf.glb")).unwrap();
}

#[test]
fn a_clip_without_joints_is_no_bvh_and_says_so() {
    let folder = Folder::new();
    folder.put("a.csv", "time,a\n0,0\n0.1,1\n");
    folder.done(&["convert", "a.csv", "-o", "a.ptn"]);
    assert!(folder.refused(&["expand", "a.ptn", "-o", "a.bvh"]).contains("BVH"));
    let empty = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/vectors/empty.ptn");
    let said = folder.refused(&["expand", empty.to_str().unwrap(), "-o", "a.bvh"]);
    assert!(said.contains("BVH"), "{said}");
}

#[test]
fn a_table_with_equal_names_can_be_read_again() {
    let folder = Folder::new();
    let twins = LEAF.replace("JOINT arm", "JOINT hip");
    folder.put("twins.bvh", twins.replace("CHANNELS 1 Xrotation", "CHANNELS 1 Xrotation JOINT time { OFFSET 0 1 0 CHANNELS 0 }"));
    folder.done(&["convert", "twins.bvh", "-o", "twins.ptn"]);
    folder.done(&["expand", "twins.ptn", "-o", "twins.csv"]);
    let done = folder.done(&["convert", "twins.csv", "-o", "again.ptn"]);
    assert!(err(&done).contains("7 channels"), "{}", err(&done));
}

/// Two joints that a skin names and nothing moves, and a mesh whose weight changes.
fn skin_at_rest() -> String {
    let floats = |numbers: &[f32]| numbers.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    let bytes = floats(&[0.0, 0.5, 1.0, 0.0, 1.0, 0.0]);
    use base64::Engine as _;
    let data = base64::engine::general_purpose::STANDARD.encode(&bytes);
    json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 2]}],
        "nodes": [{"name": "a", "children": [1]}, {"name": "b", "translation": [0, 1, 0]}, {"name": "face", "mesh": 0}],
        "skins": [{"joints": [0, 1]}],
        "meshes": [{"primitives": [{"attributes": {}, "targets": [{}]}], "extras": {"targetNames": ["smile"]}}],
        "buffers": [{"byteLength": bytes.len(), "uri": format!("data:application/octet-stream;base64,{data}")}],
        "bufferViews": [{"buffer": 0, "byteLength": bytes.len()}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "SCALAR", "min": [0], "max": [1]},
            {"bufferView": 0, "byteOffset": 12, "componentType": 5126, "count": 3, "type": "SCALAR"},
        ],
        "animations": [
            {"name": "Smile", "samplers": [{"input": 0, "output": 1}],
             "channels": [{"sampler": 0, "target": {"node": 2, "path": "weights"}}]},
            {"name": "Other", "samplers": [{"input": 0, "output": 1}],
             "channels": [{"sampler": 0, "target": {"node": 2, "path": "weights"}}]},
        ],
    })
    .to_string()
}

#[test]
fn a_skin_that_nothing_moves_keeps_its_bones() {
    let folder = Folder::new();
    folder.put("skin.gltf", skin_at_rest());
    let motion = crate::told::load(&folder.path("skin.gltf"), &ImportOptions::new()).unwrap().motion;
    let joints: Vec<&str> = motion.rig.joints.iter().map(|joint| joint.name.as_str()).collect();
    assert_eq!(joints, ["a", "b"]);
    folder.done(&["convert", "skin.gltf", "-o", "skin.ptn"]);
    folder.done(&["render", "skin.ptn", "-o", "skin.png", "--frame", "0"]);
}

#[test]
fn an_animation_is_named_where_it_is_chosen_and_ignores_case() {
    let folder = Folder::new();
    folder.put("skin.gltf", skin_at_rest());
    let said = err(&folder.done(&["convert", "skin.gltf", "-o", "skin.ptn"]));
    assert!(said.contains("Smile") && said.contains("--animation"), "{said}");
    let said = err(&folder.done(&["convert", "skin.gltf", "-o", "skin.ptn", "--animation", "oTHER"]));
    assert!(!said.contains("--animation"), "{said}");
}

#[test]
fn a_motion_is_shown_without_a_clip_and_other_commands_name_the_way_to_one() {
    let folder = Folder::new();
    folder.put("leaf.bvh", LEAF);
    folder.done(&["render", "leaf.bvh", "-o", "leaf.png"]);
    let shown = folder.done(&["play", "leaf.bvh", "--plain", "--frames", "1"]);
    assert!(!shown.stdout.is_empty());
    // Options that nobody gave are not named.
    folder
        .put("mouth.keys", "keyframes 1\nfps 30\nframes 4\n\nscalar viseme_aa scale 1\n\nkeys linear viseme_aa\n  0 0\n  3 1\n");
    let said = folder.done(&["render", "mouth.keys", "-o", "mouth.png"]).stderr;
    assert!(!String::from_utf8_lossy(&said).contains("--places-only"), "{}", String::from_utf8_lossy(&said));
    let said = folder.refused(&["info", "leaf.bvh"]);
    assert!(said.contains("a motion, not a clip") && said.contains("pantin convert leaf.bvh -o leaf.ptn"), "{said}");
    folder.done(&["convert", "leaf.bvh", "--rig-out", "leaf.rig"]);
    let said = folder.refused(&["info", "leaf.ptn"]);
    assert!(said.contains("--rig"), "{said}");
    folder.done(&["info", "leaf.ptn", "--rig", "leaf.rig"]);
    let listed = folder.done(&["convert", "--list", "leaf.bvh"]);
    assert!(String::from_utf8_lossy(&listed.stdout).contains("4 frames"), "{listed:?}");
}

#[test]
fn moments_are_frames_or_seconds() {
    let folder = Folder::new();
    folder.put("leaf.bvh", LEAF);
    folder.done(&["convert", "leaf.bvh", "-o", "frames.ptn", "--from", "1", "--to", "3"]);
    folder.done(&["convert", "leaf.bvh", "-o", "seconds.ptn", "--from", "0.033s", "--to", "0.1s"]);
    assert!(folder.get("frames.ptn") == folder.get("seconds.ptn"));
}

#[test]
fn completions_and_manual_pages_are_printed() {
    let folder = Folder::new();
    for shell in ["bash", "zsh", "fish"] {
        assert!(String::from_utf8_lossy(&folder.done(&["completions", shell]).stdout).contains("convert"), "{shell}");
    }
    assert!(String::from_utf8_lossy(&folder.done(&["man"]).stdout).contains(".TH"));
    assert!(String::from_utf8_lossy(&folder.done(&["man", "convert"]).stdout).contains("max\\-error"));
}

#[test]
fn rotations_that_move_nothing_are_bounded() {
    let folder = Folder::new();
    folder.put("zero.bvh", LEAF.replace("CHANNELS 1 Xrotation", "CHANNELS 1 Xrotation End Site { OFFSET 0 0 0 }"));
    let said = err(&folder.done(&["convert", "zero.bvh", "-o", "zero.ptn"]));
    assert!(said.contains("rotation error max") && said.contains("degrees (arm"), "{said}");
    folder.done(&["convert", "zero.bvh", "-o", "bound.ptn", "--max-rotation-error", "0.01"]);
    let said = err(&folder.done(&["convert", "zero.bvh", "-o", "places.ptn", "--places-only"]));
    assert!(
        said.contains("rotations that hardly move a joint are constant in the clip: arm.Xrotation; without --places-only"),
        "{said}"
    );
}

/// The file of [`skin_at_rest`] with its animations called so.
fn animations(names: [&str; 2]) -> String {
    let mut root: Value = serde_json::from_str(&skin_at_rest()).unwrap();
    names.iter().enumerate().for_each(|(index, name)| root["animations"][index]["name"] = json!(name));
    root.to_string()
}

#[test]
fn every_animation_of_a_file_becomes_a_clip() {
    let folder = Folder::new();
    folder.put("fox.gltf", animations(["Walk", "../a b\u{1b}\u{202e}"]));
    let all = ["convert", "fox.gltf", "--animation", "all"];
    folder.done(&all);
    folder.done(&[&all[..], &["-o", "pet.ptn"]].concat());
    folder.done(&[&all[..], &["-o", "clips"]].concat());
    folder.done(&["convert", "fox.gltf", "--animation", "walk", "-o", "one.ptn"]);
    let one = folder.get("one.ptn");
    for name in ["fox-Walk.ptn", "pet-Walk.ptn", "clips/Walk.ptn", "fox-_a b _.ptn", "clips/_a b _.ptn"] {
        assert!(folder.get(name) == one, "{name}");
    }
    let report = folder.done(&[&all[..], &["-o", "clips", "--json", "-q"]].concat());
    let report: Value = serde_json::from_slice(&report.stdout).unwrap();
    assert!(report["files"].as_array().unwrap().len() == 2 && report["files"][1]["animation"] == "1", "{report}");
    let before = folder.names();
    for names in [["a/b", "a:b"], ["Walk", "walk"], ["Walk", "Walk"]] {
        folder.put("fox.gltf", animations(names));
        let said = folder.refused(&[&all[..], &["-o", "met"]].concat());
        assert!(said.contains("animation 0 and animation 1: both would be written to"), "{said}");
    }
    assert_eq!(folder.names(), before);
    folder.put("fox.gltf", animations(["", "con"]));
    folder.done(&[&all[..], &["-o", "odd"]].concat());
    assert!(folder.path("odd/0.ptn").exists() && folder.path("odd/con_.ptn").exists());
}

/// A world of two joints that nothing moves, and two clocks: one drives a number, the other a joint.
pub const WORLD: &str = "#VRML V2.0 utf8
PROTO Humanoid [ exposedField SFFloat smile 0 ] { Transform { } }
DEF Face Humanoid { }
DEF Hip HAnimJoint { name \"hip\" children [ DEF Arm HAnimJoint { name \"arm\" center 0 1 0 translation 0 1 0 children [ DEF Hand HAnimJoint { name \"hand\" translation 0 2 0 } ] } ] }
DEF Smile TimeSensor { cycleInterval 1 }
DEF Mouth ScalarInterpolator { key [ 0 1 ] keyValue [ 0 1 ] }
ROUTE Smile.fraction_changed TO Mouth.set_fraction
ROUTE Mouth.value_changed TO Face.set_smile
DEF Wave TimeSensor { cycleInterval 2 }
DEF Turn OrientationInterpolator { key [ 0 1 ] keyValue [ 0 0 1 0, 0 0 1 1 ] }
ROUTE Wave.fraction_changed TO Turn.set_fraction
ROUTE Turn.value_changed TO Arm.set_rotation
";

#[test]
fn a_worlds_joints_are_drawn_even_where_a_clock_moves_none() {
    let folder = Folder::new();
    folder.put("world.wrl", WORLD);
    folder.done(&["convert", "world.wrl", "--animation", "all", "-o", "clips"]);
    for name in ["Smile", "Wave"] {
        let info = folder.done(&["info", &format!("clips/{name}.ptn"), "--json"]);
        let info: Value = serde_json::from_slice(&info.stdout).unwrap();
        let joints: Vec<&str> =
            info["rig"]["joints"].as_array().unwrap().iter().filter_map(|joint| joint["name"].as_str()).collect();
        assert!(["Hip", "Arm", "Hand"].iter().all(|joint| joints.contains(joint)), "{name}: {joints:?}");
        assert!(info["figure_joints"].as_u64() >= Some(3), "{name}: {info}");
        folder.done(&["render", &format!("clips/{name}.ptn"), "-o", &format!("{name}.png"), "--frame", "0"]);
    }
    folder.done(&["convert", "world.wrl", "--animation", "sMILE", "-o", "smile.ptn"]);
    assert!(folder.get("smile.ptn") == folder.get("clips/Smile.ptn"));
}

/// Every exported .glb is glTF that holds together: the `gltf` crate's validation, and ranges that it does not look at.
#[test]
fn exported_glb_files_hold_together() {
    let folder = Folder::new();
    let motions = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions");
    for name in ["walk", "greet", "kneebend", "face/joy"] {
        let clip = motions.join(name).with_extension("ptn");
        folder.done(&["expand", clip.to_str().unwrap(), "-o", "a.glb"]);
        let bytes = folder.get("a.glb");
        let gltf = gltf::Gltf::from_slice(&bytes).unwrap();
        let length = gltf.blob.as_ref().unwrap().len();
        assert_eq!(gltf.buffers().map(|buffer| buffer.length()).collect::<Vec<_>>(), [length], "{name}");
        for accessor in gltf.accessors() {
            let view = accessor.view().unwrap();
            assert!(view.offset() + view.length() <= length && view.offset() % 4 == 0, "{name}");
            assert!(accessor.offset() + accessor.count() * accessor.size() <= view.length(), "{name}");
        }
        let nodes = gltf.nodes().count();
        for skin in gltf.skins() {
            assert!(skin.joints().all(|joint| joint.index() < nodes), "{name}");
        }
        for animation in gltf.animations() {
            assert!(animation.name().is_some(), "{name}");
            for channel in animation.channels() {
                let (input, output) = (channel.sampler().input(), channel.sampler().output());
                let weights = channel.target().node().mesh().and_then(|mesh| mesh.weights()).map_or(1, <[f32]>::len);
                let weighted = matches!(channel.target().property(), gltf::animation::Property::MorphTargetWeights);
                let each = if weighted { weights } else { 1 };
                assert_eq!(input.count() * each, output.count(), "{name}");
                assert!(input.min().is_some() && input.max().is_some(), "{name}");
            }
        }
        // What we write is read by our own importer too.
        crate::told::load(&folder.path("a.glb"), &ImportOptions::new()).unwrap();
    }
}
