//! The watchdog.

use crate::nrf_hal::pac::{POWER, WDT};
use crate::nrf_hal::wdt::count::One;
use crate::nrf_hal::wdt::handles::Hdl0;
use crate::nrf_hal::wdt::{Parts, Watchdog, WatchdogHandle};

/// The frequency of the watchdog's clock.
const CLOCK_HZ: u32 = 32_768;
/// The watchdog resets the board when the program hangs for this time.
const WATCHDOG_S: u32 = 2;

/// Returns whether the watchdog has reset the board, and forgets it.
pub fn has_reset(power: &POWER) -> bool {
    let reasons = power.resetreas.read();
    // A written 1 clears a reason.
    power.resetreas.write(|w| w.dog().detected());
    reasons.dog().is_detected()
}

/// Starts the watchdog, or takes over one that runs, since it cannot be stopped, and returns what feeds it. If another program set it up
/// otherwise, nothing does.
pub fn start(watchdog: WDT) -> impl FnMut() {
    let parts: Option<Parts<(WatchdogHandle<Hdl0>,)>> = match Watchdog::try_new(watchdog) {
        Ok(mut watchdog) => {
            watchdog.set_lfosc_ticks(WATCHDOG_S * CLOCK_HZ);
            Some(watchdog.activate::<One>())
        }
        Err(watchdog) => Watchdog::try_recover::<One>(watchdog).ok(),
    };
    let mut handle = parts.map(|parts| parts.handles.0);
    move || {
        if let Some(handle) = &mut handle {
            handle.pet();
        }
    }
}
