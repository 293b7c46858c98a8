//! The trait that a board implements.

use crate::capacity::Capacity;
use crate::commands::Command;
use pantin_figure::rotation::RotationBackend;
use pantin_figure::surface::{Framebuffer, Layout};

/// A board: a display, a timer and a serial line, and, where it has them, buttons. The required methods are [`present`](Board::present),
/// [`start_timer`](Board::start_timer), [`ticks`](Board::ticks), [`send`](Board::send) and [`poll`](Board::poll).
pub trait Board {
    /// The pixel layout of the display's memory.
    type Layout: Layout;

    /// The arithmetic that rotates joints: integers ([`Rotation`](pantin_figure::rotation::Rotation)) or floating point.
    type Rotation: RotationBackend;

    /// The largest clip that the board's RAM has buffers for: a [`MaxClip`](crate::MaxClip).
    type Capacity: Capacity;

    /// Brings the display up to date. Only the windows that [`Framebuffer::send`] returns have changed since the last call.
    fn present(&mut self, framebuffer: &mut Framebuffer<Self::Layout>);

    /// Shows two lines of text over the next picture that is presented, at its top and its bottom, by hardware of the display's own. Returns
    /// `false` on a board without it: then they are drawn on the framebuffer.
    fn overlay(&mut self, _lines: [&str; 2]) -> bool {
        false
    }

    /// Starts a timer with a period in nanoseconds, or changes the period of the one that runs. Ticks count from now on.
    fn start_timer(&mut self, period_ns: u32);

    /// Returns the number of timer ticks since the last call of this or of [`wait_ticks`](Board::wait_ticks), without waiting.
    fn ticks(&mut self) -> u32;

    /// Waits until the timer has ticked and returns the number of ticks since the last call: at least 1. A board whose processor can
    /// sleep until an interrupt overrides it.
    fn wait_ticks(&mut self) -> u32 {
        loop {
            match self.ticks() {
                0 => {}
                ticks => return ticks,
            }
        }
    }

    /// Sends bytes over the serial line, and waits where its buffer is full.
    fn send(&mut self, bytes: &[u8]);

    /// Returns the next byte that the serial line has received, or `None` without waiting.
    fn poll(&mut self) -> Option<u8>;

    /// Waits for a byte from the serial line.
    fn receive(&mut self) -> u8 {
        loop {
            if let Some(byte) = self.poll() {
                return byte;
            }
        }
    }

    /// Hears an event of the clip when its frame is shown: a footfall, a sound. By default the serial line sends it as a line of text,
    /// `event FRAME NAME`. There are no events in [`Mode::Sync`](crate::Mode::Sync).
    #[cfg(feature = "events")]
    fn event(&mut self, event: crate::HeardEvent) {
        event.send(|bytes| self.send(bytes));
    }

    /// Returns the command of a button that was pressed since the last call.
    fn button(&mut self) -> Option<Command> {
        None
    }

    /// Returns the buttons that are held, each in a bit that the board chooses: as they were at the last tick.
    #[cfg(feature = "steer")]
    fn held(&mut self) -> u16 {
        0
    }

    /// Begins a section whose instructions an emulator counts. An implementation costs one instruction without effect.
    #[inline(always)]
    fn mark_start(&mut self) {}

    /// Ends the section that [`mark_start`](Board::mark_start) began.
    #[inline(always)]
    fn mark_stop(&mut self) {}
}

/// The renderer of a board's figures.
pub(crate) type BoardRenderer<B> = <<B as Board>::Capacity as Capacity>::Renderer<<B as Board>::Rotation>;

/// Why the program ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// It played what its options name, or was asked to quit.
    Done,
    /// A clip cannot be played on this board; the log has the reason.
    BadClip,
}
