//! `pantin face fit` on moving faces: a folder of .obj files, and a glTF whose animation weights morph targets.

use pantin_convert::import;
use pantin_convert::motion::Motion;
use pantin_pictures::face::{Face, export, pose};
use std::f64::consts::PI;
use std::path::Path;
use std::process::Command;

/// Frames a second of the sequences.
const FPS: f64 = 25.0;
/// The most weights a frame.
const MOST: usize = 5;

/// Fits, and returns what is printed, and the weights.
fn fitted(arguments: &[&str], keys: &Path) -> (String, Motion) {
    let most = MOST.to_string();
    let out = Command::new(env!("CARGO_BIN_EXE_pantin"))
        .args(["face", "fit", "--most", &most, "-o"])
        .arg(keys)
        .args(arguments)
        .output()
        .unwrap();
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    let motion = crate::told::load(keys, &import::ImportOptions::new()).unwrap().motion;
    (String::from_utf8(out.stdout).unwrap(), motion)
}

/// The weight of a unit's side at a frame; 0 if it is not in the clip.
fn weight(motion: &Motion, name: &str, frame: usize) -> f64 {
    let unsided = name.trim_end_matches("_left").trim_end_matches("_right");
    let scalar = motion.rig.scalars.iter().position(|scalar| scalar.name == name || scalar.name == unsided);
    scalar.map_or(0.0, |scalar| motion.values[scalar][frame])
}

/// The printed number of weights and the residual in mm of each frame.
fn rows(printed: &str) -> Vec<(usize, f64)> {
    let mut lines = printed.lines();
    assert!(lines.next().unwrap().starts_with("frame  weights  residual"), "{printed}");
    let row = |line: &str| {
        let words: Vec<&str> = line.split_whitespace().collect();
        (words[1].parse().unwrap(), words[2].parse().unwrap())
    };
    lines.map(row).collect()
}

#[test]
fn a_folder_of_poses_becomes_a_track_of_few_weights() {
    let poses: [&[(&str, f64)]; 5] = [
        &[],
        &[("smile", 0.6)],
        &[("smile", 0.6), ("lid_left", 1.0)],
        &[("open_mouth", 0.5), ("brow_outer_raise", 0.8)],
        &[("lower_corners_right", 0.7), ("puff_cheeks", 0.4)],
    ];
    let face = Face::new().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let meshes = folder.path().join("poses");
    std::fs::create_dir(&meshes).unwrap();
    for (frame, pose) in poses.iter().enumerate() {
        let sum: Vec<String> = pose.iter().map(|(name, weight)| format!("{name}={weight}")).collect();
        let pairs = pose::parse(&face.blueprint, &sum.join(",")).unwrap();
        std::fs::write(meshes.join(format!("{frame:03}.obj")), export::obj(&face, &pairs).unwrap()).unwrap();
    }
    let (printed, motion) = fitted(&["--fps", "25", meshes.to_str().unwrap()], &folder.path().join("poses.keys"));
    assert_eq!(motion.frames, poses.len());
    assert!((motion.frame_time * FPS - 1.0).abs() < 1e-6);
    let rows = rows(&printed);
    assert_eq!(rows.len(), poses.len(), "{printed}");
    for (frame, (pose, &(weights, residual))) in poses.iter().zip(&rows).enumerate() {
        assert!(weights <= MOST && weights <= pose.len() + 1, "frame {frame} has {weights} weights: {printed}");
        assert!(residual < 0.06, "frame {frame}: {residual} mm are left");
        for name in ["smile", "lid", "open_mouth", "brow_outer_raise", "lower_corners", "puff_cheeks"] {
            for side in ["left", "right"] {
                let sided = format!("{name}_{side}");
                let wanted = pose.iter().find(|entry| entry.0 == name || entry.0 == sided).map_or(0.0, |entry| entry.1);
                let found = weight(&motion, &sided, frame);
                assert!((found - wanted).abs() < 0.05, "frame {frame}: {sided} is found {found}, not {wanted}");
            }
        }
    }
    assert!(motion.rig.scalars.len() <= 9, "{} channels", motion.rig.scalars.len());
}

