//! Procedural text: the example of docs/PROCEDURAL.md is read as it says, and mistakes are named with their line.

use pantin_convert::import::ImportOptions;
use pantin_convert::motion::Motion;
use std::f64::consts::PI;
use std::path::Path;

/// The first example of the document.
fn example() -> String {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/PROCEDURAL.md")).unwrap();
    text.split("```text\n").nth(1).unwrap().split("```").next().unwrap().to_string()
}

fn load(name: &str, text: &str) -> anyhow::Result<Motion> {
    let path = std::env::temp_dir().join(format!("pantin-procedural-{name}-{}.proc", std::process::id()));
    std::fs::write(&path, text).unwrap();
    let loaded = crate::told::load(&path, &ImportOptions::new());
    std::fs::remove_file(&path).unwrap();
    loaded.map(|imported| imported.motion)
}

fn values<'a>(motion: &'a Motion, name: &str) -> &'a [f64] {
    &motion.values[(0..motion.rig.channels()).find(|&index| motion.rig.channel_name(index) == name).unwrap()]
}

fn refused(name: &str, from: &str, to: &str, part: &str) {
    assert!(example().contains(from), "{name}: `{from}` is not in the example");
    let error = format!("{:#}", load(name, &example().replacen(from, to, 1)).expect_err(name));
    let line = example().split(from).next().unwrap().matches('\n').count() + 1;
    assert!(error.contains(&format!(".proc:{line}: ")), "{name}: no line {line} in: {error}");
    assert!(error.contains(part), "{name}: no `{part}` in: {error}");
}

#[test]
fn the_documents_example_is_read() {
    let motion = load("example", &example()).unwrap();
    assert_eq!((motion.frames, motion.frame_time, motion.looped), (60, 1.0 / 30.0, true));
    assert!(motion.keys.iter().all(Option::is_none));
    for frame in 0..60 {
        let swing = (2.0 * PI * frame as f64 / 60.0).sin();
        let near = |name: &str, value: f64| assert!((values(&motion, name)[frame] - value).abs() < 1e-9, "{name} at {frame}");
        near("hip.Yposition", 90.0 - 2.0 * swing * swing);
        near("hip.Xrotation", 25.0 * swing);
        near("knee.Xrotation", 10.0 + 20.0 * (2.0 * PI * frame as f64 / 60.0).cos().max(0.0));
        near("smile", 0.5 + 0.5 * swing);
    }
}

#[test]
fn mistakes_are_named_with_their_line() {
    refused("magic", "procedural 1", "procedural 2", "expected `procedural 1`");
    refused("word", "loop ", "lop ", "expected cm-per-unit, fps");
    refused("late", "smile =", "fps 20 #", "`fps` stands after the first expression");
    refused("unknown", "25*swing", "25*swong", "unknown name `swong`; expected a function, PI, or one of f, swing, t, u");
    refused("channel", "hip.Xrotation =", "hip.Zrotation =", "no joint or channel `hip.Zrotation`");
    refused("joint", "hip.Xrotation =", "hip =", "found `hip`, a joint");
    refused("twice", "knee.Xrotation =", "hip.Xrotation =", "has an expression already");
    refused("function", "let swing", "let sin", "expected a new name");
    refused("taken", "let swing", "let t", "expected a new name");
    refused("digit", "let swing", "let 2swing", "expected a new name");
    refused("syntax", "25*swing", "25*(swing", "expected an operator or `)`, found the end");
    refused("empty", "25*swing", "", "found the end of the expression");
    refused("brace", "25*swing", "25*{swing}", "expected a number, a name");
    refused("equal", "25*swing", "swing = 2", "expected an operator, found `= 2`");
    refused("infinite", "25*swing", "1/f", "is inf at frame 0; expected a finite number");
    refused("root", "25*swing", "sqrt(swing)", "is NaN at frame");
    refused("large", "25*swing", "10000000000*f", "is 10000000000 at frame 1");
    refused("deep", "25*swing", &format!("{}1{}", "(".repeat(51), ")".repeat(51)), "50 parentheses");
    refused("long", "25*swing", &"1+".repeat(501), "at most 1000 characters");
    refused("frames", "frames 60", "frames 1e7", "expected whole frames");
    let error = load("timing", &example().replace("frames 60", "")).unwrap_err().to_string();
    assert!(error.contains("expected `fps NUMBER` and `frames NUMBER` before the first expression"), "{error}");
}

#[test]
fn the_wave_closes_its_loop_with_both_feet_on_the_floor() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions/wave.proc");
    let motion = crate::told::load(&path, &ImportOptions::new()).unwrap().motion;
    for (channel, values) in motion.values.iter().enumerate() {
        let bend = |a: f64, b: f64, c: f64| (a - 2.0 * b + c).abs();
        let inside = values.windows(3).map(|w| bend(w[0], w[1], w[2])).fold(0.0, f64::max);
        let [y, z] = [values[motion.frames - 2], values[motion.frames - 1]];
        let seam = bend(y, z, values[0]).max(bend(z, values[0], values[1]));
        assert!(seam <= 1.5 * inside + 1e-9, "{}: {seam} at the seam", motion.rig.channel_name(channel));
    }
    let feet: Vec<usize> = (0..motion.rig.joints.len()).filter(|&joint| motion.rig.joint_name(joint).ends_with("foot")).collect();
    let hand = (0..motion.rig.joints.len()).find(|&joint| motion.rig.joint_name(joint) == "right-hand/end").unwrap();
    let places: Vec<_> =
        (0..motion.frames).map(|frame| pantin_convert::fk::positions(&motion.rig, &motion.values, frame)).collect();
    let highest = places.iter().map(|places| places[hand][1]).fold(0.0, f64::max);
    let head = places[0].iter().map(|place| place[1]).fold(0.0, f64::max);
    assert!(highest > head, "the hand rises to {highest}, the head is at {head}");
    for foot in feet {
        let slide = places.iter().map(|now| (0..3).map(|i| (now[foot][i] - places[0][foot][i]).abs()).fold(0.0, f64::max));
        let slide = slide.fold(0.0, f64::max);
        assert!(slide < 2.0, "{} slides {slide} cm", motion.rig.joint_name(foot));
    }
}
