//! Edits of whole motions, as their users call them: what they keep, and what they refuse.

use pantin_convert::Memory;
use pantin_convert::edit::contacts::{contacts, feet};
use pantin_convert::edit::{Edits, InPlace, Pace};
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
    assert!(apart(&other, &walk) < 1e-6, "{}", apart(&other, &walk));
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
            assert!(done.uneven_deg < 8.0, "{body:?}: {} degrees", done.uneven_deg);
            rigs.push(done.motion.rig);
        }
        assert!(rigs.windows(2).all(|pair| pair[0] == pair[1]));
    }
    // A figure that does not stand with all turns at 0, and walks in its first frame.
    let [walk, kick] = ["bvh_bandai1_walk", "bvh_bandai1_kick"].map(|name| read(&data.join(format!("{name}.bvh"))));
    let done = pantin_convert::edit::body::onto(&kick, &walk, "").unwrap();
    assert!((30.0..50.0).contains(&done.uneven_deg), "{} degrees", done.uneven_deg);
    // What this figure did in another capture it does on itself. Its joint on the ground is below the hips then.
    for frame in [0, 100, 200, 300] {
        let [own, other] = [&kick, &done.motion].map(|motion| positions(&motion.rig, &motion.values, frame));
        let far =
            own.iter().zip(&other).skip(1).map(|(own, other)| pantin_convert::fk::distance(*own, *other)).fold(0.0, f64::max);
        assert!(far < 1e-6, "frame {frame}: {far} cm");
    }
    // Feet that are flat on the ground are flat on a body that bends its knees in its first frame.
    let slash = read(&data.join("bvh_bandai1_slash.bvh"));
    let stand = read(&data.join("bvh_mixamo-mia_gesture.bvh"));
    let done = pantin_convert::edit::body::onto(&stand, &slash, "").unwrap();
    let at = positions(&done.motion.rig, &done.motion.values, 80);
    let height = |name: &str| at[done.motion.rig.joints.iter().position(|joint| joint.name == name).unwrap()][1];
    let [left, right] = ["Toes_L", "Toes_R"].map(height);
    assert!((left - right).abs() < 1.5, "toes at {left} and {right} cm");
    // They stand as high as the body's own, whose ground is not at 0.
    let bow = read(&data.join("bvh_bandai1_bow.bvh"));
    let own = pantin_convert::edit::body::onto(&bow, &slash, "").unwrap();
    let lowest = |motion: &Motion| {
        let ankles = ["Foot_L", "Foot_R"].map(|name| motion.rig.joints.iter().position(|joint| joint.name == name).unwrap());
        let at = |frame: usize| positions(&motion.rig, &motion.values, frame);
        (0..motion.frames).flat_map(|frame| ankles.map(|ankle| at(frame)[ankle][1])).fold(f64::INFINITY, f64::min)
    };
    let [own, other] = [&own.motion, &done.motion].map(lowest);
    assert!((own - other).abs() < 1.0, "ankles at {own} and {other} cm");
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

/// The greatest distance in cm of joints from where a turn about the place of the root in the first frame takes them.
fn off_turn(a: &Motion, b: &Motion, degrees: f64) -> f64 {
    let (s, c) = degrees.to_radians().sin_cos();
    let [x0, _, z0] = positions(&a.rig, &a.values, 0)[0];
    let turned = |[x, y, z]: [f64; 3]| [x0 + c * (x - x0) + s * (z - z0), y, z0 - s * (x - x0) + c * (z - z0)];
    let at = |motion: &Motion, frame| positions(&motion.rig, &motion.values, frame);
    let pairs = (0..a.frames).flat_map(|frame| at(a, frame).into_iter().zip(at(b, frame)).collect::<Vec<_>>());
    pairs.map(|(a, b)| pantin_convert::fk::distance(turned(a), b)).fold(0.0, f64::max)
}

/// A figure of a root at the origin, hips that go along z, and legs, all in the order of BVH.
fn strider() -> Motion {
    let text = "keyframes 1\nfps 30\nframes 31\ncm-per-unit 1\n\
        joint base offset 0 0 0 channels Xposition Yposition Zposition\n\
        joint hips parent base offset 0 90 0 channels Xposition Yposition Zposition Zrotation Xrotation Yrotation\n\
        joint LeftUpLeg parent hips offset 10 -5 0 channels Xrotation\nend parent LeftUpLeg offset 0 -80 0\n\
        joint RightUpLeg parent hips offset -10 -5 0 channels Xrotation\nend parent RightUpLeg offset 0 -80 0\n\
        keys linear base\n 0 0 0 0\n 30 0 0 0\n\
        keys linear hips\n 0 3 90 0 0 0 10\n 30 5 91 120 4 -3 20\n\
        keys linear LeftUpLeg\n 0 -20\n 30 20\nkeys linear RightUpLeg\n 0 20\n 30 -20\n";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("strider.keys");
    std::fs::write(&path, text).unwrap();
    read(&path)
}

