//! The watchdog.

use nrf52833_hal::pac::WDT;
use nrf52833_hal::wdt::count::One;
use nrf52833_hal::wdt::handles::Hdl0;
use nrf52833_hal::wdt::{Parts, Watchdog, WatchdogHandle};

/// It starts the board anew when the program was stuck for two seconds: ticks of 32,768 a second.
const PATIENCE: u32 = 2 * 32_768;

/// Sets it up, or takes up one that runs: it cannot be stopped. None where it was set up by another program.
pub fn start(dog: WDT) -> Option<WatchdogHandle<Hdl0>> {
    let parts: Parts<(WatchdogHandle<Hdl0>,)> = match Watchdog::try_new(dog) {
        Ok(mut dog) => {
            dog.set_lfosc_ticks(PATIENCE);
            dog.activate::<One>()
        }
        Err(dog) => Watchdog::try_recover::<One>(dog).ok()?,
    };
    Some(parts.handles.0)
}
