//! `--mean-error`: the mean is met from below, the bound holds, and the clip is smaller than one that fills a bound.

use crate::real::files;
use pantin_convert::encode::{clip, rig};
use pantin_convert::fit::fit;
use pantin_convert::fit::{descent::Plan, level::Level};
use pantin_convert::import::ImportOptions;
use pantin_convert::motion::Motion;
use pantin_convert::pose_bound::PoseBound;
use pantin_convert::verify::{Report, verify};
use std::path::{Path, PathBuf};

const SCALAR_PART: f64 = 0.02;
/// The bound of every joint, relative to the mean.
const GUARD: f64 = 6.0;

/// The bytes of the clip, and its errors by the device's decoder.
fn coded(motion: &Motion, plan: Plan) -> (usize, Report) {
    let rig = rig::encode(&motion.rig).unwrap();
    let bytes = clip::encode(&fit(motion, plan, SCALAR_PART, &mut |_| ()).unwrap(), &rig, true).unwrap();
    let report = verify(&bytes, &rig, motion, &plan.bound, SCALAR_PART).unwrap();
    (bytes.len(), report)
}

/// How many bytes a clip with the mean takes, of one with the same mean that fills a bound.
///
/// The mean is at least `least` of what was asked for.
fn saved(path: &Path, mean_cm: f64, least: f64) -> f64 {
    let motion = crate::told::load(path, &ImportOptions::new()).unwrap().motion;
    let plan = Level::DEFAULT.plan(PoseBound { mean_cm: Some(mean_cm), ..PoseBound::places(GUARD * mean_cm) });
    let (bytes, report) = coded(&motion, plan);
    let (mean, max) = (report.mean_joint_cm, report.place_cm.error);
    assert!((least * mean_cm..=mean_cm).contains(&mean), "{}: {mean} cm in the mean; asked for {mean_cm}", path.display());
    let filled = |bound_cm: f64| coded(&motion, Level::DEFAULT.plan(PoseBound::places(bound_cm)));
    // The bound that leads to this mean: two steps of a proportion.
    let first = plan.bound.filled_cm();
    let second = first * mean / filled(first).1.mean_joint_cm;
    let (filled_bytes, filled_report) = filled(second);
    let part = bytes as f64 / filled_bytes as f64;
    println!(
        "{}: {bytes} bytes, mean {mean:.4} cm, greatest {max:.3} cm; filled: {filled_bytes} bytes, mean {:.4} cm",
        path.display(),
        filled_report.mean_joint_cm
    );
    part
}

#[test]
fn own_clips_have_the_mean_that_was_asked_for() {
    for name in ["walk", "run", "greet"] {
        let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("../../motions/{name}.keys"));
        // A clip of 200 bytes has few codes near a mean.
        let part = saved(&path, 0.1, 0.85);
        assert!(part < 1.02, "{name}: {part:.3} of the bytes at an equal mean");
    }
}

#[test]
fn captured_clips_are_a_tenth_smaller_than_with_a_filled_bound() {
    for name in ["bvh_bandai1_walk", "bvh_diema_anger"] {
        let Some(path) = files(&["bvh"]).into_iter().find(|path| path.file_stem().is_some_and(|stem| stem == name)) else {
            continue;
        };
        let part = saved(&path, 0.15, 0.98);
        assert!(part < 0.92, "{name}: {part:.3} of the bytes at an equal mean");
    }
}
