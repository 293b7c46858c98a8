//! A panic stays on the display for ten seconds; then the board starts anew.
#![allow(unsafe_code)]

use crate::board::BlackPill;
use core::panic::PanicInfo;
use stm32f4xx_hal::pac::Peripherals;

/// How long it stays, in parts, and nanoseconds of a part: shorter than the watchdog's patience.
const PARTS: u32 = 20;
const PART: u32 = 500_000_000;

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    cortex_m::interrupt::disable();
    board_common::last_words(info, |page| {
        #[cfg(feature = "defmt")]
        defmt::error!("{}", defmt::Display2Format(info));
        // Safety: whoever had the peripherals does not run any more, and setting them up resets them.
        let mut board = BlackPill::new(unsafe { Peripherals::steal() });
        board.tell(page);
        for _ in 0..PARTS {
            board.feed();
            crate::clocks::wait(PART);
        }
    });
    // Not fed any more, the watchdog bites.
    #[allow(clippy::empty_loop)]
    loop {}
}
