//! The screen that shows a panic, or why a program cannot do its work.

use board_drivers::Display;
use core::fmt::{self, Write};
use core::panic::PanicInfo;
use embedded_hal::delay::DelayNs;
use pantin_app::TextScreen;
use pantin_figure::surface::{Framebuffer, Layout};
use portable_atomic::{AtomicBool, Ordering};

/// How long a panic stays on the display.
const PANIC_SHOW_MS: u32 = 10_000;
/// The time between two feeds of the watchdog: shorter than any board's watchdog waits.
const FEED_MS: u32 = 500;

/// What a panic screen needs of a board: a display, a watchdog, and a serial line if there is no other log.
///
/// `L` is the layout of the panic screen. It may take less memory than the program's own: after a panic there may be no RAM for a second
/// large framebuffer.
pub trait PanicBoard<L: Layout> {
    /// Shows a framebuffer.
    fn show(&mut self, framebuffer: &mut Framebuffer<L>);

    /// Feeds the watchdog.
    fn feed(&mut self);

    /// Sends bytes over the serial line.
    fn send(&mut self, bytes: &[u8]);
}

/// A display and a function that feeds the watchdog, without a serial line.
impl<L: Layout, D: Display<L>, W: FnMut()> PanicBoard<L> for (D, W) {
    fn show(&mut self, framebuffer: &mut Framebuffer<L>) {
        self.0.present(framebuffer);
    }

    fn feed(&mut self) {
        (self.1)();
    }

    fn send(&mut self, _: &[u8]) {}
}

/// Shows a panic on the display of a board, which `set_up` sets up again, for 10 s, and logs it: over the serial line unless the feature
/// `defmt` is on. It returns at once if it panics itself.
///
/// On a Cortex-M interrupts are off: `delay` must not need them.
pub fn panic_screen<L: Layout, B: PanicBoard<L>>(info: &PanicInfo, set_up: impl FnOnce() -> B, mut delay: impl DelayNs) {
    static PANICKED: AtomicBool = AtomicBool::new(false);
    #[cfg(feature = "cortex-m")]
    cortex_m::interrupt::disable();
    // Not `swap`: a Cortex-M0 has none.
    if PANICKED.load(Ordering::Relaxed) {
        return;
    }
    PANICKED.store(true, Ordering::Relaxed);
    let mut board = message_screen(info, set_up);
    crate::restart::Stage::Panic.enter();
    for _ in 0..PANIC_SHOW_MS / FEED_MS {
        board.feed();
        delay.delay_ms(FEED_MS);
    }
}

/// Shows without end why a program cannot do its work, on the display of a board, which `set_up` sets up, and logs it as [`panic_screen`]
/// does. The watchdog is fed: a reset would not help.
pub fn refusal_screen<L: Layout, B: PanicBoard<L>>(
    words: impl fmt::Display,
    set_up: impl FnOnce() -> B,
    mut delay: impl DelayNs,
) -> ! {
    let mut board = message_screen(words, set_up);
    loop {
        board.feed();
        delay.delay_ms(FEED_MS);
    }
}

/// Logs words and shows them. The framebuffer is on the stack before the board is set up.
fn message_screen<L: Layout, B: PanicBoard<L>>(words: impl fmt::Display, set_up: impl FnOnce() -> B) -> B {
    #[cfg(feature = "defmt")]
    defmt::error!("{}", defmt::Display2Format(&words));
    let mut framebuffer = Framebuffer::new();
    // Writing on a text screen cannot fail.
    let _ = write!(TextScreen::new(&mut framebuffer), "{words}");
    let mut board = set_up();
    board.show(&mut framebuffer);
    #[cfg(not(feature = "defmt"))]
    let _ = write!(SerialText(|text: &str| board.send(text.as_bytes())), "\r\n{words}\r\n");
    board
}

/// Text that is sent over a serial line.
#[cfg(not(feature = "defmt"))]
struct SerialText<S>(S);

#[cfg(not(feature = "defmt"))]
impl<S: FnMut(&str)> Write for SerialText<S> {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        (self.0)(text);
        Ok(())
    }
}
