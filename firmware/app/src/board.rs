//! What a board does for the program.

use crate::run::BYTES;

/// The hardware.
pub trait Board {
    /// Shows a picture: rows from the top, two pixels a byte, the left one in the high half.
    fn flush(&mut self, picture: &[u8; BYTES]);

    /// Starts a timer that ticks every `nanoseconds`.
    fn start_timer(&mut self, nanoseconds: u32);

    /// Waits for the timer and tells how many times it ticked since the last call: at least once.
    fn wait_ticks(&mut self) -> u32;

    /// Sends bytes over the board's line.
    fn send(&mut self, bytes: &[u8]);

    /// Waits for a byte from the line.
    fn receive(&mut self) -> u8;

    /// Begins a stretch whose instructions an emulator counts. Costs one instruction that does nothing.
    fn mark_start(&mut self) {}

    /// Ends it.
    fn mark_stop(&mut self) {}
}

/// Why the program ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// It did what it was asked to.
    Done,
    /// The clip cannot be played on this board; the log says why.
    BadClip,
}