#[test]
fn a_turn_takes_every_joint_with_it() {
    let motion = strider();
    for degrees in [90.0, -37.5, 180.0, 360.0] {
        let turned = edited(&Edits::new().turn(degrees), &motion);
        assert!(off_turn(&motion, &turned, degrees) < 1e-6, "{degrees}: {}", off_turn(&motion, &turned, degrees));
        assert_eq!(turned.rig, motion.rig, "motions that are turned stay in one bank with others");
    }
    // A root that never turns only places the figure: a player would take its direction for the heading, and undo it.
    let mut rooted = strider();
    for kind in [
        pantin_convert::motion::Kind::Zrotation,
        pantin_convert::motion::Kind::Xrotation,
        pantin_convert::motion::Kind::Yrotation,
    ] {
        rooted.rig.joints[0].kinds.push(kind);
        rooted.values.insert(3, vec![0.0; rooted.frames]);
        rooted.keys.insert(3, None);
    }
    let turned = edited(&Edits::new().turn(70.0), &rooted);
    assert!(off_turn(&rooted, &turned, 70.0) < 1e-6 && turned.values[3..6] == rooted.values[3..6]);
    let error = refused(&Edits::new().turn(90.0), &read(&motions("walk.keys")));
    assert!(error.contains("turn 90: ") && error.contains("has no channels by which it could follow"), "{error}");
    assert!(refused(&Edits::new().turn(f64::NAN), &motion).contains("expected a number of degrees"));
}

#[test]
fn captures_turn_whatever_their_joints() {
    let data = std::env::var_os("PANTIN_DATA")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"), PathBuf::from);
    for name in ["bvh_bandai1_bow", "bvh_mixamo-beta_run-loop", "bvh_xia_neutral-walk"] {
        let path = data.join(format!("{name}.bvh"));
        if !path.exists() {
            return println!("skipped: no captured clips in {}; set PANTIN_DATA", data.display());
        }
        let motion = read(&path);
        let turned = edited(&Edits::new().turn(75.0), &motion);
        assert!(off_turn(&motion, &turned, 75.0) < 1e-3, "{name}: {}", off_turn(&motion, &turned, 75.0));
    }
}

#[test]
fn a_pace_moves_a_figure_the_way_it_faces() {
    let walk = read(&motions("walk.keys"));
    let spot = edited(&Edits::new().in_place(InPlace::Way), &walk);
    let place = |motion: &Motion, frame| positions(&motion.rig, &motion.values, frame)[1];
    let seconds = 159.0 * walk.frame_time;
    let gone = |motion: &Motion| place(motion, 159)[2] - place(motion, 0)[2] - (place(&spot, 159)[2] - place(&spot, 0)[2]);
    let paced = edited(&Edits::new().pace("1.2m/s".parse::<Pace>().unwrap()), &spot);
    assert!((gone(&paced) / seconds - 120.0).abs() < 1.0, "{} cm/s", gone(&paced) / seconds);
    // A turn before it takes the direction along.
    let aside = edited(&Edits::new().turn(90.0).pace(Pace::CmPerSecond(50.0)), &strider());
    let still = edited(&Edits::new().turn(90.0), &strider());
    let way: Vec<f64> = (0..3).map(|axis| place(&aside, 30)[axis] - place(&still, 30)[axis]).collect();
    // The strider faces 15 degrees to the left of z in the mean.
    let facing = f64::to_radians(15.0 + 90.0);
    assert!((way[0] - 50.0 * facing.sin()).abs() < 1.0 && (way[2] - 50.0 * facing.cos()).abs() < 1.0, "{way:?}");
}

#[test]
fn feet_on_the_ground_give_the_pace_of_a_treadmill() {
    let walk = read(&motions("walk.keys"));
    let spot = edited(&Edits::new().in_place(InPlace::Way), &walk);
    let again = Edits::new().pace(Pace::Feet).apply(spot.clone(), &Disk::default()).unwrap();
    // The walk goes 120 cm in 160 frames of 120 a second.
    let noted = again.notes.iter().find(|note| note.kind.name() == "travel").unwrap();
    let speed: f64 = noted.text.split(' ').find_map(|word| word.parse().ok()).unwrap();
    assert!((speed - 90.0).abs() < 9.0, "{}", noted.text);
    assert!(apart(&walk, &again.motion) < 12.0, "{}", apart(&walk, &again.motion));
    // Who walks already has feet that stand.
    let walking = edited(&Edits::new().pace(Pace::Feet), &walk);
    assert!(apart(&walk, &walking) < 12.0, "{}", apart(&walk, &walking));
}

