//! A board's pictures against the host's, pixel by pixel, with the board's instructions counted.

use crate::build::Firmware;
use crate::display::Picture;
use crate::icount::{self, FRAME_REGIONS, Stats};
use crate::qemu::{Launch, Machine};
use crate::sync::Session;
use crate::{defmt_log, screen};

/// Plays a picture, and one more after each of the keys' letters, and compares each, and its frame's number, with `expected`: panics
/// where they differ. Returns the instructions of each of the frame's regions.
pub fn shows(machine: Machine, firmware: &Firmware, expected: &[(u32, Picture)], keys: &[&[u8]]) -> Vec<Stats> {
    shows_with(machine, firmware, &[], expected, keys)
}

/// Like [`shows`], with options of the firmware's command line.
pub fn shows_with(
    machine: Machine,
    firmware: &Firmware,
    words: &[&str],
    expected: &[(u32, Picture)],
    keys: &[&[u8]],
) -> Vec<Stats> {
    let folder = tempfile::tempdir().unwrap();
    let counts = folder.path().join("counts");
    let plugin = icount::plugin(machine.emulator).unwrap();
    let launch = Launch::new(machine, firmware.elf()).counting(&plugin, &counts);
    let launch = words.iter().fold(launch, |launch, word| launch.argument((*word).to_owned()));
    let mut session = Session::start(launch).unwrap();
    for (index, (number, picture)) in expected.iter().enumerate() {
        let letters = index.checked_sub(1).map_or(&[][..], |before| keys[before]);
        let shown = session.next(letters).unwrap_or_else(|error| panic!("{}, picture {index}: {error:#}", machine.name));
        let after = letters.escape_ascii();
        assert_eq!(shown.0, *number, "{}, picture {index} after \"{after}\"", machine.name);
        if let Some(difference) = screen::difference(&shown.1, picture) {
            panic!("{}, picture {index} of frame {number} after \"{after}\": {difference}", machine.name);
        }
    }
    let outcome = session.end().unwrap();
    let log = defmt_log::decode(firmware.elf(), &outcome.stdout).unwrap();
    assert_eq!(outcome.code, 0, "{log:?}");
    let stats = icount::by_kind(&icount::read(&counts).unwrap(), FRAME_REGIONS.len()).unwrap();
    assert!(stats.iter().all(|kind| kind.regions == expected.len()), "{stats:?}");
    assert!(expected.iter().all(|(_, picture)| !picture.is_dark()), "every picture shows something");
    println!("{}: {} pictures are equal", machine.name, expected.len());
    stats
}
