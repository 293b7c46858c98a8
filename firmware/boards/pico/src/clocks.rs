//! The chip's clocks, from the crystal.

use rp2040_hal::clocks::{UsbClock, init_clocks_and_plls};
use rp2040_hal::pac::{CLOCKS, PLL_SYS, PLL_USB, RESETS, XOSC};
use rp2040_hal::watchdog::Watchdog;

const CRYSTAL_HZ: u32 = 12_000_000;
/// The clock of the processor and the peripherals.
pub const CPU_HZ: u32 = 125_000_000;

/// Starts the clocks, and the watchdog's counter of microseconds. Returns the clock of the USB port.
pub fn start(crystal: XOSC, clocks: CLOCKS, plls: (PLL_SYS, PLL_USB), resets: &mut RESETS, watchdog: &mut Watchdog) -> UsbClock {
    match init_clocks_and_plls(CRYSTAL_HZ, crystal, clocks, plls.0, plls.1, resets, watchdog) {
        Ok(clocks) => clocks.usb_clock,
        Err(_) => panic!("the clocks do not start"),
    }
}
