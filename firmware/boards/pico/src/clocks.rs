//! The chip's clocks, from the crystal.

pub use crate::CPU_HZ;
use crate::rp_hal::clocks::{UsbClock, init_clocks_and_plls};
use crate::rp_hal::pac::{CLOCKS, PLL_SYS, PLL_USB, RESETS, XOSC};
use crate::rp_hal::watchdog::Watchdog;

const CRYSTAL_HZ: u32 = 12_000_000;

/// Starts the clocks, and the watchdog's counter of microseconds. Returns the clock of the USB port.
pub fn start(crystal: XOSC, clocks: CLOCKS, plls: (PLL_SYS, PLL_USB), resets: &mut RESETS, watchdog: &mut Watchdog) -> UsbClock {
    match init_clocks_and_plls(CRYSTAL_HZ, crystal, clocks, plls.0, plls.1, resets, watchdog) {
        Ok(clocks) => clocks.usb_clock,
        Err(_) => panic!("the clocks do not start"),
    }
}
