//! The panic handler of emulated boards: it logs the panic and ends the emulator.

use crate::exit::{Code, exit};
use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering};

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    static PANICKED: AtomicBool = AtomicBool::new(false);
    // A panic of the log itself would recur forever.
    if !PANICKED.load(Ordering::Relaxed) {
        PANICKED.store(true, Ordering::Relaxed);
        // The place without the message, which would link the library's formatting.
        if let Some(place) = info.location() {
            defmt::error!("panic in {}, line {}", place.file(), place.line());
        }
    }
    exit(Code::Panic)
}
