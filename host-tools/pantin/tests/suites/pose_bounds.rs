//! Bounds on shells and rotations hold for every coding, and what moves no joint is kept.
//!
//! Errors are measured by forward kinematics of this file alone: by quaternions, not by the matrices of the library.

use super::outputs::{Folder, err};
use crate::noise::Noise;
use crate::real::files;
use pantin_convert::encode::{clip, rig};
use pantin_convert::expand::expand;
use pantin_convert::fit::fit;
use pantin_convert::fit::rotation_coding::{Rotations, quaternions};
use pantin_convert::fit::{descent::Plan, level::Level};
use pantin_convert::import::ImportOptions;
use pantin_convert::motion::{Joint, Kind, Motion, Rig};
use pantin_convert::pose_bound::PoseBound;
use serde_json::Value;

/// w, x, y, z.
type Quaternion = [f64; 4];

fn times(a: Quaternion, b: Quaternion) -> Quaternion {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]
}

fn inverse([w, x, y, z]: Quaternion) -> Quaternion {
    [w, -x, -y, -z]
}

fn turned(q: Quaternion, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let [_, x, y, z] = times(times(q, [0.0, x, y, z]), inverse(q));
    [x, y, z]
}

fn angle_deg(a: Quaternion, b: Quaternion) -> f64 {
    let [w, x, y, z] = times(inverse(a), b);
    2.0 * (x * x + y * y + z * z).sqrt().atan2(w.abs()).to_degrees()
}

/// A joint's rotation in its parent and in the world, and its place in cm.
struct Pose {
    local: Quaternion,
    world: Quaternion,
    place: [f64; 3],
}

fn poses(motion: &Motion, frame: usize) -> Vec<Pose> {
    let mut channel = 0;
    let mut poses: Vec<Pose> = Vec::new();
    for joint in &motion.rig.joints {
        let mut offset = joint.offset;
        let mut local = [1.0, 0.0, 0.0, 0.0];
        let (mut vector, mut components) = ([0.0; 3], [0.0; 4]);
        for kind in &joint.kinds {
            let value = motion.values[channel][frame];
            channel += 1;
            let axis = kind.axis().unwrap_or(0);
            if kind.is_position() {
                offset[axis] = value;
            } else if kind.is_rotation() {
                let half = value.to_radians() / 2.0;
                let mut turn = [half.cos(), 0.0, 0.0, 0.0];
                turn[axis + 1] = half.sin();
                local = times(local, turn);
            } else if kind.is_exponential() {
                vector[axis] = value.to_radians();
            } else {
                components[if *kind == Kind::Wquaternion { 0 } else { axis + 1 }] = value;
            }
        }
        let angle = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
        if angle > 0.0 {
            let part = (angle / 2.0).sin() / angle;
            local = times(local, [(angle / 2.0).cos(), vector[0] * part, vector[1] * part, vector[2] * part]);
        }
        let length = components.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length > 0.0 {
            local = times(local, components.map(|x| x / length));
        }
        let offset = offset.map(|x| x * motion.rig.cm_per_unit);
        let (world, place) = match joint.parent.map(|parent| &poses[parent]) {
            None => (local, offset),
            Some(above) => {
                let way = turned(above.world, offset);
                (times(above.world, local), std::array::from_fn(|axis| above.place[axis] + way[axis]))
            }
        };
        poses.push(Pose { local, world, place });
    }
    poses
}

/// Greatest errors: of places and of shells in cm, of rotations in the world and in the parent in degrees.
#[derive(Debug, Default)]
struct Errors {
    place: f64,
    shell: f64,
    world: f64,
    local: f64,
}

fn errors(source: &Motion, decoded: &Motion, shell_cm: f64) -> Errors {
    let mut worst = Errors::default();
    for frame in 0..source.frames {
        for ((joint, a), b) in source.rig.joints.iter().zip(poses(source, frame)).zip(poses(decoded, frame)) {
            let point = |pose: &Pose, offset: [f64; 3]| {
                let way = turned(pose.world, offset);
                [0, 1, 2].map(|axis| pose.place[axis] + way[axis])
            };
            let far = |offset: [f64; 3]| {
                let (p, q) = (point(&a, offset), point(&b, offset));
                (0..3).map(|axis| (p[axis] - q[axis]).powi(2)).sum::<f64>().sqrt()
            };
            let place = far([0.0; 3]);
            worst.place = worst.place.max(place);
            worst.shell = worst.shell.max(place);
            if joint.end_site {
                continue;
            }
            for axis in 0..3 {
                let mut offset = [0.0; 3];
                offset[axis] = shell_cm;
                worst.shell = worst.shell.max(far(offset));
            }
            worst.world = worst.world.max(angle_deg(a.world, b.world));
            worst.local = worst.local.max(angle_deg(a.local, b.local));
        }
    }
    worst
}

