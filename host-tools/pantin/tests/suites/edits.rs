//! Changes of a motion before the fit: what they keep, and what they refuse.

use crate::told::{load, said};
use pantin_convert::Memory;
use pantin_convert::edit::loop_seam::{Most, close};
use pantin_convert::edit::{cut::cut, mirror::mirror, pick::pick, resample, retarget};
use pantin_convert::fk::positions;
use pantin_convert::import::ImportOptions;
use pantin_convert::keys::{sample, sample_pieces};
use pantin_convert::motion::{Interpolation, Joint, Keys, Kind, Motion, Rig, Scalar};
use pantin_convert::pose_bound::PoseBound;
use std::path::{Path, PathBuf};

fn resample(motion: &Motion, fps: f64) -> anyhow::Result<Motion> {
    resample::resample(motion, fps, Memory::default())
}

fn own(name: &str) -> Motion {
    load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions").join(name), &ImportOptions::new()).unwrap().motion
}

/// The captured clips whose names begin and end so, or none where they are not at hand.
fn captured(begin: &str, ending: &str) -> Vec<PathBuf> {
    let given = std::env::var_os("PANTIN_DATA").map(PathBuf::from);
    let folder = given.unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"));
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("skipped: no captured clips in {}; set PANTIN_DATA", folder.display());
        return Vec::new();
    };
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.retain(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with(begin) && name.ends_with(ending)
    });
    paths.sort();
    paths
}

fn channel(motion: &Motion, name: &str) -> usize {
    (0..motion.rig.channels()).find(|&index| motion.rig.channel_name(index) == name).unwrap()
}

fn globs(text: &str) -> Vec<String> {
    text.split(',').filter(|part| !part.is_empty()).map(String::from).collect()
}

/// A sway of two arms on a root that goes forward: `frames` frames, by sines of a period of 24 frames.
fn arms(frames: usize) -> Motion {
    let joint = |name: &str, parent: Option<usize>, offset: [f64; 3], kinds: &[Kind], end_site: bool| Joint {
        name: name.into(),
        parent,
        offset,
        kinds: kinds.to_vec(),
        end_site,
        helper: false,
    };
    use Kind::{Xposition, Xrotation, Yrotation, Zposition, Zrotation};
    let joints = vec![
        joint("root", None, [1.0, 90.0, 0.0], &[Xposition, Zposition, Zrotation, Xrotation, Yrotation], false),
        joint("larm", Some(0), [20.0, 50.0, 0.0], &[Zrotation, Yrotation], false),
        joint("", Some(1), [60.0, 0.0, 1.0], &[], true),
        joint("rarm", Some(0), [-20.0, 50.0, 0.0], &[Zrotation, Yrotation], false),
        joint("", Some(3), [-60.0, 0.0, 1.0], &[], true),
    ];
    let scalars = ["smileLeft", "smileRight", "headYaw"].map(|name| Scalar { name: name.into(), full_scale: 1.0 });
    let rig = Rig { joints, scalars: scalars.into(), cm_per_unit: 1.0, ..Rig::default() };
    let curve = |channel: usize| {
        let value = move |frame: usize| match channel {
            1 => frame as f64 * 5.0,
            9.. => 0.1 * channel as f64 * (frame as f64 / 24.0 * std::f64::consts::TAU).cos() * 0.5,
            _ => (3 * channel) as f64 * (channel as f64 + frame as f64 / 24.0 * std::f64::consts::TAU).sin(),
        };
        (0..frames).map(value).collect()
    };
    let values: Vec<Vec<f64>> = (0..rig.channels()).map(curve).collect();
    Motion {
        keys: vec![None; values.len()],
        rig,
        frame_time: 1.0 / 30.0,
        frames,
        values,
        looped: false,
        events: Vec::new(),
        origin: Default::default(),
    }
}

