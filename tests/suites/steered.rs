//! A state machine on the reference board, steered by the recorded session: picture by picture what the host shows.

use harness::qemu::LM3S6965EVB;
use harness::steered::{self, Program};
use harness::{setup, simulator};

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

/// The reference board's own program, steered by letters over its serial line: as in `cargo xtask demo --steer --board`. It holds the feet.
#[test]
fn the_reference_board_is_steered_as_on_the_host() {
    if setup::host_only("a state machine on a board") {
        return;
    }
    let held = steered::on_board(LM3S6965EVB, Program::Steer, "lines").unwrap();
    assert_eq!(held.len(), 901);
    let free = steered::without_feet().unwrap();
    let free = steered::letters(Program::Steer)
        .map(|letters| simulator::steer_in_step(&free, false, LM3S6965EVB.display.unwrap(), &[], &letters));
    let free = free.unwrap().unwrap();
    let others = held.iter().zip(&free).filter(|(held, free)| held.pixels != free.pixels).count();
    println!("{} pictures are equal; in {others} the feet are elsewhere than without the table", held.len());
    assert_eq!(held.len(), free.len());
    assert!(others > 100, "{others}");
}
