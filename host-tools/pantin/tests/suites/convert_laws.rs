//! What a conversion promises: the bound as decoded, the same bytes on any number of threads, rigs that depend on the figure alone.

use pantin_convert::encode::{clip, rig};
use pantin_convert::fit::{fit, level::Level};
use pantin_convert::import::ImportOptions;
use pantin_convert::motion::{Kind, Motion};
use pantin_convert::pose_bound::PoseBound;
use pantin_convert::verify::verify;
use std::path::{Path, PathBuf};

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn load(path: &Path) -> Motion {
    crate::told::load(path, &ImportOptions::new()).unwrap_or_else(|error| panic!("{error:#}")).motion
}

fn own(name: &str) -> Motion {
    load(&repository().join("motions").join(name))
}

/// Captured clips, or none where they are not at hand.
fn captured(prefix: &str) -> Vec<PathBuf> {
    let folder = std::env::var_os("PANTIN_DATA").map_or_else(|| repository().join("../shared/data"), PathBuf::from);
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("skipped: no captured clips in {}; set PANTIN_DATA", folder.display());
        return Vec::new();
    };
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| entry.ok().map(|entry| entry.path())).collect();
    paths.retain(|path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(prefix)));
    paths.sort();
    paths
}

fn convert(motion: &Motion, bound_cm: f64, level: Level) -> Vec<u8> {
    let rig = rig::encode(&motion.rig).unwrap();
    let coded =
        fit(motion, level.plan(PoseBound::places(bound_cm)), 0.02, &mut |_| ()).unwrap_or_else(|error| panic!("{error:#}"));
    let bytes = clip::encode(&coded, &rig, false).unwrap();
    let report = verify(&bytes, &rig, motion, &PoseBound::places(bound_cm), 0.02).unwrap_or_else(|error| panic!("{error:#}"));
    assert!(report.place_cm.error <= bound_cm && report.mean_cm <= report.place_cm.error);
    bytes
}

#[test]
fn own_motions_keep_every_bound_at_every_effort_and_cost_less_the_wider_it_is() {
    for name in ["walk.keys", "run.keys"] {
        let motion = own(name);
        for level in [Level::FAST, Level::DEFAULT] {
            let sizes: Vec<usize> = [0.1, 0.5, 3.0].iter().map(|&bound| convert(&motion, bound, level).len()).collect();
            assert!(sizes.windows(2).all(|pair| pair[1] < pair[0]), "{name} {level:?}: {sizes:?}");
        }
    }
}

/// The best round of several is taken. The default may have found it already, as with the walk.
#[test]
fn further_rounds_take_no_more_bytes_and_find_a_smaller_run() {
    let sizes = ["walk.keys", "run.keys"].map(|name| {
        let motion = own(name);
        [Level::DEFAULT, Level::BEST].map(|level| convert(&motion, 0.5, level).len())
    });
    assert!(sizes.iter().all(|[default, best]| best <= default), "{sizes:?}");
    let [_, [default, best]] = sizes;
    assert!(best < default, "{sizes:?}");
}

#[test]
fn bytes_do_not_depend_on_the_number_of_threads() {
    let motion = own("walk.keys");
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| convert(&motion, 0.5, Level::DEFAULT))
    };
    let one = with(1);
    assert!(one == with(2) && one == with(5));
}

#[test]
fn captured_clips_keep_every_bound() {
    for path in captured("bvh_") {
        let motion = load(&path);
        for bound in [0.5, 3.0] {
            convert(&motion, bound, Level::FAST);
        }
    }
}

#[test]
fn clips_of_one_figure_share_its_rig() {
    let rigs: Vec<Vec<u8>> = captured("bvh_bandai1_").iter().map(|path| rig::encode(&load(path).rig).unwrap()).collect();
    assert!(rigs.windows(2).all(|pair| pair[0] == pair[1]));
}

#[test]
fn angles_that_begin_turns_away_are_kept() {
    let mut motion = own("walk.keys");
    let angles: Vec<usize> = motion
        .rig
        .channel_kinds()
        .iter()
        .enumerate()
        .filter(|(_, (_, kind))| kind.is_rotation())
        .map(|(channel, _)| channel)
        .collect();
    for (count, channel) in angles.into_iter().enumerate() {
        // From -7.4 to 7.4 turns: past the integer's range, and on either side of its edge.
        let turns = (count % 75) as f64 * 0.2 - 7.4;
        motion.values[channel].iter_mut().for_each(|x| *x += turns * 360.0);
        motion.keys[channel] = None;
    }
    for bound in [0.2, 0.3, 0.5, 0.7, 1.0] {
        convert(&motion, bound, Level::FAST);
    }
}

#[test]
fn rotations_are_coded_as_asked() {
    use pantin_convert::Rotations;
    use pantin_convert::fit::descent::Plan;
    let mut motion = own("walk.keys");
    // Three angles a joint, which our motions do without.
    let joint =
        motion.rig.joints.iter().position(|joint| joint.kinds.len() == 2 && joint.kinds.iter().all(|kind| kind.is_rotation()));
    let joint = joint.expect("a joint of two angles");
    let missing = [Kind::Xrotation, Kind::Yrotation, Kind::Zrotation]
        .into_iter()
        .find(|kind| !motion.rig.joints[joint].kinds.contains(kind));
    let channel = motion.rig.first_channels()[joint] + 2;
    motion.rig.joints[joint].kinds.extend(missing);
    motion.values.insert(channel, (0..motion.frames).map(|frame| 9.0 * (frame as f64 * 0.1).sin()).collect());
    motion.keys.insert(channel, None);
    let chosen = |rotations| {
        let coded = fit(&motion, Plan { rotations, ..Level::FAST.plan(PoseBound::places(0.5)) }, 0.02, &mut |_| ()).unwrap();
        let bytes = clip::encode(&coded, &rig::encode(&motion.rig).unwrap(), false).unwrap();
        verify(&bytes, &rig::encode(&motion.rig).unwrap(), &motion, &PoseBound::places(0.5), 0.02)
            .unwrap_or_else(|error| panic!("{error:#}"));
        coded.exponentials.iter().filter(|&&chosen| chosen).count()
    };
    let (euler, exponential) = (chosen(Rotations::Euler), chosen(Rotations::Exponential));
    assert_eq!((euler, exponential), (0, 1));
}
