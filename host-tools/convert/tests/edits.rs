//! Edits of whole motions, as their users call them: what they keep, and what they refuse.

use pantin_convert::edit::{Edits, InPlace};
use pantin_convert::fk::positions;
use pantin_convert::import::{Disk, ImportOptions, load};
use pantin_convert::motion::Motion;
use std::path::{Path, PathBuf};

fn motions(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions").join(name)
}

fn read(path: &Path) -> Motion {
    load(path, &ImportOptions::new()).unwrap().motion
}

fn edited(edits: &Edits, motion: &Motion) -> Motion {
    edits.apply(motion.clone(), &Disk::default()).unwrap().motion
}

fn refused(edits: &Edits, motion: &Motion) -> String {
    edits.apply(motion.clone(), &Disk::default()).unwrap_err().to_string()
}

/// The greatest distance in cm between the joints of two motions of one figure at all frames.
fn apart(a: &Motion, b: &Motion) -> f64 {
    assert_eq!(a.frames, b.frames);
    let at = |motion: &Motion, frame| positions(&motion.rig, &motion.values, frame);
    let pairs = (0..a.frames).flat_map(|frame| at(a, frame).into_iter().zip(at(b, frame)).collect::<Vec<_>>());
    pairs.map(|(a, b)| pantin_convert::fk::distance(a, b)).fold(0.0, f64::max)
}

#[test]
fn a_motion_on_its_own_body_is_the_same_motion() {
    let path = motions("walk.keys");
    let walk = read(&path);
    let other = edited(&Edits::new().retarget(pantin_convert::edit::Body::Of(path)), &walk);
    assert_eq!(other.rig, walk.rig);
    // The ankles' least height becomes that of the rest pose over the floor.
    let height = |motion: &Motion| positions(&motion.rig, &motion.values, 0)[1][1];
    let lift = height(&other) - height(&walk);
    let lifted = edited(&Edits::new(), &walk);
    let lifted = Motion {
        values: lifted
            .values
            .iter()
            .enumerate()
            .map(|(channel, values)| match walk.rig.channel_name(channel).as_str() {
                "hips.Yposition" => values.iter().map(|value| value + lift).collect(),
                _ => values.clone(),
            })
            .collect(),
        ..lifted
    };
    assert!(lift.abs() < 1.0 && apart(&other, &lifted) < 1e-6, "{lift} {}", apart(&other, &lifted));
}

#[test]
fn captures_of_four_conventions_have_one_rig_on_one_body_and_feet_on_the_ground() {
    let data = std::env::var_os("PANTIN_DATA")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"), PathBuf::from);
    let names = ["bvh_mixamo-beta_run-loop", "bvh_xia_neutral-walk", "bvh_bandai1_kick", "bvh_cmu131_start-walk-stop"];
    let paths: Vec<PathBuf> = names.iter().map(|name| data.join(format!("{name}.bvh"))).collect();
    if !paths.iter().all(|path| path.exists()) {
        return println!("skipped: no captured clips in {}; set PANTIN_DATA", data.display());
    }
    for body in &paths {
        let mut rigs = Vec::new();
        for path in &paths {
            let motion = read(path);
            let map = String::new();
            let done = pantin_convert::edit::body::onto(&motion, &read(body), &map).unwrap();
            assert!(done.arms_deg < 0.01 && done.legs_deg < 0.01, "{path:?} on {body:?}: {} {}", done.arms_deg, done.legs_deg);
            assert!(done.ankles_cm < 1.0, "{path:?} on {body:?}: {} cm", done.ankles_cm);
            assert!(done.limited.is_empty());
            rigs.push(done.motion.rig);
        }
        assert!(rigs.windows(2).all(|pair| pair[0] == pair[1]));
    }
}

#[test]
fn backwards_twice_is_forwards_and_footsteps_are_left_out() {
    for name in ["walk.keys", "greet.keys"] {
        let motion = read(&motions(name));
        let back = edited(&Edits::new().reverse(true), &motion);
        let again = edited(&Edits::new().reverse(true), &back);
        assert_eq!(again.values, motion.values);
        let (first, last) = (0, motion.frames - 1);
        let expected = if motion.looped { [first, 1] } else { [last, first] };
        for channel in 0..motion.values.len() {
            let ends = [back.values[channel][first], back.values[channel][last]];
            assert_eq!(ends, expected.map(|frame| motion.values[channel][frame]), "{name}");
        }
        assert!(back.events.iter().all(|event| !event.name.ends_with("foot_down")));
    }
}

