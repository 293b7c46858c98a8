//! The watchdog, which has its own clock.

use stm32f4xx_hal::pac::{DBGMCU, IWDG, RCC};
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::watchdog::IndependentWatchdog;

/// The watchdog resets the board when the program hangs for this time, or down to two thirds of it: its clock is inexact.
#[cfg(not(feature = "update"))]
const WATCHDOG_MS: u32 = 2000;
/// It must be longer than the 4 s in which a sector is erased and the watchdog is not fed.
#[cfg(feature = "update")]
const WATCHDOG_MS: u32 = 7000;

/// Returns whether it has reset the board, and forgets it.
pub fn has_reset(clocks: &RCC) -> bool {
    let has_reset = clocks.csr().read().wdgrstf().bit_is_set();
    clocks.csr().modify(|_, w| w.rmvf().set_bit());
    has_reset
}

/// Starts it.
pub fn start(watchdog: IWDG, debug: &DBGMCU) -> IndependentWatchdog {
    let mut watchdog = IndependentWatchdog::new(watchdog);
    watchdog.stop_on_debug(debug, true);
    watchdog.start(WATCHDOG_MS.millis());
    watchdog
}
