//! Our library of body motions (`motions/library`): at 0.5 cm it is one bank of at most 4 KiB, feet that bear weight stay where they
//! are, and the motions chain.

use pantin::{Bank, LEFT_FOOT_DOWN, RIGHT_FOOT_DOWN};
use pantin_convert::expand::expand;
use pantin_convert::fk::{distance, positions};
use pantin_convert::import::ImportOptions;
use pantin_convert::motion::Motion;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Names of all motions, in the bank's order, and whether they loop.
const MOTIONS: [(&str, bool); 16] = [
    ("bow", false),
    ("dance", true),
    ("fall", false),
    ("get_up", false),
    ("idle", true),
    ("jump", false),
    ("leap", false),
    ("run", true),
    ("sit_down", false),
    ("stand_up", false),
    ("start", false),
    ("stop", false),
    ("turn_left", false),
    ("turn_right", false),
    ("walk", true),
    ("wave", false),
];
/// Most bytes of the bank, its rig included: 273 for each motion.
const BANK: usize = 4369;
/// A point of the sole bears weight while it is lower than this and lowest of its foot, in cm.
const DOWN: f64 = 1.0;
/// Farthest that such a point moves over the floor while it bears weight, in cm.
const SLIDE: f64 = 3.0;
/// Lowest that a foot gets, in cm.
const FLOOR: f64 = -1.0;
/// Farthest that any joint of a pose is from where it is in the pose that it chains with, in cm: twice the bound of a clip, and rounding.
const SAME: f64 = 1.5;

fn motions() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions")
}

/// The bank's bytes, and its clips as motions.
fn library() -> (Vec<u8>, BTreeMap<String, Motion>) {
    let folder = tempfile::tempdir().unwrap();
    let bank = folder.path().join("moves.ptb");
    let mut command = Command::new(env!("CARGO_BIN_EXE_pantin"));
    command
        .arg("convert")
        .arg(motions().join("library"))
        .args(["--places-only", "--same-form", "--max-error", "0.5cm", "-o"])
        .arg(&bank);
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let bytes = std::fs::read(bank).unwrap();
    let opened = Bank::new_checked(&bytes).unwrap();
    let clips = MOTIONS.iter().map(|(name, _)| (name.to_string(), expand(&opened.clip(name).unwrap()).unwrap())).collect();
    (bytes, clips)
}

/// World positions of all joints at every frame.
fn places(motion: &Motion) -> Vec<Vec<[f64; 3]>> {
    (0..motion.frames).map(|frame| positions(&motion.rig, &motion.values, frame)).collect()
}

/// Positions of all joints at a frame, with the root's way and heading left out.
fn pose(motion: &Motion, frame: usize) -> Vec<[f64; 3]> {
    let mut values = motion.values.clone();
    values[..motion.rig.joints[0].kinds.len()].iter_mut().for_each(|channel| channel.fill(0.0));
    positions(&motion.rig, &values, frame)
}

/// Largest distance of any joint between two poses.
fn apart(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    a.iter().zip(b).map(|(a, b)| distance(*a, *b)).fold(0.0, f64::max)
}

/// Heel and tip of the toes of a foot, which are the End Sites after the foot and after the toes.
fn sole(motion: &Motion, side: &str) -> [usize; 2] {
    ["foot", "toes"].map(|part| {
        let name = format!("{side}-{part}");
        1 + (0..motion.rig.joints.len()).find(|&joint| motion.rig.joints[joint].name == name).unwrap()
    })
}

/// Farthest that a point of a sole moves over the floor while it bears weight.
fn slide(places: &[Vec<[f64; 3]>], sole: [usize; 2]) -> f64 {
    let mut farthest: f64 = 0.0;
    for point in sole {
        let mut stance: Vec<[f64; 3]> = vec![];
        for frame in places {
            let lowest = sole.map(|point| frame[point][1]).into_iter().fold(f64::MAX, f64::min);
            if frame[point][1] > DOWN || frame[point][1] > lowest + DOWN / 2.0 {
                stance.clear();
                continue;
            }
            let [x, _, z] = frame[point];
            farthest = stance.iter().map(|other| (x - other[0]).hypot(z - other[2])).fold(farthest, f64::max);
            stance.push(frame[point]);
        }
    }
    farthest
}

