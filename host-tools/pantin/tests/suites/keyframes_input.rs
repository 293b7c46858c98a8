//! Key-frame text: the example of docs/KEYFRAMES.md is read as it says, and mistakes are named with their line.

use crate::told::Told;
use pantin_convert::import::ImportOptions;
use pantin_convert::motion::{Interpolation, Keys, Kind, Motion};

/// The first example of the document.
fn example() -> String {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/KEYFRAMES.md")).unwrap();
    text.split("```text\n").nth(1).unwrap().split("```").next().unwrap().to_string()
}

fn load(name: &str, text: &str) -> anyhow::Result<Told> {
    let folder = std::env::temp_dir().join(format!("pantin-keyframes-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(format!("{name}.keys"));
    std::fs::write(&path, text).unwrap();
    let loaded = crate::told::load(&path, &ImportOptions::new());
    std::fs::remove_file(&path).unwrap();
    loaded
}

fn refused(name: &str, from: &str, to: &str, part: &str) {
    assert!(example().contains(from), "{name}: `{from}` is not in the example");
    let error = format!("{:#}", load(name, &example().replacen(from, to, 1)).expect_err(name));
    let line = example().split(from).next().unwrap().matches('\n').count() + 1;
    assert!(error.contains(&format!("{name}.keys:{line}: ")), "{name}: no line {line} in: {error}");
    assert!(error.contains(part), "{name}: no `{part}` in: {error}");
}

fn index(motion: &Motion, name: &str) -> usize {
    (0..motion.rig.channels()).find(|&index| motion.rig.channel_name(index) == name).unwrap()
}

fn values<'a>(motion: &'a Motion, name: &str) -> &'a [f64] {
    &motion.values[index(motion, name)]
}

fn keys<'a>(motion: &'a Motion, name: &str) -> &'a [(usize, f64)] {
    match &motion.keys[index(motion, name)] {
        Some(Keys::OnFrames { keys, .. }) => keys,
        other => panic!("{name} has no keys on frames: {other:?}"),
    }
}

#[test]
fn the_documents_example_is_read() {
    let Told { motion, units, warnings, .. } = load("example", &example()).unwrap();
    assert!(warnings.is_empty());
    assert_eq!(units, "units: 1 cm, as the file says");
    assert_eq!((motion.frames, motion.frame_time, motion.looped), (60, 1.0 / 30.0, true));
    assert_eq!(motion.rig.joints[0].kinds, [Kind::Yposition, Kind::Zposition, Kind::Xrotation]);
    assert_eq!(motion.rig.joints[2].parent, Some(1));
    assert!(motion.rig.joints[2].end_site);
    let forward = values(&motion, "hip.Zposition");
    assert_eq!((forward[0], forward[30], forward[59]), (0.0, 60.0, 118.0));
    assert_eq!(keys(&motion, "hip.Zposition"), [(0, 0.0), (59, 118.0)]);
    let knee = keys(&motion, "knee.Xrotation");
    assert_eq!(knee[..3], [(0, 5.0), (20, 40.0), (35, 10.0)]);
    assert!(knee.iter().all(|&(frame, value)| (values(&motion, "knee.Xrotation")[frame] - value).abs() < 1e-12));
    assert_eq!(knee[3].0, 59);
    // A position without keys stays at its offset.
    assert_eq!(values(&motion, "hip.Yposition"), [90.0; 60]);
    assert_eq!(motion.keys[0], None);
    assert!(matches!(motion.keys[4], Some(Keys::OnFrames { interpolation: Interpolation::Natural, .. })));
}

#[test]
fn without_a_loop_curves_end_at_the_last_frame() {
    let text = example().replace("loop ", "# ").replace("  60  120", "  59  118").replace("  35   20  10", "  59   20  10");
    let motion = load("open", &text.replace("  30    0.8", "  59    0.8")).unwrap().motion;
    assert!(!motion.looped);
    assert_eq!(keys(&motion, "hip.Xrotation"), [(0, -20.0), (20, 0.0), (59, 20.0)]);
    let error = format!("{:#}", load("short", &text).unwrap_err());
    assert!(error.contains("short.keys:21: the last key of this block is at frame 30; expected one at 59"), "{error}");
}

#[test]
fn the_unit_is_guessed_where_the_file_is_silent() {
    let read = load("units", &example().replace("cm-per-unit 1", "")).unwrap();
    assert!(read.units.contains("high at rest"), "{}", read.units);
}

