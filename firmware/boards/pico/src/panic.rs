//! A panic stays on the display for ten seconds; then the board starts anew.
#![allow(unsafe_code)]

use crate::board::Pico;
use core::fmt::Write;
use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering};
use pantin_app::TextScreen;
use pantin_figure::surface::Framebuffer;
use rp2040_hal::pac::Peripherals;

/// How long it stays, in clocks.
const STAYS: u32 = 10 * crate::clocks::RATE;
/// A part of that: shorter than the watchdog's patience.
const PART: u32 = STAYS / 20;

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    static PANICKED: AtomicBool = AtomicBool::new(false);
    cortex_m::interrupt::disable();
    if !PANICKED.load(Ordering::Relaxed) {
        PANICKED.store(true, Ordering::Relaxed);
        tell(info);
    }
    // Not fed any more, the watchdog bites.
    #[allow(clippy::empty_loop)]
    loop {}
}

fn tell(info: &PanicInfo) {
    #[cfg(feature = "defmt")]
    defmt::error!("{}", defmt::Display2Format(info));
    let mut frame = Framebuffer::new();
    let _ = write!(TextScreen::new(&mut frame), "{info}");
    // Safety: whoever had the peripherals does not run any more, and they are set up from their reset.
    let mut pico = Pico::new(unsafe { Peripherals::steal() });
    pico.tell(&mut frame);
    for _ in 0..STAYS / PART {
        pico.feed();
        cortex_m::asm::delay(PART);
    }
}