#[test]
fn a_figure_twice_as_large_goes_twice_as_far() {
    let walk = read(&motions("walk.keys"));
    let large = edited(&Edits::new().scale(2.0), &walk);
    for frame in [0, 40, 159] {
        let (small, large) = (positions(&walk.rig, &walk.values, frame), positions(&large.rig, &large.values, frame));
        assert!(small.iter().flatten().zip(large.iter().flatten()).all(|(small, large)| (2.0 * small - large).abs() < 1e-9));
    }
    assert!(large.keys.iter().flatten().count() == walk.keys.iter().flatten().count(), "known curves stay known");
    let fast = edited(&Edits::new().speed(2.0), &walk);
    assert_eq!((fast.frames, fast.frame_time), (160, walk.frame_time / 2.0));
}

#[test]
fn a_walk_on_the_spot_stays_above_its_first_place() {
    let walk = read(&motions("walk.keys"));
    let place = |motion: &Motion, frame| positions(&motion.rig, &motion.values, frame)[0];
    let spot = edited(&Edits::new().in_place(InPlace::Way), &walk);
    assert!((0..160).all(|frame| place(&spot, frame) == place(&walk, 0)));
    let error = refused(&Edits::new().in_place(InPlace::WayAndHeading), &walk);
    assert!(error.contains("root has not all three rotations that a heading takes"), "{error}");
}

#[test]
fn names_change_by_one_star_and_never_to_one_name() {
    let walk = read(&motions("walk.keys"));
    let other = edited(&Edits::new().rename("left-*", "L_*").rename("root", "Root"), &walk);
    let has = |name: &str| other.rig.joints.iter().any(|joint| joint.name == name);
    assert!(has("L_foot") && has("Root") && !has("left-foot") && has("right-foot"));
    assert!(refused(&Edits::new().rename("nose", "Nose"), &walk).contains("no joint and no scalar has this name"));
    assert!(refused(&Edits::new().rename("neck", "head"), &walk).contains("two joints would have one name"));
}

#[test]
fn a_stretch_lies_between_two_events() {
    let walk = read(&motions("walk.keys"));
    let at = |frame: u32| pantin_convert::Moment::Frame(frame);
    let marked = Edits::new().event("a", at(20)).event("b", at(10)).event("b", at(70)).event("a", at(90));
    let part = edited(&marked.clone().between("a", "b"), &walk);
    assert_eq!((part.frames, part.values[0][0]), (51, walk.values[0][20]));
    assert_eq!(edited(&marked.clone().between("a", "a"), &walk).frames, 71);
    let error = refused(&marked.between("b", "c"), &walk);
    assert!(error.contains("no event c after frame 10; the events are: ") && error.contains("b..c"), "{error}");
}

#[test]
fn smoothing_keeps_slow_motion_and_takes_fast_motion_out() {
    let mut walk = read(&motions("walk.keys"));
    let clean = walk.clone();
    let head = (0..walk.rig.channels()).find(|&channel| walk.rig.channel_name(channel) == "head.Xrotation").unwrap();
    walk.values[head].iter_mut().enumerate().for_each(|(frame, value)| *value += if frame % 2 == 0 { 1.0 } else { -1.0 });
    let smooth = edited(&Edits::new().smooth(15.0), &walk);
    let off =
        |motion: &Motion| motion.values[head].iter().zip(&clean.values[head]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off(&walk) > 0.99 && off(&smooth) < 0.1, "{}", off(&smooth));
    assert!(refused(&Edits::new().smooth(0.0), &walk).contains("expected a number above 0"));
}

#[test]
fn another_motion_goes_on_where_the_figure_stands() {
    let walk = read(&motions("walk.keys"));
    let both = edited(&Edits::new().append(motions("run.keys")).blend(0.1), &walk);
    let run = read(&motions("run.keys"));
    let steps = |motion: &Motion| {
        let places: Vec<_> = (0..motion.frames).map(|frame| positions(&motion.rig, &motion.values, frame)).collect();
        let pairs = places
            .windows(2)
            .flat_map(|pair| pair[0].iter().zip(&pair[1]).map(|(a, b)| pantin_convert::fk::distance(*a, *b)).collect::<Vec<_>>());
        pairs.fold(0.0, f64::max)
    };
    let expected = ((run.frames - 1) as f64 * run.frame_time / walk.frame_time).floor() as usize + 1 + walk.frames - 12;
    assert_eq!(both.frames, expected);
    assert!(!both.looped);
    // The blend goes over within a tenth of a second: no joint goes farther in a frame than half again what the run does.
    assert!(steps(&both) < 1.5 * steps(&run).max(steps(&walk)), "{} {} {}", steps(&both), steps(&walk), steps(&run));
    let other = refused(&Edits::new().append(motions("face/joy.keys")), &walk);
    assert!(other.contains("face/joy.keys") || other.contains("joint"), "{other}");
}