/// A figure of chains with joints of one to three rotations, leaves with and without End Sites, and joints at their parent's place.
fn random_motion(seed: u64) -> Motion {
    let mut noise = Noise(seed);
    let orders = [
        vec![Kind::Zrotation, Kind::Xrotation, Kind::Yrotation],
        vec![Kind::Xrotation, Kind::Yrotation, Kind::Zrotation],
        vec![Kind::Yrotation],
        vec![Kind::Xrotation, Kind::Zrotation],
    ];
    let mut rig = Rig { cm_per_unit: 0.5 + (seed % 3) as f64, ..Rig::default() };
    for index in 0..7usize {
        let parent = index.checked_sub(1 + (noise.signed() > 0.3 && index > 1) as usize);
        let length = if index == 3 { 0.0 } else { 20.0 };
        let mut kinds = orders[(seed as usize + index) % orders.len()].clone();
        if parent.is_none() {
            kinds.splice(0..0, [Kind::Xposition, Kind::Yposition, Kind::Zposition]);
        }
        let offset = [noise.signed() * length, noise.signed() * length, noise.signed() * length];
        rig.joints.push(Joint { name: format!("j{index}"), parent, offset, kinds, end_site: false, helper: false });
    }
    for (parent, offset) in [(6, [0.0, 9.0, 0.0]), (5, [0.0; 3])] {
        rig.joints.push(Joint {
            name: String::new(),
            parent: Some(parent),
            offset,
            kinds: vec![],
            end_site: true,
            helper: false,
        });
    }
    let frames = 24;
    let mut wave = |kind: Kind| {
        let size = if kind.is_position() { 30.0 } else { 70.0 };
        let [a, b, c, d] = [(); 4].map(|()| noise.signed());
        (0..frames).map(|t| size * ((0.3 * a * t as f64 + 3.0 * b).sin() + 0.3 * (0.9 * t as f64 + c).sin() * d)).collect()
    };
    let values: Vec<Vec<f64>> = rig.channel_kinds().into_iter().map(|(_, kind)| wave(kind)).collect();
    let keys = vec![None; values.len()];
    Motion { rig, frame_time: 1.0 / 30.0, frames, values, keys, looped: false, events: vec![], origin: Default::default() }
}

/// What a device plays of `motion`, converted within `bound`.
fn decoded(motion: &Motion, bound: PoseBound, rotations: Rotations) -> Motion {
    // The default effort, which takes longer, on some.
    let level = if motion.rig.cm_per_unit == 0.5 { Level::DEFAULT } else { Level::FAST };
    let plan = Plan { rotations, ..level.plan(bound) };
    let coded = fit(motion, plan, 0.02, &mut |_| ()).unwrap_or_else(|error| panic!("{bound:?} {rotations:?}: {error:#}"));
    let bytes = clip::encode(&coded, &rig::encode(&motion.rig).unwrap(), false).unwrap();
    expand(&pantin::Clip::new_checked(&bytes).unwrap()).unwrap()
}

#[test]
fn no_bound_is_broken_on_random_figures_in_any_coding() {
    for seed in 0..9 {
        let source = random_motion(seed);
        for rotations in [Rotations::Euler, Rotations::Exponential, Rotations::Quaternion] {
            let motion = if rotations == Rotations::Quaternion { quaternions(&source) } else { source.clone() };
            let shell_cm = [3.0, 0.6, 8.0][seed as usize % 3];
            let shell = PoseBound::shell([0.5, 0.1, 2.0][seed as usize % 3], shell_cm);
            for bound in [
                shell,
                PoseBound { max_rotation_deg: Some(4.0), ..shell },
                PoseBound { max_joint_deg: Some(1.5), ..shell },
                PoseBound { max_rotation_deg: Some(0.5), max_joint_deg: Some(0.4), ..shell },
                PoseBound { max_rotation_deg: Some(2.0), max_joint_deg: Some(3.0), ..PoseBound::places(2.0) },
            ] {
                let found = errors(&source, &decoded(&motion, bound, rotations), shell_cm);
                let distance = if bound.shell_cm().is_some() { found.shell } else { found.place };
                let kept = distance <= bound.max_cm
                    && found.world <= bound.max_rotation_deg.unwrap_or(180.0)
                    && found.local <= bound.max_joint_deg.unwrap_or(180.0);
                assert!(kept, "seed {seed}, {rotations:?}, {bound:?}: {found:?}");
            }
        }
    }
}

