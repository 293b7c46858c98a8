//! BVH in and out on captured clips, where they are at hand.

use crate::real::files;
use pantin_convert::fk;
use pantin_convert::import::ImportOptions;
use pantin_convert::motion::{Joint, Motion, Rig};

#[test]
fn units_are_guessed_right() {
    for clip in files(&["bvh"]) {
        let name = clip.file_name().unwrap().to_string_lossy().into_owned();
        let expected = match name.as_str() {
            name if name.contains("2_metres") => 100.0,
            name if name.contains("cmu") || name.contains("xia") => 5.6444,
            name if name.contains("diema") => 2.54,
            _ => 1.0,
        };
        let read = crate::told::load(&clip, &ImportOptions::new()).unwrap();
        println!("{name}: {}", read.units);
        assert_eq!(read.motion.rig.cm_per_unit, expected, "{name}: {}", read.units);
    }
}

#[test]
fn what_is_written_reads_back() {
    let folder = std::env::temp_dir().join(format!("pantin-bvh-real-clips-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("back.bvh");
    for clip in files(&["bvh"]) {
        let motion = crate::told::load(&clip, &ImportOptions::new()).unwrap().motion;
        pantin_tools::output::save_bvh(&motion, &path).unwrap();
        let options = ImportOptions::new().cm_per_unit(motion.rig.cm_per_unit);
        let back = crate::told::load(&path, &options).unwrap().motion;
        let bare = |rig: &Rig| rig.joints.iter().map(|joint| Joint { offset: [0.0; 3], ..joint.clone() }).collect::<Vec<_>>();
        assert_eq!(bare(&back.rig), bare(&motion.rig), "{}", clip.display());
        assert_eq!(back.frames, motion.frames);
        assert!((back.frame_time - motion.frame_time).abs() <= 5e-10);
        let numbers = |motion: &Motion| {
            let offsets = motion.rig.joints.iter().flat_map(|joint| joint.offset);
            offsets.chain(motion.values.iter().flatten().copied()).collect::<Vec<_>>()
        };
        for (wrote, read) in numbers(&motion).into_iter().zip(numbers(&back)) {
            assert!((wrote - read).abs() <= 1e-6, "{}: {wrote} came back as {read}", clip.display());
        }
        let frame = motion.frames / 2;
        let pairs = [&motion, &back].map(|motion| fk::positions(&motion.rig, &motion.values, frame));
        let far = pairs[0].iter().flatten().zip(pairs[1].iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(far <= 1e-4, "{}: {far} cm", clip.display());
    }
    std::fs::remove_dir_all(&folder).unwrap();
}
