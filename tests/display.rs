//! What the board's display shows is what the host draws for the same frame, pixel by pixel.

use std::path::Path;

use harness::build::Firmware;
use harness::icount::{self, FRAME_REGIONS};
use harness::qemu::{LM3S6965EVB, Launch};
use harness::{clips, defmt_log, paths, screen, setup, sync};
use pantin_tools::cmd::Files;
use pantin_tools::render::screen as host;

/// Plays up to `most` frames of a motion on the board and compares each with the host's.
fn shows_what_the_host_draws(motion: &Path, most: usize) {
    let folder = tempfile::tempdir().unwrap();
    let path = clips::convert(motion, folder.path()).unwrap();
    let files = Files::read(&path, None).unwrap();
    let clip = files.open().unwrap();
    let frames = most.min(clip.frames() as usize);
    let expected = host::pictures(&clip, Default::default(), 0..frames as u32).unwrap();
    let firmware = Firmware::build(LM3S6965EVB.name, LM3S6965EVB.name, LM3S6965EVB.target, Some(&path)).unwrap();
    let counts = folder.path().join("counts");
    let plugin = icount::plugin(LM3S6965EVB.emulator).unwrap();
    let launch = Launch::new(LM3S6965EVB, firmware.elf()).counting(&plugin, &counts);
    let mut shown = 0;
    let outcome = sync::play(launch, frames, |number, seen| {
        assert_eq!(number as usize, shown);
        if let Some(difference) = screen::difference(&seen, &expected[shown]) {
            panic!("{}, frame {number}: {difference}", motion.display());
        }
        shown += 1;
        Ok(())
    });
    let outcome = outcome.unwrap();
    let log = defmt_log::decode(firmware.elf(), &outcome.stdout).unwrap();
    assert_eq!((outcome.code, shown), (0, frames), "{log:?}");
    let stats = icount::by_kind(&icount::read(&counts).unwrap(), FRAME_REGIONS.len()).unwrap();
    assert!(stats.iter().all(|kind| kind.regions == frames), "{stats:?}");
    let drawn = expected.iter().filter(|picture| picture.pixels.iter().any(|&grey| grey > 0)).count();
    assert_eq!(drawn, frames, "every picture shows something");
}

#[test]
fn our_walk_looks_the_same_on_the_board() {
    if !setup::host_only("the walk on lm3s6965evb") {
        shows_what_the_host_draws(&paths::root().join("motions/walk.keys"), 160);
    }
}

#[test]
fn our_run_looks_the_same_on_the_board() {
    if !setup::host_only("the run on lm3s6965evb") {
        shows_what_the_host_draws(&paths::root().join("motions/run.keys"), 26);
    }
}

#[test]
fn a_captured_walk_looks_the_same_on_the_board() {
    if setup::host_only("a captured walk on lm3s6965evb") {
        return;
    }
    if let Some(data) = paths::data() {
        shows_what_the_host_draws(&data.join("bvh_bandai1_walk.bvh"), 100);
    }
}
