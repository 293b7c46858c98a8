//! CMU's AMC clips, where they are at hand, against Acclaim's own rule written out a second time here.

use crate::told::Told;
use pantin_convert::fk;
use pantin_convert::import::ImportOptions;
use pantin_convert::import::units::rest_height_cm;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

const INCH_CM: f64 = 2.54;

/// Clip, skeleton and frames.
const CLIPS: [(&str, &str, usize); 4] = [
    ("amc_cmu_backflip", "amc_cmu_backflip", 247),
    ("amc_cmu_charleston1", "amc_cmu_charleston", 506),
    ("amc_cmu_charleston2", "amc_cmu_charleston", 546),
    ("amc_cmu_lambada", "amc_cmu_lambada", 2180),
];

fn folder() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let folder = std::env::var_os("PANTIN_DATA").map_or(beside, PathBuf::from);
    if !folder.join("amc_cmu_backflip.amc").exists() {
        println!("skipped: no AMC clips at {}; PANTIN_DATA names their folder", folder.display());
        return None;
    }
    Some(folder)
}

fn clips() -> impl Iterator<Item = (&'static str, PathBuf, usize, Told)> {
    folder().into_iter().flat_map(|folder| {
        CLIPS.map(|(name, skeleton, frames)| {
            let read = crate::told::load(&folder.join(format!("{name}.amc")), &ImportOptions::new());
            let read = read.unwrap_or_else(|error| panic!("{error:#}"));
            (name, folder.join(format!("{skeleton}.asf")), frames, read)
        })
    })
}

#[test]
fn people_stand_on_the_ground() {
    for (name, _, frames, Told { motion, units, warnings, .. }) in clips() {
        assert_eq!(motion.frames, frames, "{name}");
        assert!((motion.rig.cm_per_unit - 5.6444).abs() < 1e-4, "{name}: {units}");
        assert!(warnings.iter().any(|warning| warning.contains("120 a second")), "{name}: {warnings:?}");
        assert_eq!(motion.frame_time, 1.0 / 120.0);
        let height = rest_height_cm(&motion);
        let low = |frame| fk::positions(&motion.rig, &motion.values, frame).iter().map(|place| place[1]).fold(f64::MAX, f64::min);
        let lows: Vec<f64> = (0..frames).map(low).collect();
        let lowest = lows.iter().copied().fold(f64::MAX, f64::min);
        println!("{name}: {height:.1} cm from head to foot, lowest point {lowest:.1} cm");
        assert!((140.0..200.0).contains(&height), "{name}: {height} cm high");
        assert!(lowest.abs() <= 10.0, "{name}: lowest point at {lowest} cm");
    }
}

/// All values but those of bones whose axes are skew to the world's come through as they are in the file, up to sign and turns.
#[test]
fn values_are_kept() {
    for (name, _, _, Told { motion, .. }) in clips() {
        let kept =
            ["root", "lowerback", "upperback", "thorax", "lowerneck", "upperneck", "head", "lclavicle", "lwrist", "rfingers"];
        let text = std::fs::read_to_string(folder().unwrap().join(format!("{name}.amc"))).unwrap();
        let firsts = motion.rig.first_channels();
        for bone in kept {
            let joint = motion.rig.joints.iter().position(|joint| joint.name == bone).unwrap();
            let rows = text.lines().filter_map(|line| line.strip_prefix(bone)?.strip_prefix(' '));
            for (frame, row) in rows.enumerate() {
                let values = row.split_whitespace().map(|word| word.parse::<f64>().unwrap());
                let mut expected: Vec<f64> = values.map(f64::abs).collect();
                let channels = firsts[joint]..firsts[joint] + motion.rig.joints[joint].kinds.len();
                for channel in channels {
                    let value = motion.values[channel][frame];
                    let same = |other: &f64| [-360.0, 0.0, 360.0].iter().any(|turn| ((value + turn).abs() - other).abs() < 1e-12);
                    let place = expected.iter().position(same);
                    expected.remove(place.unwrap_or_else(|| panic!("{name}: {bone} frame {frame}: {value} not in {row}")));
                }
                assert!(expected.is_empty(), "{name}: {bone} frame {frame}: {expected:?} lost of {row}");
            }
        }
    }
}