#[test]
fn mistakes_are_named_with_their_line() {
    refused("magic", "keyframes 1", "keyframes 2", "expected `keyframes 1`");
    refused("fps", "fps 30", "fps -30", "expected a number above 0 after `fps`, found `-30`");
    refused("frames", "frames 60", "frames 1.5", "expected whole frames");
    refused("word", "loop ", "lop ", "expected cm-per-unit, fps");
    refused("parent", "parent hip", "parent hop", "no joint `hop`");
    refused("orphan", "knee parent hip", "knee", "only the first joint has none");
    refused("taken", "joint knee", "joint hip", "the name `hip` is taken");
    refused("offset", "offset 0 -45 0 channels", "offset 0 -45 channels", "expected a number, found `channels`");
    refused("kind", "channels Xrotation", "channels Wrotation", "found `Wrotation`");
    refused("interpolation", "keys discrete", "keys cubic", "found `cubic`");
    refused("channel", "hip.Zposition", "hip.Xposition", "no joint or channel `hip.Xposition`");
    refused("twice", "keys natural smile", "keys natural knee", "channel `knee.Xrotation` has keys already");
    refused("count", "  20    0  40", "  20    0", "expected 2 values after the frame, one a channel, found 1");
    refused("number", "  20    0  40", "  20    0  4O", "expected a number, found `4O`");
    refused("nan", "  20    0  40", "  20    0  nan", "expected a finite number");
    refused("order", "  35   20  10", "  20   20  10", "expected a frame after 20, found 20");
    refused("outside", "  60  120", "  61  120", "expected a frame of 0 to 60, found `61`");
    refused("first", "  0   -20", "  1   -20", "expected frame 0 as the first key");
    refused("late", "keys natural smile", "fps 20", "`fps` stands after the first `keys`");
}

#[test]
fn what_is_missing_is_named() {
    let error = |name: &str, text: &str| format!("{:#}", load(name, text).unwrap_err());
    assert!(error("nothing", "keyframes 1\n").contains("expected `frames NUMBER`"));
    assert!(error("still", "keyframes 1\nfps 1\nframes 1\n").contains("nothing can move"));
    let rows = "keyframes 1\nfps 1\nframes 3\nscalar a scale 1\nkeys linear a\n\n\n";
    assert!(error("rows", rows).contains("rows.keys:5: expected rows of keys below this line"));
    let quaternion =
        "keyframes 1\nfps 1\nframes 3\njoint a offset 0 0 0 channels Wquaternion Xquaternion Yquaternion Zquaternion\n";
    assert!(
        error("group", &format!("{quaternion}keys linear a.Xquaternion\n")).contains(":5: `a.Xquaternion` is one of a group")
    );
    let motion = load("whole", &format!("{quaternion}keys linear a\n0 1 0 0 0\n2 0 1 0 0\n")).unwrap().motion;
    assert_eq!(motion.values[1], [0.0, 0.5, 1.0]);
    assert_eq!(load("silent", quaternion).unwrap().motion.values[0], [1.0; 3]);
}

#[test]
fn lines_of_which_there_is_one_stand_once() {
    refused("fps-twice", "frames 60 ", "fps 25\nframes 60 ", "a second `fps`");
    for line in ["fps 30", "frames 60", "loop", "cm-per-unit 1"] {
        let first = line.split(' ').next().unwrap();
        let error = load("twice", &example().replacen("\njoint hip", &format!("\n{line}\njoint hip"), 1)).unwrap_err();
        assert!(format!("{error:#}").contains(&format!("a second `{first}`")), "{error:#}");
    }
    refused("channel-twice", "Zposition Xrotation", "Zposition Zposition", "`hip` has the channel Zposition twice");
}

#[test]
fn keys_of_a_scalar_stay_in_its_scale() {
    refused("above", "  30    0.8", "  30    5", "5 of `smile` is outside -1..1");
    refused("below", "  30    0.8", "  30    -1.5", "-1.5 of `smile` is outside -1..1");
    for value in ["1", "-1", "1.0"] {
        load("ends", &example().replacen("  30    0.8", &format!("  30    {value}"), 1)).unwrap();
    }
    // Joints have no such bounds.
    load("joint", &example().replacen("  20    0  40", "  20    0  4000", 1)).unwrap();
}
