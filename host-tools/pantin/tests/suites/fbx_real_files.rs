//! FBX files of others, where they are at hand: places against another evaluation by ufbx, in the files' own axes and units, and
//! conversion within a bound.

use crate::real::probe::probed;
use crate::real::{SAME, converts, distance, files, height};
use pantin_convert::fk;
use pantin_convert::import::{self, Disk, ImportOptions};
use pantin_convert::motion::Motion;
use std::collections::HashMap;
use std::path::PathBuf;
use ufbx::CoordinateAxis;

/// Every animation of every file.
fn motions() -> Vec<(PathBuf, usize, Motion)> {
    let of_file = |path: PathBuf| {
        let count = import::list(&Disk::default(), &path, &ImportOptions::new()).unwrap().len();
        (0..count).map(move |animation| {
            let options = ImportOptions::new().animation(animation.to_string());
            let motion = crate::told::load(&path, &options).unwrap_or_else(|error| panic!("{error:#}")).motion;
            (path.clone(), animation, motion)
        })
    };
    files(&["fbx"]).into_iter().flat_map(of_file).collect()
}

/// The part of `v` along an axis of the file.
fn along(axis: CoordinateAxis, v: [f64; 3]) -> f64 {
    match axis {
        CoordinateAxis::PositiveX => v[0],
        CoordinateAxis::NegativeX => -v[0],
        CoordinateAxis::PositiveY => v[1],
        CoordinateAxis::NegativeY => -v[1],
        CoordinateAxis::PositiveZ => v[2],
        CoordinateAxis::NegativeZ => -v[2],
        CoordinateAxis::Unknown => panic!("the file has no such axis"),
    }
}

/// -1 for a node that mirrors: a joint turns like its opposite then, as no rotation mirrors.
fn mirrored(m: &ufbx::Matrix) -> f64 {
    let across = [m.m10 * m.m21 - m.m20 * m.m11, m.m20 * m.m01 - m.m00 * m.m21, m.m00 * m.m11 - m.m10 * m.m01];
    (across[0] * m.m02 + across[1] * m.m12 + across[2] * m.m22).signum()
}

#[test]
fn joints_stand_and_turn_as_ufbx_has_them() {
    for (path, animation, motion) in motions() {
        let name = format!("{} {animation}", path.display());
        let scene = ufbx::load_file(path.to_str().unwrap(), ufbx::LoadOpts::default()).unwrap();
        let axes = &scene.settings.axes;
        let turned = |v: [f64; 3]| [axes.right, axes.up, axes.front].map(|axis| along(axis, v));
        let cm = 100.0 * scene.settings.unit_meters;
        let stack = &scene.anim_stacks[animation];
        let height = height(&motion);
        let probed = probed(&motion, height);
        let by_name: HashMap<&str, usize> =
            scene.nodes.iter().enumerate().map(|(index, node)| (&*node.element.name, index)).collect();
        let count = motion.rig.joints.len();
        let mut worst = 0f64;
        let mut compared = 0;
        for frame in 0..motion.frames {
            let time = stack.time_begin + frame as f64 * motion.frame_time;
            let now = ufbx::evaluate_scene(&scene, &stack.anim, time, ufbx::EvaluateOpts::default()).unwrap();
            let places = fk::positions(&probed.rig, &probed.values, frame);
            for (index, joint) in motion.rig.joints.iter().enumerate().filter(|(_, joint)| !joint.end_site) {
                let Some(&node) = by_name.get(joint.name.as_str()) else {
                    assert_eq!(index, 0, "{name}: no node {}", joint.name);
                    continue;
                };
                let m = &now.nodes[node].node_to_world;
                let place = turned([m.m03, m.m13, m.m23]).map(|x| x * cm);
                worst = worst.max(distance(places[index], place) / height);
                compared += 1;
                for (axis, column) in [[m.m00, m.m10, m.m20], [m.m01, m.m11, m.m21]].into_iter().enumerate() {
                    let length = distance(column, [0.0; 3]) * mirrored(m);
                    let column = turned(column);
                    let probe = std::array::from_fn(|i| place[i] + column[i] / length * height);
                    worst = worst.max(distance(places[count + 2 * index + axis], probe) / height);
                }
            }
        }
        println!("{name}: {compared} places off by at most {worst:.1e} of the height");
        assert!(compared > 0 || !motion.rig.scalars.is_empty(), "{name}");
        assert!(worst < SAME, "{name}: {worst}");
    }
}

#[test]
fn weights_are_those_of_ufbx() {
    for (path, animation, motion) in motions() {
        let scene = ufbx::load_file(path.to_str().unwrap(), ufbx::LoadOpts::default()).unwrap();
        let stack = &scene.anim_stacks[animation];
        for (index, scalar) in motion.rig.scalars.iter().enumerate() {
            let channel = scene.blend_channels.iter().find(|channel| *channel.element.name == scalar.name).unwrap();
            for (frame, value) in motion.values[motion.rig.joint_channels() + index].iter().enumerate() {
                let time = stack.time_begin + frame as f64 * motion.frame_time;
                let expected = ufbx::evaluate_blend_weight(&stack.anim, channel, time);
                assert!((value - expected).abs() < 1e-9, "{}: {} at {frame}", path.display(), scalar.name);
            }
        }
    }
}

#[test]
fn files_convert_and_expand_within_the_bound() {
    for (path, animation, motion) in motions() {
        converts(&format!("{} {animation}", path.display()), &motion);
    }
}