#[test]
fn joints_stand_where_acclaim_puts_them() {
    for (name, skeleton, frames, Told { motion, .. }) in clips() {
        let asf = std::fs::read_to_string(skeleton).unwrap();
        let amc = std::fs::read_to_string(folder().unwrap().join(format!("{name}.amc"))).unwrap();
        let mut worst: f64 = 0.0;
        for (frame, expected) in acclaim(&asf, &amc).iter().enumerate() {
            let places = fk::positions(&motion.rig, &motion.values, frame);
            for (joint, place) in motion.rig.joints.iter().zip(&places) {
                let owner = if joint.end_site {
                    joint.parent.unwrap()
                } else {
                    motion.rig.joints.iter().position(|j| j == joint).unwrap()
                };
                let (start, end) = expected[&motion.rig.joints[owner].name];
                let other = if joint.end_site { end } else { start };
                let far = (0..3).map(|axis| (place[axis] - other[axis] * INCH_CM / 0.45).abs()).fold(0.0, f64::max);
                worst = worst.max(far);
            }
        }
        println!("{name}: {frames} frames, at most {worst:.2e} cm apart");
        assert!(worst < 1e-9, "{name}: {worst} cm");
    }
}

/// A quaternion w, x, y, z.
type Turn = [f64; 4];

fn times(a: Turn, b: Turn) -> Turn {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]
}

fn conjugate(a: Turn) -> Turn {
    [a[0], -a[1], -a[2], -a[3]]
}

/// Turns about fixed axes in the order of `letters`.
fn turn(letters: &str, degrees: &[f64]) -> Turn {
    letters.bytes().zip(degrees).fold([1.0, 0.0, 0.0, 0.0], |turned, (letter, angle)| {
        let (s, c) = (angle.to_radians() / 2.0).sin_cos();
        let mut next = [c, 0.0, 0.0, 0.0];
        next[usize::from(letter - b'x') + 1] = s;
        times(next, turned)
    })
}

/// Vector, axes and letters of the rotations.
type Bone = ([f64; 3], Turn, String);
/// Start and end of every bone.
type Ends = HashMap<String, ([f64; 3], [f64; 3])>;

fn floats(words: &[&str]) -> Vec<f64> {
    words.iter().map_while(|word| word.parse().ok()).collect()
}

fn bones(asf: &str) -> HashMap<&str, Bone> {
    let mut bones: HashMap<&str, Bone> = HashMap::new();
    let (mut name, mut direction, mut length) = ("", vec![], 0.0);
    for line in asf.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words.first() {
            Some(&"name") => name = words[1],
            Some(&"direction") => direction = floats(&words[1..]),
            Some(&"length") if !direction.is_empty() => length = floats(&words[1..])[0],
            Some(&"axis") if !direction.is_empty() => {
                let vector = std::array::from_fn(|axis| direction[axis] * length);
                bones.insert(name, (vector, turn("xyz", &floats(&words[1..])), String::new()));
            }
            Some(&"dof") => bones.get_mut(name).unwrap().2 = words[1..].iter().map(|word| &word[1..]).collect(),
            _ => {}
        }
    }
    bones
}

/// The bones' ends at every frame, in the file's units, of files laid out as CMU's are.
fn acclaim(asf: &str, amc: &str) -> Vec<Ends> {
    let (bone_data, hierarchy) = asf.split_once(":hierarchy").unwrap();
    let bones = bones(bone_data);
    let lines = hierarchy.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
    let parents: Vec<(&str, &str)> =
        lines.flat_map(|words| words.iter().skip(1).map(|child| (*child, words[0])).collect::<Vec<_>>()).collect();
    let (_, rows) = amc.split_once(":DEGREES").unwrap();
    let lines: Vec<&str> = rows.lines().collect();
    let frame = |block: &[&str]| {
        let rows = block.iter().filter_map(|line| line.split_once(' '));
        let values: HashMap<&str, Vec<f64>> =
            rows.map(|(name, row)| (name, floats(&row.split_whitespace().collect::<Vec<_>>()))).collect();
        let root = &values["root"];
        let place = [root[0], root[1], root[2]];
        let mut world = HashMap::from([("root", turn("xyz", &root[3..]))]);
        let mut ends = HashMap::from([("root".to_string(), (place, place))]);
        for (bone, parent) in &parents {
            let (vector, axes, letters) = &bones[bone];
            let own = values.get(bone).map_or([1.0, 0.0, 0.0, 0.0], |values| turn(letters, values));
            let turned = times(world[parent], times(times(*axes, own), conjugate(*axes)));
            let [_, x, y, z] = times(times(turned, [0.0, vector[0], vector[1], vector[2]]), conjugate(turned));
            let start = ends[*parent].1;
            world.insert(bone, turned);
            ends.insert(bone.to_string(), (start, [start[0] + x, start[1] + y, start[2] + z]));
        }
        ends
    };
    lines.split(|line| line.trim().parse::<usize>().is_ok()).skip(1).map(frame).collect()
}
