//! Bounds a channel (docs/METHOD.md 2.3): known curves exactly, delta and epsilon, each measured on what the decoder plays.

use pantin_convert::channel_error::{self, Report};
use pantin_convert::encode::{clip, rig};
use pantin_convert::fit::bounds::{Bounds, EXACT_DEGREES};
use pantin_convert::fit::chain::Constraint;
use pantin_convert::fit::channelwise;
use pantin_convert::import::ImportOptions;
use pantin_convert::motion::Motion;
use std::path::Path;

fn own(name: &str) -> Motion {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../motions/{name}.keys"));
    crate::told::load(&path, &ImportOptions::new()).unwrap().motion
}

/// A motion of one block of keys.
fn keyed(interpolation: &str, looped: bool) -> Motion {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("motion.keys");
    let head = "keyframes 1\nfps 30\nframes 61\ncm-per-unit 1\njoint hip offset 0 90 0 channels Yposition Xrotation\n";
    let tail = "joint knee parent hip offset 0 -45 0 channels Xrotation\nscalar smile scale 1\n";
    let rows = "0 90 -20 5 0\n13 88.5 14 40 0.5\n14 88.25 15 41 0.6\n42 93 200 10 -0.25\n60 91 340 5 0\n";
    let keys = format!("keys {interpolation} hip knee smile\n{rows}");
    std::fs::write(&path, format!("{head}{tail}{}{keys}", if looped { "loop\n" } else { "" })).unwrap();
    crate::told::load(&path, &ImportOptions::new()).unwrap().motion
}

/// Bytes of the motion apart from its rig, and the errors; a broken bound fails the test.
fn coded(motion: &Motion, bounds: &Bounds) -> (usize, Report) {
    let coded = channelwise::fit(motion, bounds, &|| ()).unwrap();
    let rig = rig::encode(&motion.rig).unwrap();
    let bytes = clip::encode(&coded, &rig, true).unwrap();
    let report = channel_error::verify(&bytes, &rig, motion, bounds).unwrap();
    assert!(report.worst.part > 0.0 && report.worst.part <= 1.0);
    (bytes.len(), report)
}

#[test]
fn every_interpolation_is_exact_but_for_rounding() {
    for interpolation in ["linear", "catmull-rom", "natural", "discrete"] {
        for looped in [false, true] {
            let motion = keyed(interpolation, looped);
            let bounds = Bounds::exact(&motion).unwrap();
            assert_eq!(bounds.greatest[1..3], [EXACT_DEGREES; 2]);
            assert_eq!(bounds.greatest[3], 1.0 / 65536.0, "a scalar's range is its full scale");
            let (bytes, report) = coded(&motion, &bounds);
            println!("{interpolation}{}: {bytes} bytes, {:?}", if looped { ", looped" } else { "" }, report.worst);
            // 61 frames of 4 channels at 16 bits.
            assert!(bytes < 488 / 2, "{interpolation}: {bytes} bytes");
        }
    }
}

#[test]
fn the_run_is_exact_in_less_than_half_of_its_frames() {
    let motion = own("run");
    let (bytes, report) = coded(&motion, &Bounds::exact(&motion).unwrap());
    println!("run: {bytes} bytes, {:?}", report.worst);
    assert!(bytes < 26 * 33 * 2 / 2);
}

#[test]
fn a_moving_channel_without_keys_is_named() {
    let mut motion = own("run");
    motion.keys[3] = None;
    let error = Bounds::exact(&motion).unwrap_err().to_string();
    assert!(error.contains("hips.Yrotation moves and has no keys"), "{error}");
    motion.values[3].fill(1.0);
    Bounds::exact(&motion).unwrap();
}

#[test]
fn delta_holds_at_every_frame() {
    let mut before = usize::MAX;
    for delta in [0.1, 0.5, 2.0] {
        let motion = own("run");
        let bounds = Bounds::of(&motion, Constraint::Positions, delta);
        let (bytes, report) = coded(&motion, &bounds);
        println!("delta {delta}: {bytes} bytes, {:?}", report.worst);
        assert!(bytes < before);
        before = bytes;
    }
}

#[test]
fn epsilon_holds_for_second_differences_and_positions_drift() {
    let motion = own("run");
    let bounds = Bounds::of(&motion, Constraint::Accelerations, 0.1);
    let (bytes, report) = coded(&motion, &bounds);
    println!("epsilon 0.1: {bytes} bytes, {:?}, drift {:?}", report.worst, report.drift);
    assert!(report.drift[0].part > 1.0 && report.drift.is_sorted_by(|one, other| one.part >= other.part));
    let moved = report.drift.iter().find(|worst| motion.rig.channel_name(worst.channel) == "hips.Xposition").unwrap();
    assert_eq!(moved.in_unit(&motion), (moved.error * motion.rig.cm_per_unit, "cm"));
    let sentence = report.drift_sentence(&motion);
    assert!(sentence.contains(" degrees at frame ") && sentence.ends_with(" more"), "{sentence}");
    assert!(bytes < coded(&motion, &Bounds::of(&motion, Constraint::Accelerations, 0.01)).0);
}

#[test]
fn a_bound_below_what_a_clip_holds_is_refused_with_channel_frame_and_error() {
    let motion = own("run");
    let bounds = Bounds::of(&motion, Constraint::Accelerations, 2e-8);
    let refused = channelwise::fit(&motion, &bounds, &|| ()).map(|coded| {
        let rig = rig::encode(&motion.rig).unwrap();
        let bytes = clip::encode(&coded, &rig, true).unwrap();
        channel_error::verify(&bytes, &rig, &motion, &bounds)
    });
    let error = match refused {
        Err(error) | Ok(Err(error)) => error.to_string(),
        Ok(Ok(report)) => panic!("kept: {report:?}"),
    };
    assert!(error.contains("channel ") && error.contains(" at frame ") && error.contains("the bound is"), "{error}");
}

#[test]
fn the_shortest_clips_work() {
    for frames in 1..=4 {
        let mut motion = keyed("discrete", false);
        motion.frames = frames;
        motion.values.iter_mut().for_each(|values| values.truncate(frames));
        for bounds in [Bounds::exact(&motion).unwrap(), Bounds::of(&motion, Constraint::Accelerations, 0.1)] {
            coded(&motion, &bounds);
        }
    }
}