/// A head that yaws by 60 degrees below an End Site straight above it.
fn head_shake() -> String {
    let head = "JOINT head { OFFSET 0 80 0 CHANNELS 3 Zrotation Xrotation Yrotation End Site { OFFSET 0 40 0 } }";
    let mut text = format!("HIERARCHY ROOT hips {{ OFFSET 0 90 0 CHANNELS 3 Zrotation Xrotation Yrotation {head} }} MOTION\n");
    text += "Frames: 41\nFrame Time: 0.0333333\n";
    for frame in 0..41 {
        text += &format!("0 0 0 0 0 {:.4}\n", 60.0 * (f64::from(frame) * 0.3).sin());
    }
    text
}

fn report(output: &std::process::Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap()
}

fn load(folder: &Folder, name: &str) -> Motion {
    let options = ImportOptions::new().cm_per_unit(1.0);
    crate::told::load(&folder.path(name), &options).unwrap().motion
}

fn played(folder: &Folder, name: &str) -> Motion {
    expand(&pantin::Clip::new_checked(&folder.get(name)).unwrap()).unwrap()
}

#[test]
fn a_head_shake_survives_the_defaults() {
    let folder = Folder::new();
    folder.put("shake.bvh", head_shake());
    let convert = ["convert", "shake.bvh", "--cm-per-unit", "1", "--json", "-o"];
    let told = report(&folder.done(&[&convert[..], &["shake.ptn"]].concat()));
    let found = errors(&load(&folder, "shake.bvh"), &played(&folder, "shake.ptn"), 3.0);
    assert!(found.place < 1e-6 && found.shell <= 0.5 && found.world < 9.6, "{found:?}");
    for (name, measured) in
        [("max_shell_cm", found.shell), ("max_rotation_deg", found.world), ("max_joint_rotation_deg", found.local)]
    {
        assert!((told[name].as_f64().unwrap() - measured).abs() < 1e-6, "{name}: {told}");
    }
    for joint in ["worst_shell_joint", "worst_rotation_joint", "worst_joint_rotation_joint"] {
        assert_eq!(told[joint], "head", "{joint}: {told}");
    }
    // The angle can be bounded itself.
    folder.done(&[&convert[..], &["fine.ptn", "--max-rotation-error", "0.5"]].concat());
    assert!(errors(&load(&folder, "shake.bvh"), &played(&folder, "fine.ptn"), 3.0).world <= 0.5);
    // Without a shell the head stands still, and that is said.
    let output = folder.done(&["convert", "shake.bvh", "--cm-per-unit", "1", "--places-only", "-o", "still.ptn"]);
    let said = err(&output);
    assert!(said.contains("--places-only") && said.contains("head.Yrotation"), "{said}");
    assert!(said.contains("rotation error max") && said.contains("(head at frame"), "{said}");
}

#[test]
fn a_spinning_bone_that_moves_nothing_is_kept() {
    let Some(path) = files(&["fbx"]).into_iter().find(|path| path.to_string_lossy().contains("sausage-3stacks")) else { return };
    let folder = Folder::new();
    let path = path.to_str().unwrap();
    let told = report(&folder.done(&["convert", path, "--animation", "Skeleton|Spin", "--json", "-o", "spin.ptn"]));
    let clip = played(&folder, "spin.ptn");
    let turn = |frame: usize| poses(&clip, frame).into_iter().map(|pose| pose.world).collect::<Vec<_>>();
    let first = turn(0);
    let most =
        (0..clip.frames).flat_map(|frame| turn(frame).into_iter().zip(&first).map(|(a, b)| angle_deg(a, *b)).collect::<Vec<_>>());
    assert!(most.fold(0.0, f64::max) > 90.0, "the clip is still: {told}");
    assert!(told["max_shell_cm"].as_f64().unwrap() <= 0.5, "{told}");
}

