//! Exit codes of the emulator.

/// The exit code of the emulator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Code {
    /// The program did what it was asked to.
    Done = 0,
    /// A clip cannot be played on this board; the log says why.
    BadClip = 2,
    /// The program panicked. The code is that of Rust programs.
    Panic = 101,
    /// The processor faulted: an invalid access, or a stack overflow.
    Fault = 102,
    /// An interrupt without a handler.
    Interrupt = 103,
}

/// Ends the emulator.
pub fn exit(code: Code) -> ! {
    semihosting::process::exit(code as i32)
}
