//! The instruction counter against a program whose counts are known from its source.

use harness::build::Firmware;
use harness::icount::{self, Stats};
use harness::qemu::{LM3S6965EVB, Launch, MICROBIT, Machine};
use harness::setup;

fn counts_of(machine: Machine) -> Vec<u64> {
    let plugin = icount::plugin(machine.emulator).unwrap();
    let program = Firmware::build("testsuite", "known-loop", machine.target, &[]).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let counts = folder.path().join("counts");
    let outcome = Launch::new(machine, program.elf()).counting(&plugin, &counts).start().unwrap().wait().unwrap();
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    icount::read(&counts).unwrap()
}

fn known_loop_counts_exactly(machine: Machine) {
    let counts = counts_of(machine);
    assert_eq!(counts, [2000, 20, 500, 2000, 20, 500]);
    let stats = icount::by_kind(&counts, 3).unwrap();
    assert_eq!(stats[0], Stats { regions: 2, total: 4000, least: 2000, most: 2000, worst: 0 });
    assert_eq!(counts_of(machine), counts, "a second run counts the same");
}

#[test]
fn a_loop_of_2000_instructions_counts_2000_on_cortex_m3() {
    if !setup::host_only("counting on lm3s6965evb") {
        known_loop_counts_exactly(LM3S6965EVB);
    }
}

#[test]
fn a_loop_of_2000_instructions_counts_2000_on_cortex_m0() {
    if !setup::host_only("counting on microbit") {
        known_loop_counts_exactly(MICROBIT);
    }
}