#[test]
fn a_loop_is_compared_with_its_source() {
    let folder = Folder::new();
    let mut text = head_shake();
    // Its last frame is 8 degrees from its first one, all of it in the head's yaw.
    let last = text.trim_end().rfind('\n').unwrap();
    text.replace_range(last.., "\n0 0 0 0 0 8\n");
    folder.put("nod.bvh", &text);
    let convert = ["convert", "nod.bvh", "--cm-per-unit", "1", "--loop", "--json", "-o", "nod.ptn"];
    let told = report(&folder.done(&convert));
    let mut source = load(&folder, "nod.bvh");
    source.frames -= 1;
    let found = errors(&source, &played(&folder, "nod.ptn"), 3.0);
    assert!(found.shell <= 0.5, "{found:?}");
    assert!((told["max_shell_cm"].as_f64().unwrap() - found.shell).abs() < 1e-6, "{told} {found:?}");
    // Half of the seam at either end: 4 degrees of 3 cm.
    let moved = told["seam_moved_cm"].as_f64().unwrap();
    assert!((moved - 6.0 * 2f64.to_radians().sin()).abs() < 1e-3, "{told}");
    assert!((told["seam_turned_deg"].as_f64().unwrap() - 4.0).abs() < 1e-3, "{told}");
    let refused = folder.refused(&[&convert[..], &["--max-rotation-error", "5"]].concat());
    assert!(refused.contains("turns by 8.000 degrees") && refused.contains("the bound is 5"), "{refused}");
    let refused = folder.refused(&[&convert[..], &["--max-error", "0.3cm"]].concat());
    assert!(refused.contains("head is 0.419 cm off"), "{refused}");
}

#[test]
fn helper_bones_are_not_bounded() {
    let mut motion = random_motion(3);
    let helper = motion.rig.joints.iter().rposition(|joint| !joint.end_site).unwrap();
    motion.rig.joints[helper].helper = true;
    let bound = PoseBound { max_rotation_deg: Some(1.0), ..PoseBound::shell(0.1, 3.0) };
    let clip = decoded(&motion, bound, Rotations::Euler);
    // The helper stays at rest, and what is left of the figure keeps its bounds.
    let channels = motion.rig.first_channels()[helper]..;
    let still = clip.values[channels].iter().take(motion.rig.joints[helper].kinds.len());
    assert!(still.flatten().all(|value| *value == 0.0));
    assert!(errors(&motion, &clip, 3.0).world > 1.0);
    let report = pantin_convert::verify::compare(&motion, &clip, 3.0).unwrap();
    assert!(report.check(&bound).is_ok() && report.shell_cm.error > 0.0, "{report:?}");
}

#[test]
fn bounds_that_mean_nothing_are_refused() {
    let folder = Folder::new();
    folder.put("shake.bvh", head_shake());
    // Wrong usage: 2, where a conversion that fails gives 1.
    let misused = |arguments: &[&str]| {
        let output = folder.run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", err(&output));
        err(&output)
    };
    for option in ["--max-rotation-error", "--max-joint-error"] {
        for (value, what) in [("0", "above 0"), ("-1", ""), ("nan", "above 0"), ("181", "at most 180"), ("1e-9", "steps of")] {
            let said = misused(&["convert", "shake.bvh", "-o", "x.ptn", &format!("{option}={value}")]);
            assert!(said.contains(option) && said.contains(what), "{option} {value}: {said}");
        }
        let said = misused(&["convert", "shake.bvh", "-o", "x.ptn", "--max-channel-error", "1", option, "1"]);
        assert!(said.contains("cannot be used with"), "{said}");
    }
    for value in ["0", "-1cm", "nan", "0%"] {
        let said = misused(&["convert", "shake.bvh", "-o", "x.ptn", &format!("--shell={value}")]);
        assert!(said.contains("--shell") && said.contains("above 0"), "{said}");
    }
    let said = misused(&["convert", "shake.bvh", "-o", "x.ptn", "--shell", "3cm", "--places-only"]);
    assert!(said.contains("cannot be used with"), "{said}");
    folder.put("light.csv", "time,light\n0,0\n0.1,1\n0.2,0\n");
    for option in [&["--shell", "3cm"][..], &["--places-only"], &["--max-rotation-error", "2"], &["--max-joint-error", "2"]] {
        let said = err(&folder.done(&[&["convert", "light.csv", "-o", "light.ptn"][..], option].concat()));
        assert!(said.contains(&format!("{} has no effect: the motion has no joints", option[0])), "{said}");
    }
    assert!(!folder.path("x.ptn").exists());
}
