//! A state machine on the reference board, steered by the recorded session: picture by picture what the host shows.

use harness::qemu::LM3S6965EVB;
use harness::{setup, simulator, steered};

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

/// The reference board's own program, steered by letters over its serial line: as in `cargo xtask demo --steer --board`.
#[test]
fn the_reference_board_is_steered_as_on_the_host() {
    if setup::host_only("a state machine on a board") {
        return;
    }
    let shown = steered::on_board(LM3S6965EVB, &steered::bank()).unwrap().len();
    assert_eq!(shown, 901);
    println!("{shown} pictures are equal");
}

/// Plays the session with a table of feet: the board's pictures are the host's, and differ from those without feet.
#[test]
fn the_reference_board_holds_feet_as_the_host_does() {
    if setup::host_only("feet on a board") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let bank = folder.path().join("feet.ptb");
    std::fs::write(&bank, steered::bank_with_feet().unwrap()).unwrap();
    let held = steered::on_board(LM3S6965EVB, &bank).unwrap();
    let free = std::fs::read(steered::bank()).unwrap();
    let free = simulator::steer_in_step(&free, LM3S6965EVB.display.unwrap(), &steered::letters().unwrap()).unwrap();
    let others = held.iter().zip(&free).filter(|(held, free)| held.pixels != free.pixels).count();
    println!("{} pictures are equal; in {others} the feet are elsewhere than without the table", held.len());
    assert_eq!(held.len(), free.len());
    assert!(others > 100, "{others}");
}
