//! What the tests share: our own motions.
#![allow(dead_code)]

use pantin::Clip;

/// One of our own motions.
macro_rules! motion {
    ($name:literal) => {
        pantin::Clip::new_checked(include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../motions/", $name, ".ptn")))
            .expect("a clip of ours opens")
    };
}

pub fn walk() -> Clip<'static> {
    motion!("walk")
}

pub fn run() -> Clip<'static> {
    motion!("run")
}

/// A clip with events; a loop.
pub fn events() -> Clip<'static> {
    Clip::new_checked(include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/vectors/events.ptn")))
        .expect("a vector opens")
}

/// The vectors' bank.
pub const BANK: &[u8] = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/vectors/bank.ptb"));

/// The vectors' bank, with these tables behind it, each in a section of its own.
pub fn bank(tables: &[&[u8]]) -> Vec<u8> {
    let mut bytes = BANK.to_vec();
    for table in tables {
        bytes.push(pantin_animator::machine::SECTION);
        pantin::codec::varint::put(table.len() as u32, &mut |byte| bytes.push(byte));
        bytes.extend(*table);
    }
    bytes
}

/// Our character: a bank with a state machine.
pub const CHARACTER: &[u8] = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../motions/character.ptb"));
