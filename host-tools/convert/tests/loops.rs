//! Loops of captured motions: the tools that propose, close and refuse them use one rule.

use pantin_convert::edit::cut::cut;
use pantin_convert::edit::find_loop::find;
use pantin_convert::import::{ImportOptions, load};
use pantin_convert::motion::Motion;
use pantin_convert::{Length, Options, prepare};
use std::path::{Path, PathBuf};

/// Captured motions by their names; none where the folder lacks them.
fn captured(names: &[&str]) -> Vec<Motion> {
    let data = std::env::var_os("PANTIN_DATA")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"), PathBuf::from);
    if !names.iter().all(|name| data.join(name).is_file()) {
        println!("skipped: no captured clips in {}; set PANTIN_DATA", data.display());
        return Vec::new();
    }
    names.iter().map(|name| load(&data.join(name), &ImportOptions::new()).unwrap().motion).collect()
}

/// Whether a motion closes to a loop within a bound in cm.
fn closes(motion: &Motion, cm: f64) -> Result<(), String> {
    let mut options = Options::new();
    (options.looped, options.max_error) = (true, Some(Length::Cm(cm)));
    prepare(motion.clone(), &options).map(drop).map_err(|error| error.to_string())
}

#[test]
fn a_looser_bound_takes_what_a_tighter_one_takes() {
    for motion in captured(&["bvh_bandai1_walk.bvh"]) {
        // The way of this cycle goes 2 to 3 cm to the side.
        let motion = cut(&motion, Some(65), Some(129)).unwrap();
        let mut taken = None;
        for tenths in 5..60 {
            let cm = f64::from(tenths) / 10.0;
            match (closes(&motion, cm), taken) {
                (Ok(()), None) => taken = Some(cm),
                (Err(error), Some(least)) => panic!("{cm} cm is refused, and {least} cm is not: {error}"),
                _ => {}
            }
        }
        let least = taken.unwrap();
        assert!(least <= 1.5, "{least} cm");
    }
}

#[test]
fn every_proposal_closes_within_the_bound_that_it_names() {
    for motion in
        captured(&["bvh_bandai1_walk.bvh", "bvh_bandai1_kick.bvh", "bvh_xia_neutral-walk.bvh", "bvh_mixamo-beta_run-loop.bvh"])
    {
        let cuts = find(&motion, &Options::new()).unwrap();
        assert!(cuts.len() > 1);
        for found in cuts {
            let part = cut(&motion, Some(found.from), Some(found.to)).unwrap();
            let cm = found.bound_cm.max(1e-3) * 1.001;
            closes(&part, cm).unwrap_or_else(|error| panic!("{found:?} at {cm} cm: {error}"));
            let tight = found.bound_cm * 0.97;
            assert!(tight < 0.1 || closes(&part, tight).is_err(), "{found:?} closes at {tight} cm, too");
        }
    }
}

/// A joint whose second angle is a quarter turn has no single triple of angles: a cycle of it comes round all the same.
#[test]
fn a_perfect_cycle_closes_whatever_its_angles() {
    let figure = "joint hips offset 0 90 0 channels Xposition Zrotation Xrotation Yrotation\nend parent hips offset 0 60 5000\n";
    for second in [0.0, 89.9999999, 90.0, -90.0] {
        let rows: String = (0..=24)
            .map(|frame| {
                let turn = 40.0 * (f64::from(frame % 24) * 15.0).to_radians().sin();
                format!(" {frame} {} {} {second} {}\n", 3 * frame, turn + 123.456, turn - 77.7)
            })
            .collect();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("cycle.keys");
        std::fs::write(&path, format!("keyframes 1\nfps 30\nframes 25\ncm-per-unit 1\n{figure}keys linear hips\n{rows}"))
            .unwrap();
        let motion = load(&path, &ImportOptions::new()).unwrap().motion;
        closes(&motion, 0.5).unwrap_or_else(|error| panic!("{second}: {error}"));
        let cuts = find(&motion, &Options::new()).unwrap();
        assert!(cuts.iter().any(|cut| (cut.from, cut.to) == (0, 24) && cut.bound_cm < 1e-3), "{cuts:?}");
    }
}

/// A cut whose ends are a half turn apart cannot be closed: others are proposed all the same.
#[test]
fn a_stretch_that_cannot_be_closed_is_passed_over() {
    for motion in captured(&["bvh_cmu131_start-walk-stop.bvh"]) {
        let cuts = find(&motion, &Options::new()).unwrap_or_else(|error| panic!("{error:#}"));
        assert!(cuts.len() > 1 && cuts.iter().any(|cut| !cut.still), "{cuts:?}");
    }
}

/// A figure that stands all the time has a loop for standing, too.
#[test]
fn a_figure_that_only_stands_is_said_to_stand() {
    let idle = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions/library/idle.keys");
    let motion = load(&idle, &ImportOptions::new()).unwrap().motion;
    let cuts = find(&motion, &Options::new()).unwrap();
    assert!(cuts.iter().all(|cut| cut.still), "{cuts:?}");
    let walk = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions/walk.keys");
    let cuts = find(&load(&walk, &ImportOptions::new()).unwrap().motion, &Options::new()).unwrap();
    assert!(cuts.iter().all(|cut| !cut.still), "{cuts:?}");
}
