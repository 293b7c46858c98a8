//! What a board does for the program.

use crate::commands::Command;
use pantin_figure::rotation::RotationBackend;
use pantin_figure::surface::{Framebuffer, Layout};

/// The hardware.
pub trait Board {
    /// How the display keeps its pixels.
    type Layout: Layout;

    /// How it turns joints: in whole numbers or in floating point.
    type Rotation: RotationBackend;

    /// Brings the display up to date: what [`Framebuffer::send`] names has changed.
    fn show(&mut self, frame: &mut Framebuffer<Self::Layout>);

    /// Starts a timer that ticks every `nanoseconds`, or changes its pace.
    fn start_timer(&mut self, nanoseconds: u32);

    /// Waits for the timer and tells how many times it ticked since the last call: at least once.
    fn wait_ticks(&mut self) -> u32;

    /// How many times the timer ticked since the last call, without waiting; a board that cannot tell waits, and bytes wait with it.
    #[cfg(feature = "link")]
    fn ticks(&mut self) -> u32 {
        self.wait_ticks()
    }

    /// Sends bytes over the board's line.
    fn send(&mut self, bytes: &[u8]);

    /// A byte from the line, if one is there.
    fn poll(&mut self) -> Option<u8>;

    /// Waits for a byte from the line.
    fn receive(&mut self) -> u8 {
        loop {
            if let Some(byte) = self.poll() {
                return byte;
            }
        }
    }

    /// A button that was pressed since the last call.
    fn button(&mut self) -> Option<Command> {
        None
    }

    /// Begins a stretch whose instructions an emulator counts. Costs one instruction that does nothing.
    #[inline(always)]
    fn mark_start(&mut self) {}

    /// Ends it.
    #[inline(always)]
    fn mark_stop(&mut self) {}
}

/// Why the program ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// It did what it was asked to.
    Done,
    /// A clip cannot be played on this board; the log says why.
    BadClip,
}
