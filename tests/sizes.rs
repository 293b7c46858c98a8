//! The stack that is read from an image's code is the one that a run uses.

use std::fs;

use harness::build::Firmware;
use harness::qemu::{LM3S6965EVB, Launch};
use harness::{setup, stack, sync};

/// The reference board's RAM behind its variables, in which the stack grows down from the end.
const RAM: (u32, usize) = (0x2000_2000, 0xe000);
/// What no stack holds much of.
const PAINT: u8 = 0xa5;
/// Pictures shown.
const FRAMES: usize = 12;

#[test]
fn a_run_uses_no_more_stack_than_its_code_says_and_hardly_less() {
    if setup::host_only("the stack of a run") {
        return;
    }
    let machine = LM3S6965EVB;
    let firmware = Firmware::build(machine.name, machine.name, machine.target, &[]).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let (paint, memory) = (folder.path().join("paint"), folder.path().join("memory"));
    fs::write(&paint, [PAINT; RAM.1]).unwrap();
    let mut session = sync::Session::start(Launch::new(machine, firmware.elf()).loading(&paint, RAM.0)).unwrap();
    for _ in 0..FRAMES {
        session.step(b"").unwrap();
    }
    session.memory(RAM.0, RAM.1, &memory).unwrap();
    session.end().unwrap();
    let painted = fs::read(&memory).unwrap().iter().take_while(|byte| **byte == PAINT).count();
    let used = (RAM.1 - painted) as u32;
    let said = stack::worst(firmware.elf()).unwrap();
    println!("{used} bytes used, {} read from the code", said.bytes);
    assert!(painted > 0, "the stack has used all that was painted");
    assert!(used <= said.bytes, "{used} bytes used, {} read from the code", said.bytes);
    // The deepest calls set up the figure, so that every run makes them.
    assert!(used * 10 >= said.bytes * 9, "{used} bytes used, {} read from the code", said.bytes);
}
