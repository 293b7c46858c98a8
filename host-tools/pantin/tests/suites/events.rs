//! Event markers: given on the command line, by files and found in the motion; their names in clips, and what `pantin info` prints.

use pantin::{Clip, LEFT_FOOT_DOWN, RIGHT_FOOT_DOWN};
use pantin_convert::Memory;
use pantin_convert::edit::footsteps::footsteps;
use pantin_convert::edit::mirror::mirror;
use pantin_convert::events;
use pantin_convert::fk::positions;
use pantin_convert::import::ImportOptions;
use pantin_convert::motion::{Kind, Motion};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn own(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions").join(name).with_extension("keys")
}

fn load(path: &Path) -> Motion {
    crate::told::load(path, &ImportOptions::new()).unwrap().motion
}

fn convert(motion: &Path, clip: &Path, options: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pantin"));
    command.arg("convert").arg(motion).arg("-o").arg(clip).args(["--effort", "fast"]).args(options).output().unwrap()
}

/// Frame and name of each event of a clip.
fn of(clip: &Path) -> Vec<(usize, String)> {
    let bytes = std::fs::read(clip).unwrap();
    events::of_clip(&Clip::new_checked(&bytes).unwrap()).into_iter().map(|event| (event.frame, event.name)).collect()
}

#[test]
fn events_of_the_command_line_are_in_the_clip_and_nothing_else_of_it_changes() {
    let folder = tempfile::tempdir().unwrap();
    let [plain, marked] = ["plain.ptn", "marked.ptn"].map(|name| folder.path().join(name));
    assert!(convert(&own("run"), &plain, &[]).status.success());
    let given = ["--event", "clap@12", "--event", "door opens@0.5s", "--event", "7@3", "--event", "clap@0"];
    assert!(convert(&own("run"), &marked, &given).status.success());
    let expected = [(0, "clap"), (3, "7"), (12, "clap"), (18, "door opens")].map(|(frame, name)| (frame, name.to_string()));
    assert_eq!(of(&marked), expected);
    let [plain, marked] = [plain, marked].map(|path| std::fs::read(path).unwrap());
    let (plain, marked_clip) = (Clip::new_checked(&plain).unwrap(), Clip::new_checked(&marked).unwrap());
    assert_eq!(marked_clip.event_id("clap"), Some(0));
    assert_eq!(marked_clip.event_name(1), Some("door opens"));
    assert_eq!((marked_clip.event_id(""), marked_clip.event_id("Clap"), marked_clip.event_name(7)), (None, None, None));
    // The events take a count and two bytes each; the names what they say.
    let head = 1 + 4 * 2;
    assert_eq!(marked_clip.motion_len(), plain.motion_len() + head);
    assert_eq!(marked_clip.event_names_len(), "clap".len() + "door opens".len() + 2 + 2);
}

#[test]
fn wrong_events_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let clip = folder.path().join("clip.ptn");
    for (event, why) in [
        ("clap", "expected NAME@FRAME"),
        ("@3", "without a name"),
        ("clap@x", "expected a frame's number"),
        ("clap@26", "it has frames 0 to 25"),
        ("clap@9s", "not in the clip"),
        ("a\tb@1", "control character"),
    ] {
        let output = convert(&own("run"), &clip, &["--event", event]);
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && error.contains(why), "{event}: {error}");
        assert!(!clip.exists());
    }
    let table = folder.path().join("table.csv");
    std::fs::write(&table, "time,a\n0,1\n1,2\n").unwrap();
    let output = convert(&table, &clip, &["--footsteps"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("no joint is named as a left or a right foot"));
}

#[test]
fn edits_move_events_with_the_frames() {
    let folder = tempfile::tempdir().unwrap();
    let clip = folder.path().join("clip.ptn");
    let marks = ["--event", "a@6", "--event", "left_foot_down@12", "--event", "b@20"];
    let options = [&marks[..], &["--from", "5", "--to", "18", "--mirror"]].concat();
    assert!(convert(&own("run"), &clip, &options).status.success());
    assert_eq!(of(&clip), [(1, "a".to_string()), (7, "right_foot_down".to_string())]);
    // 26 frames of 36 a second; the frames of --event are those after --fps.
    assert!(convert(&own("run"), &clip, &["--fps", "72", "--event", "a@50"]).status.success());
    assert_eq!(of(&clip), [(50, "a".to_string())]);
    // Frames 3 and 4 of 36 a second are both frame 1 of 12.
    std::fs::write(
        folder.path().join("many.keys"),
        "keyframes 1\nfps 36\nframes 9\nevent clap 3 4\nscalar a scale 1\nkeys linear a\n 0 0\n 8 1\n",
    )
    .unwrap();
    let merged = convert(&folder.path().join("many.keys"), &clip, &["--fps", "12"]);
    assert!(String::from_utf8_lossy(&merged.stderr).contains("events: 1 of 2 come to a frame"), "{merged:?}");
    assert_eq!(of(&clip), [(1, "clap".to_string())]);
}

