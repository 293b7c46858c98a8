//! What the tests share: our own motions, and random numbers.
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

/// The same numbers each time.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 33) as u32
    }

    pub fn below(&mut self, end: u32) -> u32 {
        self.next() % end
    }
}

/// The vectors' bank, with the section of a state machine behind it.
pub fn bank(table: &[u8]) -> Vec<u8> {
    let mut bytes = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/vectors/bank.ptb")).to_vec();
    let len = table.len();
    assert!(len < 1 << 14);
    bytes.push(4);
    bytes.extend([len as u8 | 0x80, (len >> 7) as u8]);
    bytes.extend(table);
    bytes
}
