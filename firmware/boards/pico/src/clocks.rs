//! The chip's clocks: 125 MHz, from the crystal.

use rp2040_hal::clocks::init_clocks_and_plls;
use rp2040_hal::pac::{CLOCKS, PLL_SYS, PLL_USB, RESETS, XOSC};
use rp2040_hal::watchdog::Watchdog;

/// Of the crystal, a second.
const CRYSTAL: u32 = 12_000_000;
/// Of the processor and what is around it, a second.
pub const RATE: u32 = 125_000_000;

/// Starts them, and the watchdog's microseconds.
pub fn start(crystal: XOSC, clocks: CLOCKS, plls: (PLL_SYS, PLL_USB), resets: &mut RESETS, watchdog: &mut Watchdog) {
    if init_clocks_and_plls(CRYSTAL, crystal, clocks, plls.0, plls.1, resets, watchdog).is_err() {
        panic!("the clocks do not start");
    }
}