#[test]
fn files_have_events_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let keys = "keyframes 1\nfps 10\nframes 5\nevent step 4 0\nevent 9 2\nscalar a scale 1\nkeys linear a\n 0 0\n 4 1\n";
    std::fs::write(path("a.keys"), keys).unwrap();
    assert!(convert(&path("a.keys"), &path("a.ptn"), &[]).status.success());
    assert_eq!(of(&path("a.ptn")), [(0, "step"), (2, "9"), (4, "step")].map(|(frame, name)| (frame, name.to_string())));
    for (line, why) in [
        ("event step 5", "expected a frame of 0 to 4"),
        ("event step", "expected frames after the event's name"),
        ("event step -1", "expected a frame of 0 to 4"),
    ] {
        std::fs::write(path("b.keys"), keys.replace("event 9 2", line)).unwrap();
        let error = crate::told::load(&path("b.keys"), &ImportOptions::new()).unwrap_err().to_string();
        assert!(error.contains(why) && error.contains("b.keys:5"), "{error}");
    }
    let table = "time,a,event,b\n0.0,1,,5\n0.1,2,clap | step,6\n0.2,3,clap,7\n";
    std::fs::write(path("c.csv"), table).unwrap();
    assert!(convert(&path("c.csv"), &path("c.ptn"), &[]).status.success());
    assert_eq!(of(&path("c.ptn")), [(1, "clap"), (1, "step"), (2, "clap")].map(|(frame, name)| (frame, name.to_string())));
    let bytes = std::fs::read(path("c.ptn")).unwrap();
    let scalars: Vec<_> = Clip::new_checked(&bytes).unwrap().rig().scalars().map(|scalar| scalar.name().to_string()).collect();
    assert_eq!(scalars, ["a", "b"]);
    let info = |options: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_pantin")).arg("info").arg(path("c.ptn")).args(options).output().unwrap();
        String::from_utf8(output.stdout).unwrap()
    };
    assert!(info(&[]).contains("      1     0.100  clap\n      1     0.100  step\n      2     0.200  clap\n"), "{}", info(&[]));
    let json: serde_json::Value = serde_json::from_str(&info(&["--json"])).unwrap();
    assert_eq!(json["event_markers"][2], serde_json::json!({"frame": 2, "seconds": 0.2, "name": "clap"}));
}

/// Steps of a motion: the frame, and whether the foot is the left one.
fn steps(motion: &Motion) -> Vec<(usize, bool)> {
    footsteps(motion, Memory::default()).unwrap().into_iter().map(|event| (event.frame, event.name == LEFT_FOOT_DOWN)).collect()
}

/// Checks that the feet alternate and that a foot is low and slow for a while from each step on.
fn are_steps(name: &str, motion: &Motion, least: usize) {
    let steps = steps(motion);
    assert!(steps.len() >= least, "{name}: {steps:?}");
    assert!(steps.windows(2).all(|pair| pair[0].1 != pair[1].1), "{name}: {steps:?}");
    let up = motion.rig.up.axis();
    let foot = |left: bool| {
        let side = if left { "left" } else { "right" };
        let letter = if left { "_l" } else { "_r" };
        let is_foot = |name: &str| name.contains("foot") && (name.contains(side) || name.ends_with(letter));
        motion.rig.joints.iter().position(|joint| is_foot(&joint.name.to_lowercase())).unwrap()
    };
    let poses: Vec<Vec<[f64; 3]>> = (0..motion.frames).map(|frame| positions(&motion.rig, &motion.values, frame)).collect();
    for (frame, left) in steps {
        let foot = foot(left);
        let heights = || poses.iter().map(|pose| pose[foot][up]);
        let (low, high) = (heights().fold(f64::MAX, f64::min), heights().fold(f64::MIN, f64::max));
        let height = poses[frame][foot][up];
        assert!(height < low + 0.35 * (high - low), "{name}: at frame {frame} the foot is {height}, of {low} to {high}");
        // Until a tenth of a second later it is slower than in the mean.
        let speed = |frame: usize| {
            (0..3).map(|axis| (poses[frame][foot][axis] - poses[frame - 1][foot][axis]).powi(2)).sum::<f64>().sqrt()
        };
        let mean = (1..motion.frames).map(speed).sum::<f64>() / (motion.frames - 1) as f64;
        let later = frame + (0.1 / motion.frame_time).round() as usize;
        if later < motion.frames {
            assert!(speed(later) < mean, "{name}: after frame {frame} the foot goes on");
        }
    }
}

