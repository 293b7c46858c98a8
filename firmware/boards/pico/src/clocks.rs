//! The chip's clocks, from the crystal.

use rp2040_hal::clocks::init_clocks_and_plls;
use rp2040_hal::pac::{CLOCKS, PLL_SYS, PLL_USB, RESETS, XOSC};
use rp2040_hal::watchdog::Watchdog;

const CRYSTAL_HZ: u32 = 12_000_000;
/// The clock of the processor and the peripherals.
pub const CPU_HZ: u32 = 125_000_000;

/// Starts the clocks, and the watchdog's counter of microseconds.
pub fn start(crystal: XOSC, clocks: CLOCKS, plls: (PLL_SYS, PLL_USB), resets: &mut RESETS, watchdog: &mut Watchdog) {
    if init_clocks_and_plls(CRYSTAL_HZ, crystal, clocks, plls.0, plls.1, resets, watchdog).is_err() {
        panic!("the clocks do not start");
    }
}
