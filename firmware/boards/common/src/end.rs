//! The emulator's end, with a code that says what ended it.

/// Exit codes of the emulator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Code {
    /// The program did what it was asked to.
    Done = 0,
    /// A clip cannot be played on this board; the log says why.
    BadClip = 2,
    /// As Rust programs do.
    Panic = 101,
    /// A fault of the processor: a bad access, or the stack ran out.
    Fault = 102,
    /// An interrupt that nothing asked for.
    Interrupt = 103,
}

/// Ends the emulator.
pub fn exit(code: Code) -> ! {
    semihosting::process::exit(code as i32)
}