#[test]
fn the_library_is_one_small_bank_of_motions_that_stand_on_their_feet_and_chain() {
    let (bytes, clips) = library();
    let bank = Bank::new_checked(&bytes).unwrap();
    assert!(bytes.len() <= BANK, "{} bytes", bytes.len());
    assert_eq!(bank.entries().map(|entry| entry.name().to_string()).collect::<Vec<_>>(), MOTIONS.map(|(name, _)| name));
    for (name, looped) in MOTIONS {
        assert_eq!(bank.clip(name).unwrap().looped(), looped, "{name}");
    }

    for (name, motion) in &clips {
        let places = places(motion);
        for side in ["left", "right"] {
            let sole = sole(motion, side);
            let lowest = places.iter().flat_map(|frame| sole.map(|point| frame[point][1])).fold(f64::MAX, f64::min);
            let slide = slide(&places, sole);
            println!("{name}: {side} foot slides {slide:.2} cm, lowest {lowest:.2} cm");
            assert!(lowest > FLOOR, "{name}: the {side} foot sinks to {lowest} cm");
            assert!(slide < SLIDE, "{name}: the {side} foot slides {slide} cm");
        }
    }

    let first = |name: &str| pose(&clips[name], 0);
    let last = |name: &str| pose(&clips[name], clips[name].frames - 1);
    let idle = first("idle");
    for name in ["bow", "fall", "jump", "sit_down", "start", "turn_left", "turn_right", "wave", "dance"] {
        assert!(apart(&idle, &first(name)) < SAME, "{name} begins {} cm from idle", apart(&idle, &first(name)));
    }
    for name in ["bow", "get_up", "jump", "stand_up", "stop", "turn_left", "turn_right", "wave", "idle"] {
        assert!(apart(&idle, &last(name)) < SAME, "{name} ends {} cm from idle", apart(&idle, &last(name)));
    }
    // The last frame of `start` is the one before the walk's first.
    let running = pose(&clips["run"], 11);
    let chained = [("sit_down", first("stand_up")), ("fall", first("get_up")), ("start", last("walk")), ("leap", running)];
    for (name, next) in chained {
        assert!(apart(&last(name), &next) < SAME, "{name} ends {} cm from what follows", apart(&last(name), &next));
    }
    assert!(
        apart(&first("walk"), &first("stop")) < SAME,
        "stop begins {} cm from the walk",
        apart(&first("walk"), &first("stop"))
    );
}

#[test]
fn motions_that_step_say_when_each_foot_comes_down() {
    let expected: [(&str, &[&str]); 6] = [
        ("walk", &[LEFT_FOOT_DOWN, RIGHT_FOOT_DOWN]),
        ("run", &[LEFT_FOOT_DOWN, RIGHT_FOOT_DOWN]),
        ("start", &[LEFT_FOOT_DOWN]),
        ("stop", &[LEFT_FOOT_DOWN, RIGHT_FOOT_DOWN]),
        ("turn_left", &[LEFT_FOOT_DOWN, RIGHT_FOOT_DOWN]),
        ("turn_right", &[RIGHT_FOOT_DOWN, LEFT_FOOT_DOWN]),
    ];
    for (name, events) in expected {
        let motion = crate::told::load(&motions().join("library").join(name).with_extension("keys"), &ImportOptions::new())
            .unwrap()
            .motion;
        assert_eq!(motion.events.iter().map(|event| event.name.as_str()).collect::<Vec<_>>(), events, "{name}");
    }
}

#[test]
fn the_library_has_the_skeleton_of_the_walk() {
    let rig = |path: &str| crate::told::load(&motions().join(path), &ImportOptions::new()).unwrap().motion.rig;
    let (walk, ours) = (rig("walk.keys"), rig("library/walk.keys"));
    assert_eq!(walk.joints.len(), ours.joints.len());
    for (walk, ours) in walk.joints.iter().zip(&ours.joints) {
        assert_eq!((&walk.name, walk.parent, walk.offset), (&ours.name, ours.parent, ours.offset));
        assert!(walk.kinds.iter().all(|kind| ours.kinds.contains(kind)), "{}", walk.name);
    }
}
