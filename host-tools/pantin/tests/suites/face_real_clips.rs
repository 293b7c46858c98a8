//! Captured and synthetic faces, where they are at hand: converted, played, written as a table and read back within the bound.

use crate::real::files;
use pantin_convert::encode::{clip, rig};
use pantin_convert::expand::expand;
use pantin_convert::export;
use pantin_convert::fit::{fit, level::Level};
use pantin_convert::import::ImportOptions;
use pantin_convert::pose_bound::PoseBound;
use pantin_convert::verify::verify;
use std::path::PathBuf;

/// Part of full scale.
const BOUND: f64 = 0.02;
/// A third more than the quick search took for any face, the rig left out: more says that something is coded badly.
const MOST_BYTES_A_SECOND: f64 = 400.0;

/// The `face_*.csv` and `fap_*.fap` files of `$PANTIN_DATA`, or of `shared/data` beside the repository.
fn faces() -> Vec<PathBuf> {
    let wanted = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        name.starts_with("face_") && name.ends_with(".csv") || name.starts_with("fap_") && name.ends_with(".fap")
    };
    let faces: Vec<PathBuf> = files(&["csv", "fap"]).into_iter().filter(wanted).collect();
    if faces.is_empty() {
        println!("skipped: neither face_*.csv nor fap_*.fap in $PANTIN_DATA");
    }
    faces
}

#[test]
fn faces_come_back_within_the_bound() {
    let table = std::env::temp_dir().join(format!("pantin-face-real-clips-{}.csv", std::process::id()));
    for path in faces() {
        let name = path.display();
        let motion = crate::told::load(&path, &ImportOptions::new()).unwrap().motion;
        assert!(motion.rig.joints.is_empty() && motion.frames > 100, "{name}");
        let bytes = rig::encode(&motion.rig).unwrap();
        // A second or two are enough here: the rest of a recording is like its beginning.
        let mut short = motion.clone();
        short.frames = motion.frames.min(200);
        short.values.iter_mut().for_each(|values| values.truncate(short.frames));
        let coded = fit(&short, Level::FAST.plan(PoseBound::places(1.0)), BOUND, &mut |_| ()).unwrap();
        let clip = clip::encode(&coded, &bytes, true).unwrap();
        let report = verify(&clip, &bytes, &short, &PoseBound::places(1.0), BOUND).unwrap();
        let rate = clip.len() as f64 / (short.frames as f64 * short.frame_time);
        println!(
            "{name}: {} bytes, {rate:.0} a second, {:.3} % at {}",
            clip.len(),
            100.0 * report.max_scalar,
            report.worst_scalar
        );
        assert!(rate < MOST_BYTES_A_SECOND, "{name}: {rate} bytes a second");
        let played = expand(&pantin::Clip::with_rig(&clip, &bytes).unwrap()).unwrap();
        let mut written = Vec::new();
        export::table::write(&played, &mut written).unwrap();
        std::fs::write(&table, written).unwrap();
        let back = crate::told::load(&table, &ImportOptions::new()).unwrap().motion;
        assert_eq!(back.frames, short.frames, "{name}");
        assert!((back.frame_time / short.frame_time - 1.0).abs() < 1e-6, "{name}");
        for (channel, scalar) in short.rig.scalars.iter().enumerate() {
            assert_eq!(back.rig.scalars[channel].name, scalar.name);
            let errors = short.values[channel].iter().zip(&back.values[channel]).map(|(a, b)| (a - b).abs());
            let worst = errors.fold(0.0, f64::max) / scalar.full_scale;
            assert!(worst <= BOUND + 1e-6, "{name}: {} is off by {worst}", scalar.name);
        }
    }
    // It was never written without faces.
    let _ = std::fs::remove_file(&table);
}