fn far(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn a_mirror_shows_every_joint_on_the_other_side() {
    let motion = arms(30);
    let other = mirror(&motion).unwrap();
    for frame in 0..30 {
        let (here, there) = (positions(&motion.rig, &motion.values, frame), positions(&other.rig, &other.values, frame));
        for (joint, pair) in [(0, 0), (1, 3), (2, 4), (3, 1), (4, 2)] {
            let [x, y, z] = here[joint];
            assert!(far(there[pair], [-x, y, z]) < 1e-9, "joint {joint} at frame {frame}");
        }
    }
    assert_eq!(other.values[9], motion.values[10], "a smile changes sides");
    assert!(other.values[11].iter().zip(&motion.values[11]).all(|(a, b)| *a == -b), "a head turns the other way");
}

#[test]
fn a_mirror_in_a_mirror_shows_the_motion_itself() {
    assert_eq!(mirror(&mirror(&arms(30)).unwrap()).unwrap(), arms(30));
    let walk = own("walk.keys");
    assert_eq!(mirror(&mirror(&walk).unwrap()).unwrap(), walk);
    for path in captured("bvh_", ".bvh") {
        let motion = load(&path, &ImportOptions::new()).unwrap().motion;
        let other = mirror(&motion).unwrap_or_else(|error| panic!("{}: {error:#}", path.display()));
        assert_ne!(other.values, motion.values);
        assert_eq!(mirror(&other).unwrap(), motion, "{}", path.display());
    }
}

#[test]
fn what_has_no_sides_is_not_mirrored() {
    let mut motion = arms(3);
    motion.rig.joints[3].name = "other".into();
    motion.rig.scalars[2].name = "smileMiddle".into();
    let only_scalars = mirror(&motion).unwrap();
    assert_eq!(only_scalars.rig.joints[3].name, "other");
    motion.rig.joints[3].name = "rightArm".into();
    assert!(mirror(&motion).unwrap_err().to_string().contains("rightArm has no counterpart"));
    let bare = pick(&arms(3), &globs("root"), &[]).unwrap();
    assert!(mirror(&bare).unwrap_err().to_string().contains("no names tell left from right"));
}

#[test]
fn picked_joints_stay_where_they_are_on_joints_that_are_held() {
    let motion = arms(10);
    let picked = pick(&motion, &globs("?ARM,smile*"), &globs("rarm,*right")).unwrap();
    let names: Vec<String> = (0..picked.rig.joints.len()).map(|joint| picked.rig.joint_name(joint)).collect();
    assert_eq!(names, ["root", "larm", "larm/end"]);
    assert_eq!(picked.rig.scalars.len(), 1);
    assert_eq!(picked.values.len(), picked.rig.channels());
    assert!(picked.values[..5].iter().zip(&motion.values).all(|(held, moved)| held.iter().all(|value| *value == moved[0])));
    assert_eq!(picked.values[5..7], motion.values[5..7]);
    assert!(far(positions(&picked.rig, &picked.values, 0)[2], positions(&motion.rig, &motion.values, 0)[2]) < 1e-12);
    assert_eq!(pick(&motion, &[], &globs("root,?arm")).unwrap().rig.joints.len(), 0);
    let unknown = said(&pick(&motion, &globs("leg*"), &[]).unwrap_err());
    assert!(
        unknown.contains("--joints leg*: no joint or scalar is called so; there are root, larm, rarm, smileLeft"),
        "{unknown}"
    );
    assert!(said(&pick(&motion, &[], &globs("*")).unwrap_err()).contains("--drop: no channel is left"));
}

#[test]
fn frames_that_are_cut_are_the_same_and_their_curves_too() {
    let motion = own("walk.keys");
    let part = cut(&motion, Some(13), Some(101)).unwrap();
    assert_eq!((part.frames, part.looped), (89, false));
    let mut curves = 0;
    for (channel, (values, keys)) in part.values.iter().zip(&part.keys).enumerate() {
        assert_eq!(values[..], motion.values[channel][13..=101]);
        if let Some(Keys::Pieces(pieces)) = keys {
            curves += 1;
            let again = sample_pieces(pieces, part.frames);
            assert!(values.iter().zip(again).all(|(a, b)| (a - b).abs() < 1e-9), "{}", motion.rig.channel_name(channel));
        }
    }
    assert!(curves > 10, "{curves}");
    assert_eq!(cut(&motion, None, None).unwrap(), motion);
    assert_eq!(cut(&motion, Some(159), None).unwrap().frames, 1);
    assert!(said(&cut(&motion, None, Some(160)).unwrap_err()).contains("--to 160: the last frame is 159"));
    assert!(said(&cut(&motion, Some(9), Some(8)).unwrap_err()).contains("--from 9: it is after frame 8"));
}

#[test]
fn a_rate_and_back_is_the_same_and_a_lower_rate_takes_frames() {
    let motion = arms(25);
    let fine = resample(&motion, 120.0).unwrap();
    assert_eq!((fine.frames, fine.frame_time), (97, 1.0 / 120.0));
    let back = resample(&fine, 30.0).unwrap();
    assert_eq!(back.frames, 25);
    assert!(back.values.iter().flatten().zip(motion.values.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-12));
    // Cubics through a sine of 24 frames a period.
    let off = |frame: usize| (fine.values[0][frame] - 3.0 * 0.0).abs();
    assert!(off(0) < 1e-12);
    let third = channel(&motion, "root.Zrotation");
    for (frame, value) in fine.values[third].iter().enumerate().skip(4).take(89) {
        let exact = 6.0 * (2.0 + frame as f64 / 96.0 * std::f64::consts::TAU).sin();
        assert!((value - exact).abs() < 0.02, "{frame}: {value} is not {exact}");
    }
    let odd = resample(&motion, 25.0).unwrap();
    assert_eq!(odd.frames, 21);
    assert_eq!(resample(&motion, 30.0).unwrap(), motion);
}

#[test]
fn curves_are_the_same_at_another_rate_and_loops_stay_loops() {
    let motion = own("walk.keys");
    let fine = resample(&motion, 2.0 / motion.frame_time).unwrap();
    assert_eq!((fine.frames, fine.looped), (320, true));
    for (channel, keys) in motion.keys.iter().enumerate() {
        assert!(keys.is_none() || fine.keys[channel].is_some(), "{}", motion.rig.channel_name(channel));
        let even = fine.values[channel].iter().step_by(2);
        assert!(even.zip(&motion.values[channel]).all(|(a, b)| (a - b).abs() < 1e-9));
    }
    // 160 frames at 120 are 13.33 at 10.
    assert_eq!(resample(&motion, 10.0).unwrap().frames, 13);
}

/// Keys closer than the frames that would tell their cubic, in the last span of a loop too; beside them, in the same joint, angles that jump.
#[test]
fn curves_of_close_keys_are_the_same_at_another_rate() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("close.keys");
    for (looped, last) in [("", 10), ("loop\n", 12)] {
        for (word, interpolation) in
            [("natural", Interpolation::Natural), ("catmull-rom", Interpolation::CatmullRom), ("linear", Interpolation::Linear)]
        {
            let text = format!(
                "keyframes 1\nfps 10\nframes 11\n{looped}cm-per-unit 1\njoint hip offset 0 90 0 channels Yrotation Xrotation Zrotation\n\
                 end parent hip offset 0 -45 0\nkeys linear hip.Yrotation\n 0 0\n 5 850\n 10 0\n\
                 keys {word} hip.Xrotation\n 0 -1\n 2 60\n 3 -51\n 10 7\nkeys {word} hip.Zrotation\n 0 5\n 10 -20\n"
            );
            std::fs::write(&path, text).unwrap();
            let fine = resample(&load(&path, &ImportOptions::new()).unwrap().motion, 60.0).unwrap();
            let mut keys = vec![(0, -1.0), (12, 60.0), (18, -51.0), (60, 7.0)];
            if last == 12 {
                keys.push((66, -1.0));
            }
            let expected = sample(&keys, interpolation, fine.frames, last == 12);
            let values = &fine.values[channel(&fine, "hip.Xrotation")];
            let off = values.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < 1e-9, "{word} {looped}: {off}");
        }
    }
}

