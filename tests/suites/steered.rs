//! A state machine on the reference board, steered by the recorded session: picture by picture what the host shows.

use harness::build::Firmware;
use harness::qemu::{LM3S6965EVB, Launch};
use harness::{screen, setup, steered, sync};

/// `PANTIN_UPDATE=1` writes the record again, after a change of the motions, the machine or the animator.
#[test]
fn the_record_is_what_the_session_gives() {
    let crcs = steered::crcs().unwrap();
    if std::env::var_os("PANTIN_UPDATE").is_some() {
        let lines: String = crcs.stepped.iter().map(|crc| format!("{crc:04x}\n")).collect();
        std::fs::write(steered::record(), lines).unwrap();
    }
    assert_eq!(crcs.stepped, steered::recorded().unwrap().stepped);
    assert_eq!(crcs.stepped.len(), 901);
}

#[test]
fn the_reference_board_shows_what_the_host_shows() {
    if setup::host_only("a state machine on a board") {
        return;
    }
    let expected = steered::pictures().unwrap();
    let program = Firmware::build("testsuite", "steer", LM3S6965EVB.target, &[]).unwrap();
    let mut pictures = expected.iter();
    let outcome = sync::play(Launch::new(LM3S6965EVB, program.elf()), expected.len(), |number, picture| {
        let expected = pictures.next().unwrap();
        assert!(!expected.is_dark());
        if let Some(difference) = screen::difference(&picture, expected) {
            panic!("picture {number}: {difference}");
        }
        Ok(())
    });
    assert_eq!(outcome.unwrap().code, 0);
    assert_eq!(pictures.len(), 0);
    println!("{} pictures are equal", expected.len());
}
