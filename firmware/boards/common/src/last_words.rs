//! What a board's panic handler has in common with the others'.

use core::fmt::Write;
use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering};
use pantin_app::TextScreen;
use pantin_figure::surface::{Framebuffer, Layout};

/// Writes a panic on a page, and hands that to `tell`, which shows it; a panic of `tell` itself does not come round.
pub fn last_words<L: Layout>(info: &PanicInfo, tell: impl FnOnce(&mut Framebuffer<L>)) {
    static PANICKED: AtomicBool = AtomicBool::new(false);
    if !PANICKED.load(Ordering::Relaxed) {
        PANICKED.store(true, Ordering::Relaxed);
        let mut page = Framebuffer::new();
        // Writing on a page cannot fail.
        let _ = write!(TextScreen::new(&mut page), "{info}");
        tell(&mut page);
    }
}