/// One motion, written with a change to the other triple of the same poses between two frames, and without; of a loop over its seam, too.
#[test]
fn another_triple_for_the_same_poses_is_the_same_motion_at_another_rate() {
    for looped in [false, true] {
        let mut motion = Motion { looped, ..arms(24) };
        let first = channel(&motion, "root.Zrotation");
        for frame in 0..24 {
            let angle = frame as f64 / 24.0 * std::f64::consts::TAU;
            let triple = [60.0 + 8.0 * angle.sin(), 20.0 * angle.cos(), -40.0 + 30.0 * angle.sin()];
            (0..3).for_each(|slot| motion.values[first + slot][frame] = triple[slot]);
        }
        let mut flipped = motion.clone();
        for frame in 11..24 {
            let [a, b, c] = [0, 1, 2].map(|slot| motion.values[first + slot][frame]);
            [a - 180.0, 180.0 - b, c + 180.0]
                .into_iter()
                .enumerate()
                .for_each(|(slot, x)| flipped.values[first + slot][frame] = x);
        }
        let [plain, other] = [&motion, &flipped].map(|motion| resample(motion, 120.0).unwrap());
        for frame in 0..plain.frames {
            let [a, b] = [&plain, &other].map(|motion| positions(&motion.rig, &motion.values, frame)[1]);
            assert!(far(a, b) < 1e-6, "looped {looped}: {a:?} is not {b:?} at {frame}");
        }
    }
}

#[test]
fn angles_that_jump_to_another_triple_turn_by_the_shorter_way() {
    let mut motion = arms(2);
    let first = channel(&motion, "root.Zrotation");
    // The same pose, but for a turn of 2 degrees.
    for (slot, (from, to)) in [(10.0, 192.0), (20.0, 160.0), (30.0, 210.0)].into_iter().enumerate() {
        motion.values[first + slot] = vec![from, to];
    }
    let fine = resample(&motion, 60.0).unwrap();
    let places: Vec<_> = (0..3).map(|frame| positions(&fine.rig, &fine.values[..], frame)[1]).collect();
    // The root goes 5 on; its arm moves by some part of that and of its turn.
    assert!(far(places[0], places[1]) < 5.0 && far(places[1], places[2]) < 5.0, "{places:?}");
}

