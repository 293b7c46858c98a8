//! The stack that is read from an image's code is the one that a run uses.

use std::fs;

use harness::build::Firmware;
use harness::qemu::{LM3S6965EVB, Launch, Machine, RISCV_VIRT};
use harness::{setup, stack, sync};

/// The reference board's RAM behind its variables, in which the stack grows down from the end.
const RAM: (u32, usize) = (0x2000_2000, 0xe000);
/// The memory that the RISC-V machine keeps for its stack alone.
const STACK: (u32, usize) = (0x8050_0000, 0x10_0000);
/// What no stack holds much of.
const PAINT: u8 = 0xa5;
/// Pictures shown.
const FRAMES: usize = 12;

#[test]
fn a_run_uses_no_more_stack_than_its_code_says_and_hardly_less() {
    uses_what_its_code_says(LM3S6965EVB, RAM);
}

#[test]
fn a_run_on_riscv_uses_no_more_stack_than_its_code_says_and_hardly_less() {
    uses_what_its_code_says(RISCV_VIRT, STACK);
}

fn uses_what_its_code_says(machine: Machine, (start, length): (u32, usize)) {
    if setup::host_only(&format!("the stack of a run on {}", machine.name)) {
        return;
    }
    let firmware = Firmware::build(machine.name, machine.name, machine.target, &[]).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let (paint, memory) = (folder.path().join("paint"), folder.path().join("memory"));
    fs::write(&paint, vec![PAINT; length]).unwrap();
    let launch = Launch::new(machine, firmware.elf()).loading(&paint, start).display();
    let mut session = sync::Session::start(launch).unwrap();
    for _ in 0..FRAMES {
        session.step(b"").unwrap();
    }
    session.memory(start, length, &memory).unwrap();
    session.end().unwrap();
    let painted = fs::read(&memory).unwrap().iter().take_while(|byte| **byte == PAINT).count();
    let used = (length - painted) as u32;
    let said = stack::worst(firmware.elf()).unwrap();
    println!("{used} bytes used, {} read from the code", said.bytes);
    assert!(painted > 0, "the stack has used all that was painted");
    assert!(used <= said.bytes, "{used} bytes used, {} read from the code", said.bytes);
    // The deepest calls set up the figure, so that every run makes them.
    assert!(used * 10 >= said.bytes * 9, "{used} bytes used, {} read from the code", said.bytes);
}
