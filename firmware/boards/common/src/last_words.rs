//! What a board's panic handler has in common with the others'.

use core::fmt::Write;
use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering};
use pantin_app::Page;
use pantin_figure::surface::{Frame, Layout};

/// Writes a panic on a page, and hands that to `tell`, which shows it; a panic of `tell` itself does not come round.
pub fn last_words<L: Layout>(info: &PanicInfo, tell: impl FnOnce(&mut Frame<L>)) {
    static PANICKED: AtomicBool = AtomicBool::new(false);
    if !PANICKED.load(Ordering::Relaxed) {
        PANICKED.store(true, Ordering::Relaxed);
        let mut page = Frame::new();
        // Writing on a page cannot fail.
        let _ = write!(Page::new(&mut page), "{info}");
        tell(&mut page);
    }
}
