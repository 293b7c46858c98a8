//! The log over semihosting. `defmt-semihosting` needs atomic memory access, which ARMv4T lacks. This module needs none:
//! there is one core, and no interrupt.
#![allow(unsafe_code)]

use core::cell::UnsafeCell;
use defmt::Encoder;
use semihosting::io::{Stdout, Write};

/// The encoder, where it writes to, and whether a message is being written.
struct State {
    encoder: Encoder,
    out: Option<Stdout>,
    taken: bool,
}

struct Cell(UnsafeCell<State>);

// Safety: there is one core, and no interrupt.
unsafe impl Sync for Cell {}

static STATE: Cell = Cell(UnsafeCell::new(State { encoder: Encoder::new(), out: None, taken: false }));

#[defmt::global_logger]
struct Log;

// Safety: `defmt` writes and releases only after it acquired; a second acquisition in between is harmless.
unsafe impl defmt::Logger for Log {
    fn acquire() {
        with(|state| {
            state.taken = true;
            state.out = state.out.take().or_else(|| semihosting::io::stdout().ok());
            state.encoder.start_frame(|bytes| write(&mut state.out, bytes));
        });
    }

    unsafe fn flush() {}

    unsafe fn release() {
        with(|state| {
            state.encoder.end_frame(|bytes| write(&mut state.out, bytes));
            state.taken = false;
        });
    }

    unsafe fn write(bytes: &[u8]) {
        with(|state| state.encoder.write(bytes, |bytes| write(&mut state.out, bytes)));
    }
}

/// Ends the message that a panic interrupted.
pub fn until_panic() {
    with(|state| {
        if state.taken {
            state.encoder.end_frame(|bytes| write(&mut state.out, bytes));
        }
    });
}

fn with(change: impl FnOnce(&mut State)) {
    // Safety: the calls above do not call each other, so this is the only reference.
    change(unsafe { &mut *STATE.0.get() });
}

/// Bytes that cannot be written are dropped: there is nowhere to report it.
fn write(out: &mut Option<Stdout>, bytes: &[u8]) {
    if let Some(out) = out {
        let _ = out.write_all(bytes);
    }
}