#[test]
fn steps_of_our_walk_and_run_alternate_and_are_where_the_foot_lands() {
    are_steps("walk", &load(&own("walk")), 2);
    let run = load(&own("run"));
    let found = steps(&run);
    assert_eq!(found.len(), 2);
    assert_ne!(found[0].1, found[1].1);
    // Mirrored, the other foot comes down at the same frames.
    let other: Vec<_> = found.iter().map(|&(frame, left)| (frame, !left)).collect();
    assert_eq!(steps(&mirror(&run).unwrap()), other);
}

/// Twenty seconds of standing, with a tremor of a millimetre, before the walk.
#[test]
fn a_foot_that_stands_takes_no_steps_however_long_it_does() {
    let walk = Motion { looped: false, ..load(&own("walk")) };
    let still = (20.0 / walk.frame_time) as usize;
    let mut motion = walk.clone();
    for (channel, values) in motion.values.iter_mut().enumerate() {
        let first = values[0];
        let position = walk.rig.channel_kinds()[channel].1.is_position();
        let tremor = |frame: usize| if position { 0.1 * ((frame * (channel + 1)) as f64 * 2.39).sin() } else { 0.0 };
        values.splice(0..0, (0..still).map(|frame| first + tremor(frame)));
    }
    motion.keys.fill(None);
    motion.frames += still;
    let later: Vec<_> = steps(&walk).into_iter().map(|(frame, left)| (frame + still, left)).collect();
    assert!(!later.is_empty());
    assert_eq!(steps(&motion), later);
}

#[test]
fn steps_of_captured_walks_alternate() {
    let data = std::env::var_os("PANTIN_DATA").map_or_else(|| PathBuf::from("../../shared/data"), PathBuf::from);
    for (name, least) in [("bvh_bandai1_walk.bvh", 12), ("bvh_xia_neutral-walk.bvh", 4)] {
        let path = data.join(name);
        if path.is_file() {
            are_steps(name, &load(&path), least);
        } else {
            println!("skipped: no {}; set PANTIN_DATA", path.display());
        }
    }
}

#[test]
fn footsteps_are_events_of_the_clip() {
    let folder = tempfile::tempdir().unwrap();
    let clip = folder.path().join("clip.ptn");
    let output = convert(&own("run"), &clip, &["--footsteps"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("footsteps: 1 left, 1 right"));
    let bytes = std::fs::read(&clip).unwrap();
    let clip = Clip::new_checked(&bytes).unwrap();
    let ids = [LEFT_FOOT_DOWN, RIGHT_FOOT_DOWN].map(|name| clip.event_id(name).unwrap());
    assert!(clip.events().all(|event| ids.contains(&event.id)));
    assert_eq!(clip.event_count(), 2);
}

#[test]
fn footsteps_are_found_along_the_axis_that_all_clips_share() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    // Without a statement of the file, a figure that lies on its back looks as if z were up.
    let put = |name: &str, own_name: &str, turn: f64| {
        let mut motion = load(&own(own_name));
        motion.rig.joints[0].kinds.push(Kind::Xrotation);
        motion.values.insert(1, vec![turn; motion.frames]);
        motion.keys.insert(1, None);
        pantin_tools::output::save_bvh(&motion, &path(name)).unwrap();
        path(name)
    };
    let files = [put("walk.bvh", "walk", 0.0), put("run.bvh", "run", 0.0), put("lying.bvh", "run", 90.0)];
    let run = |options: &[&str], inputs: &[PathBuf], out: &Path| {
        let output = Command::new(env!("CARGO_BIN_EXE_pantin"))
            .arg("convert")
            .args(inputs)
            .args(options)
            .arg("-o")
            .arg(out)
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let said = run(&["--same-form", "--footsteps", "--max-error", "3cm"], &files, &path("out"));
    assert!(said.contains("another axis were up"), "{said}");
    run(&["--up", "y", "--footsteps", "--max-error", "3cm"], &files[2..], &path("alone.ptn"));
    assert_eq!(of(&path("out").join("lying.ptn")), of(&path("alone.ptn")));
}