#[test]
fn feet_that_slide_a_little_on_their_way_are_on_the_ground_and_those_of_a_treadmill_are_not() {
    let held = |motion: &Motion| contacts(motion, &feet(&motion.rig, [None, None]).unwrap(), Memory::default()).unwrap();
    let walk = read(&motions("walk.keys"));
    let spot = edited(&Edits::new().in_place(InPlace::Way), &walk);
    assert!(held(&spot).is_none());
    // 20 cm a second more than its feet go.
    let sliding = held(&edited(&Edits::new().pace(Pace::CmPerSecond(20.0)), &walk)).unwrap();
    assert!(sliding.iter().all(|foot| !foot.is_empty()));
}

#[test]
fn a_pace_is_a_speed_or_the_feet() {
    let read = |text: &str| text.parse::<Pace>();
    for (text, speed) in [("120", 120.0), ("120cm/s", 120.0), ("1.2 m/s", 120.0), ("-5 mm/s", -0.5), ("10in/s", 25.4)] {
        assert_eq!(read(text), Ok(Pace::CmPerSecond(speed)), "{text}");
    }
    assert_eq!(read("feet"), Ok(Pace::Feet));
    for text in ["", "fast", "1.2km/h", "nan", "inf", "2000m/s"] {
        assert!(read(text).unwrap_err().starts_with("expected a speed, like 120cm/s"), "{text}");
    }
    let error = refused(&Edits::new().pace(Pace::CmPerSecond(f64::NAN)), &strider());
    assert!(error.contains("pace: expected a speed of at most 1 km a second"), "{error}");
}

#[test]
fn a_body_whose_legs_do_not_hang_on_its_hips_is_refused() {
    let walk = read(&motions("walk.keys"));
    let mut body = walk.clone();
    let thigh = body.rig.joints.iter().position(|joint| joint.name == "left-thigh").unwrap();
    body.rig.joints[thigh].parent = Some(0);
    let error = pantin_convert::edit::body::onto(&walk, &body, "").unwrap_err().to_string();
    assert!(error.contains("left-thigh does not hang on hips"), "{error}");
}

#[test]
fn a_wrong_body_is_named_as_such_in_one_line() {
    let walk = read(&motions("walk.keys"));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cube.keys");
    std::fs::write(&path, "keyframes 1\nfps 30\nframes 3\ncm-per-unit 1\njoint cube offset 0 9 0 channels Yrotation\nend parent cube offset 0 9 0\nkeys linear cube\n 0 0\n 2 9\n").unwrap();
    let on = |path: &Path| Edits::new().retarget(pantin_convert::edit::Body::Of(path.into()));
    let error = refused(&on(&path), &walk);
    assert!(error.contains("body: not found in the body: Hips,") && error.contains("Its joints are cube."), "{error}");
    assert!(!error.contains('\n') && !error.contains("retarget"), "{error}");
    let error = refused(&on(&motions("walk.keys")), &read(&path));
    assert!(
        error.contains("body: not found in the figure: Hips,") && error.contains("`Hips JOINT`, where JOINT is one of cube"),
        "{error}"
    );
    assert!(!error.contains('\n') && !error.contains("retarget"), "{error}");
}

/// A figure that stands and goes ahead, built facing ahead or a quarter of a turn aside: all joints turn about the vertical by their offsets alone, and in the motion.
fn standing(quarter: bool) -> String {
    let at = |[x, y, z]: [f64; 3]| if quarter { format!("{z} {y} {}", -x) } else { format!("{x} {y} {z}") };
    let mut out = String::from("keyframes 1\nfps 30\nframes 31\ncm-per-unit 1\n");
    let mut joint = |name: &str, parent: &str, offset: [f64; 3], channels: &str| {
        out += &format!("joint {name}{parent} offset {} channels {channels}\n", at(offset));
    };
    joint("Hips", "", [0.0, 90.0, 0.0], "Xposition Yposition Zposition Zrotation Xrotation Yrotation");
    joint("Spine", " parent Hips", [0.0, 20.0, 0.0], "Zrotation Xrotation Yrotation");
    joint("Head", " parent Spine", [0.0, 40.0, 0.0], "Zrotation Xrotation Yrotation");
    for (side, x) in [("Left", 1.0), ("Right", -1.0)] {
        for (name, parent, offset) in [
            ("Arm", "Spine", [18.0 * x, 30.0, 0.0]),
            ("ForeArm", "Arm", [28.0 * x, 0.0, 0.0]),
            ("Hand", "ForeArm", [24.0 * x, 0.0, 0.0]),
            ("UpLeg", "Hips", [9.0 * x, -5.0, 0.0]),
            ("Leg", "UpLeg", [0.0, -42.0, 0.0]),
            ("Foot", "Leg", [0.0, -40.0, 0.0]),
        ] {
            let parent = if ["Spine", "Hips"].contains(&parent) { parent.into() } else { format!("{side}{parent}") };
            joint(&format!("{side}{name}"), &format!(" parent {parent}"), offset, "Zrotation Xrotation Yrotation");
        }
    }
    let way = |frame: usize| at([0.0, 90.0, 4.0 * frame as f64]);
    out + &format!("keys linear Hips\n 0 {} 0 0 0\n 30 {} 0 0 0\n", way(0), way(30))
}