/// 45 degrees a frame are a fast turn, and no other triple: cubics go through the angles.
#[test]
fn a_fast_turn_is_a_cubic() {
    let mut motion = arms(24);
    let first = channel(&motion, "root.Zrotation");
    let angle = |frame: usize| 90.0 * (frame as f64 * std::f64::consts::TAU / 12.0).sin();
    motion.values[first] = (0..24).map(angle).collect();
    for slot in 1..3 {
        motion.values[first + slot].fill(0.0);
    }
    let fine = resample(&motion, 60.0).unwrap();
    for frame in 1..22 {
        let [a, b, c, d] = [frame - 1, frame, frame + 1, frame + 2].map(angle);
        let expected = (9.0 * (b + c) - a - d) / 16.0;
        assert!((fine.values[first][2 * frame + 1] - expected).abs() < 1e-9, "{frame}");
    }
}

#[test]
fn the_last_frame_stays_where_the_file_rounds_its_rate() {
    let motion = Motion { frame_time: 0.0333333, ..arms(31) };
    for (fps, frames) in [(25.0, 26), (40.0, 41), (60.0, 61), (15.0, 16)] {
        assert_eq!(resample(&motion, fps).unwrap().frames, frames, "{fps}");
    }
}

#[test]
fn a_seam_is_closed_within_its_bound_or_refused() {
    let mut motion = arms(25);
    let arm = channel(&motion, "larm.Zrotation");
    motion.values[arm][24] += 0.5;
    let closed = close(&motion, Most::Distance(&PoseBound::places(1.0), 0.02)).unwrap();
    // Half a degree of 60 cm is 0.52 cm, half of which each end moves.
    assert!((closed.moved_cm - 0.262).abs() < 0.01, "{}", closed.moved_cm);
    assert_eq!(closed.joint, "larm/end");
    assert_eq!((closed.motion.frames, closed.motion.looped), (24, true));
    assert_eq!(closed.travel.len(), 1);
    assert_eq!(closed.travel[0].0, "root.Zposition");
    assert!((closed.travel[0].1 - 120.0).abs() < 1e-9);
    for frame in 0..24 {
        let (a, b) = (positions(&motion.rig, &motion.values, frame), positions(&closed.motion.rig, &closed.motion.values, frame));
        assert!(a.into_iter().zip(b).all(|(a, b)| far(a, b) < 0.27));
    }
    // Over the seam the arm goes on as it does elsewhere.
    let values = &closed.motion.values[arm];
    let over = values[0] - values[23];
    let before = values[23] - values[22];
    assert!((over - before).abs() < 2.0, "{before} and then {over}");
    let refused = close(&motion, Most::Distance(&PoseBound::places(0.5), 0.02)).unwrap_err().to_string();
    assert!(refused.contains("larm/end is 0.52") && refused.contains("the bound is 0.5 cm"), "{refused}");
    let mut motion = arms(25);
    motion.values[10][24] += 0.1;
    let refused = close(&motion, Most::Distance(&PoseBound::places(0.5), 0.02)).unwrap_err().to_string();
    assert!(refused.contains("smileRight differs by 0.1000"), "{refused}");
    assert!(close(&arms(2), Most::Distance(&PoseBound::places(0.5), 0.02)).is_err());
}

#[test]
fn every_captured_body_goes_on_the_display() {
    for path in captured("bvh_", ".bvh").into_iter().chain(captured("amc_", ".amc")) {
        let motion = load(&path, &ImportOptions::new()).unwrap().motion;
        let done = retarget::display(&motion, "").unwrap_or_else(|error| panic!("{}: {error:#}", path.display()));
        assert_eq!(done.motion.rig.joints.iter().filter(|joint| !joint.end_site).count(), 15);
        println!("{}: {:.2} cm ({} at frame {})", path.display(), done.max_cm, done.joint, done.frame);
        // The told distance is what forward kinematics of the channels give, too.
        let named = |name: &str| motion.rig.joints.iter().position(|joint| joint.name == name).unwrap();
        let goals: Vec<usize> = done.sources.iter().map(|(_, source)| named(source)).collect();
        let joints: Vec<usize> =
            (0..done.motion.rig.joints.len()).filter(|&joint| !done.motion.rig.joints[joint].end_site).collect();
        let mut greatest: f64 = 0.0;
        for frame in 0..motion.frames {
            let source = positions(&motion.rig, &motion.values, frame);
            let display = positions(&done.motion.rig, &done.motion.values, frame);
            greatest =
                joints.iter().zip(&goals).map(|(&joint, &goal)| far(display[joint], source[goal])).fold(greatest, f64::max);
        }
        assert!((greatest - done.max_cm).abs() < 1e-6, "{}: {greatest} is not {}", path.display(), done.max_cm);
        assert!(done.max_cm < 25.0, "{}: {} cm", path.display(), done.max_cm);
    }
}