/// Weights of morph targets in an animation: those of each frame by name.
type Frames<'a> = [&'a [(&'a str, f32)]];

/// The exported face, with an animation of its morph targets.
fn animated(face: &Face, frames: &Frames) -> Vec<u8> {
    let bytes = export::glb(face, &pose::parse(&face.blueprint, "").unwrap()).unwrap();
    let glb = gltf::Glb::from_slice(&bytes).unwrap();
    let mut root: serde_json::Value = serde_json::from_slice(&glb.json).unwrap();
    let mut data = glb.bin.unwrap().into_owned();
    let names: Vec<String> = serde_json::from_value(root["meshes"][0]["extras"]["targetNames"].clone()).unwrap();
    let times: Vec<f32> = (0..frames.len()).map(|frame| frame as f32 / FPS as f32).collect();
    let weights = frames
        .iter()
        .flat_map(|frame| names.iter().map(|name| frame.iter().find(|entry| entry.0 == name).map_or(0.0, |entry| entry.1)));
    let mut accessors = Vec::new();
    for values in [times.clone(), weights.collect()] {
        let view = serde_json::json!({"buffer": 0, "byteOffset": data.len(), "byteLength": 4 * values.len()});
        data.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        let views = root["bufferViews"].as_array_mut().unwrap();
        views.push(view);
        let mut accessor =
            serde_json::json!({"bufferView": views.len() - 1, "componentType": 5126, "count": values.len(), "type": "SCALAR"});
        if accessors.is_empty() {
            accessor["min"] = serde_json::json!([0.0]);
            accessor["max"] = serde_json::json!([times[times.len() - 1]]);
        }
        let list = root["accessors"].as_array_mut().unwrap();
        list.push(accessor);
        accessors.push(list.len() - 1);
    }
    root["buffers"][0]["byteLength"] = data.len().into();
    root["animations"] = serde_json::json!([{
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}],
        "samplers": [{"input": accessors[0], "output": accessors[1], "interpolation": "LINEAR"}],
    }]);
    let json = serde_json::to_vec(&root).unwrap();
    gltf::Glb { header: glb.header, json: json.into(), bin: Some(data.into()) }.to_vec().unwrap()
}

#[test]
fn animated_morph_targets_of_a_gltf_become_a_track_of_few_weights() {
    let face = Face::new().unwrap();
    let frames: &Frames = &[
        &[],
        &[("smile_left", 0.5), ("smile_right", 0.5)],
        &[("smile_left", 1.0), ("smile_right", 0.0), ("brow_outer_raise_left", 0.6), ("brow_outer_raise_right", 0.6)],
        &[("open_mouth", 1.0)],
        &[("pucker", 0.7)],
    ];
    let folder = tempfile::tempdir().unwrap();
    let (mesh, points) = (folder.path().join("talk.glb"), folder.path().join("own.points"));
    std::fs::write(&mesh, animated(&face, frames)).unwrap();
    let lines: String = face.head.features().map(|(name, index)| format!("{name} {index}\n")).collect();
    std::fs::write(&points, lines).unwrap();
    let arguments = ["--points", points.to_str().unwrap(), mesh.to_str().unwrap()];
    let (printed, motion) = fitted(&arguments, &folder.path().join("talk.keys"));
    assert_eq!(motion.frames, frames.len());
    let rows = rows(&printed);
    for (frame, (wanted, &(weights, residual))) in frames.iter().zip(&rows).enumerate() {
        assert!(weights <= MOST, "frame {frame} has {weights} weights: {printed}");
        assert!(residual < 0.3, "frame {frame}: {residual} mm are left");
        for name in ["smile_left", "smile_right", "brow_outer_raise_left", "brow_outer_raise_right", "open_mouth", "pucker"] {
            let part = f64::from(wanted.iter().find(|entry| entry.0 == name).map_or(0.0, |entry| entry.1));
            // A morph target moves in proportion to its weight; the unit reaches the same place at the weight that its interpolation says.
            let part = match name {
                "open_mouth" => part,
                "pucker" => (1.0 - 2.0 * part).acos() / PI,
                _ => part.asin() * 2.0 / PI,
            };
            let found = weight(&motion, name, frame);
            assert!((found - part).abs() < 0.08, "frame {frame}: {name} is found {found}, not {part}\n{printed}");
        }
    }
}
