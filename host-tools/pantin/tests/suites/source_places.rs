//! Bounds are kept against the places that the file's own transforms have, not only against what the importer made of them.

use crate::gltf_input::Builder;
use crate::gltf_real_files::{buffers, tracks, worlds};
use crate::real::files;
use pantin_convert::motion::Motion;
use pantin_convert::{expand, fk};
use serde_json::json;
use std::path::Path;
use std::process::Command;

/// What the command makes of a file within `bound_cm`.
pub fn converted(path: &Path, bound_cm: f64) -> Motion {
    converted_by(path, bound_cm, &[])
}

fn converted_by(path: &Path, bound_cm: f64, options: &[&str]) -> Motion {
    let folder = tempfile::tempdir().unwrap();
    let clip = folder.path().join("clip.ptn");
    let output = Command::new(env!("CARGO_BIN_EXE_pantin"))
        .args(["convert", "--effort", "fast", "--max-error", &format!("{bound_cm}cm"), "-o"])
        .args([&clip, path])
        .args(options)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}: {}", path.display(), String::from_utf8_lossy(&output.stderr));
    let bytes = std::fs::read(clip).unwrap();
    expand::expand(&pantin::Clip::new_checked(&bytes).unwrap()).unwrap()
}

/// The greatest distance in cm of a joint of `motion` from its node in an animation of a glTF file, evaluated here.
fn far(path: &Path, animation: usize, motion: &Motion) -> f64 {
    let gltf = gltf::Gltf::open(path).unwrap();
    let buffers = buffers(path, &gltf.document, gltf.blob.clone());
    let (tracks, first) = tracks(&gltf.document, &buffers, animation);
    let mut worst = 0f64;
    for frame in 0..motion.frames {
        // A clip's frame time has whole nanoseconds, the file's does not.
        let frame_time = 1.0 / (1.0 / motion.frame_time * 1e4).round() * 1e4;
        let expected = worlds(&gltf.document, &tracks, first + frame as f64 * frame_time, frame_time);
        let places = fk::positions(&motion.rig, &motion.values, frame);
        for (joint, found) in motion.rig.joints.iter().zip(places) {
            if let Some(world) = expected.get(&joint.name) {
                worst = worst.max(fk::distance(found, world.map(|row| row[3] * motion.rig.cm_per_unit)));
            }
        }
    }
    worst
}

/// A creature of eight joints, `size` metres of limb each. It moves by as little as would pass for rounding in a figure of its size: its root far from the
/// middle of the world, its joints about a second axis, its scales, most of which are nearly 1.
fn creature(size: f32) -> Builder {
    let node = |joint: usize| {
        let scale = [1.000004, 0.999_997, 1.0 + 1e-6 * joint as f64];
        let place = if joint == 0 { json!([0, 0, 0]) } else { json!([0.1 * size, size, 0]) };
        let children: Vec<usize> = (joint + 1..8).take(1).collect();
        let node = json!({"name": format!("joint{joint}"), "scale": scale, "translation": place, "children": children});
        if children.is_empty() { json!({"name": "joint7", "scale": scale, "translation": place}) } else { node }
    };
    let mut builder = Builder::new((0..8).map(node).collect());
    let times: Vec<f32> = (0..40).map(|frame| frame as f32 / 30.0).collect();
    let wave = |frame: usize, speed: f32| (frame as f32 * speed).sin();
    for joint in 0..8 {
        let turn = |frame: usize| {
            let (x, y) = (0.2 * wave(frame, 0.1 + 0.02 * joint as f32), 6e-7 * wave(frame, 0.3));
            [x, y, 0.0, (1.0 - x * x - y * y).sqrt()]
        };
        let turns: Vec<[f32; 4]> = (0..40).map(turn).collect();
        builder.animate(joint, "rotation", "LINEAR", &times, turns.as_flattened());
    }
    let places: Vec<[f32; 3]> =
        (0..40).map(|frame| [0.0, size * wave(frame, 0.1), size * (30.0 + 2.5e-4 * wave(frame, 0.2))]).collect();
    builder.animate(0, "translation", "LINEAR", &times, places.as_flattened());
    let bones: Vec<[f32; 3]> = (0..40).map(|frame| [0.1 * size, size * (1.0 + 9e-6 * wave(frame, 0.2)), 0.0]).collect();
    builder.animate(3, "translation", "LINEAR", &times, bones.as_flattened());
    let scales: Vec<[f32; 3]> = (0..40).map(|frame| [1.0, 1.0 + 9e-6 * wave(frame, 0.15), 1.0]).collect();
    builder.animate(2, "scale", "LINEAR", &times, scales.as_flattened());
    builder
}

#[test]
fn a_gltf_creature_of_any_size_keeps_its_bound_against_the_file() {
    let folder = tempfile::tempdir().unwrap();
    for size in [0.01, 1.0, 400.0] {
        let path = folder.path().join("creature.gltf");
        std::fs::write(&path, creature(size).text()).unwrap();
        // In parts of a limb, which is the hundredth of a cm for a small figure, and centimetres for a large one.
        for part in [1e-4, 1e-2] {
            let bound = part * 100.0 * f64::from(size);
            let worst = far(&path, 0, &converted(&path, bound));
            println!("{size} m: {worst} of {bound} cm");
            assert!(worst <= bound, "{size} m: {worst} cm, the bound is {bound}");
        }
    }
}

#[test]
fn quaternions_keep_the_bound_against_the_file_too() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("creature.gltf");
    std::fs::write(&path, creature(1.0).text()).unwrap();
    let back = converted_by(&path, 0.5, &["--rotations", "quaternion"]);
    assert!(back.rig.joints[1].kinds.iter().all(|kind| !kind.is_exponential()));
    assert!(far(&path, 0, &back) <= 0.5);
}

#[test]
fn clips_of_others_keep_their_bound_against_the_file() {
    for path in files(&["glb", "gltf"]) {
        let count = pantin_convert::import::list(
            &pantin_convert::import::Disk::default(),
            &path,
            &pantin_convert::import::ImportOptions::new(),
        )
        .unwrap()
        .len();
        for animation in 0..count.min(2) {
            let number = animation.to_string();
            let back = converted_by(&path, 0.02, &["--animation", &number]);
            if back.rig.joints.is_empty() {
                continue;
            }
            let worst = far(&path, animation, &back);
            println!("{} {animation}: {worst} of 0.02 cm", path.display());
            assert!(worst <= 0.02, "{} {animation}: {worst} cm", path.display());
        }
    }
}
