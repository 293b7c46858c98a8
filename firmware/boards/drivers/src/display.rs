//! The trait of a display.

use pantin_figure::surface::{Framebuffer, Layout};

/// A display that takes framebuffers of the layout `L`.
///
/// A function or closure that takes a framebuffer is a display too.
pub trait Display<L: Layout> {
    /// Brings the display up to date. Only the windows that [`Framebuffer::send`] returns have changed since the last call.
    ///
    /// There is no error to return: a program has nothing better to do than to try again with the next picture.
    fn present(&mut self, framebuffer: &mut Framebuffer<L>);

    /// Reports that time has passed, in nanoseconds since the last call: at most 4.29 s.
    fn pass(&mut self, _ns: u32) {}

    /// Shows text by hardware of its own, as `pantin_app::Board::overlay` says.
    fn overlay(&mut self, _lines: [&str; 2]) -> bool {
        false
    }
}

impl<L: Layout, F: FnMut(&mut Framebuffer<L>)> Display<L> for F {
    #[inline(always)]
    fn present(&mut self, framebuffer: &mut Framebuffer<L>) {
        self(framebuffer);
    }
}