#[test]
fn a_figure_that_was_built_facing_another_way_faces_as_its_body() {
    let folder = tempfile::tempdir().unwrap();
    let paths = [("ahead.keys", false), ("aside.keys", true)].map(|(name, quarter)| {
        let path = folder.path().join(name);
        std::fs::write(&path, standing(quarter)).unwrap();
        path
    });
    let on = Edits::new().retarget(pantin_convert::edit::Body::Of(paths[0].clone()));
    let [ahead, aside] = paths.each_ref().map(|path| on.apply(read(path), &Disk::default()).unwrap());
    assert!(apart(&ahead.motion, &aside.motion) < 1e-3, "{}", apart(&ahead.motion, &aside.motion));
    let noted =
        |edited: &pantin_convert::edit::Edited| edited.notes.iter().any(|note| note.text.contains("was turned by -90 degrees"));
    assert!(!noted(&ahead) && noted(&aside), "{:?}", aside.notes);
    // A motion that goes aside is not turned, and the note says by what it could be.
    let turned = on.clone().apply(edited(&Edits::new().turn(60.0), &read(&paths[0])), &Disk::default()).unwrap();
    let said = turned
        .notes
        .iter()
        .any(|note| note.text.contains("faces 60 degrees to the left") && note.text.contains("by -60 degrees"));
    assert!(said, "{:?}", turned.notes);
}

#[test]
fn a_capture_that_runs_gets_no_other_way_by_its_feet() {
    let data = std::env::var_os("PANTIN_DATA")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"), PathBuf::from);
    for (name, speed) in [("bvh_mixamo-beta_run-loop", 420.6), ("bvh_xia_neutral-walk", 98.9)] {
        let path = data.join(format!("{name}.bvh"));
        if !path.exists() {
            return println!("skipped: no captured clips in {}; set PANTIN_DATA", data.display());
        }
        let motion = read(&path);
        assert_eq!(edited(&Edits::new().pace(Pace::Feet), &motion).values, motion.values, "{name}");
        // As on a treadmill: the feet have about the speed that was taken out.
        let spot = edited(&Edits::new().in_place(InPlace::Way), &motion);
        let done = Edits::new().pace(Pace::Feet).apply(spot, &Disk::default()).unwrap();
        let noted = done.notes.iter().find(|note| note.kind.name() == "travel").unwrap();
        let found: f64 = noted.text.split(' ').find_map(|word| word.parse().ok()).unwrap();
        println!("{name}: {found} of {speed} cm a second");
        assert!((found / speed - 1.0).abs() < 0.15, "{name}: {found}");
    }
}

#[test]
fn a_joint_above_the_hips_goes_along_with_them() {
    // As captures have it: the root stays at the origin, and the hips begin metres away.
    let channels = "Xposition Yposition Zposition Zrotation Xrotation Yrotation";
    let own = format!("joint Hips offset 0 90 0 channels {channels}");
    let below = format!("joint Root offset 0 0 0 channels {channels}\njoint Hips parent Root offset 0 0 0 channels {channels}");
    let text = standing(false);
    assert!(text.contains(&own) && text.contains("0 0 90 0 "), "{text}");
    let text = text.replace(&own, &below).replace(" 0 0 90 0 ", " 0 0 90 -400 ").replace(" 30 0 90 120 ", " 30 0 90 -280 ");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("far.keys");
    std::fs::write(&path, text).unwrap();
    let far = read(&path);
    let on = edited(&Edits::new().retarget(pantin_convert::edit::Body::Of(path)), &far);
    for frame in 0..on.frames {
        let places = positions(&on.rig, &on.values, frame);
        let [root, hips] = [places[0], places[1]];
        assert!(
            (root[0] - hips[0]).hypot(root[2] - hips[2]) < 1e-6 && (hips[1] - root[1] - 90.0).abs() < 1e-6,
            "{frame}: {root:?} {hips:?}"
        );
        assert!((hips[2] - (4.0 * frame as f64 - 400.0)).abs() < 1e-6, "{frame}: {hips:?}");
    }
}
