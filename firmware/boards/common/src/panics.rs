//! A panic ends the emulator, with a word in the log.

use crate::end::{Code, exit};
use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering};

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    static PANICKED: AtomicBool = AtomicBool::new(false);
    // A panic of the log itself would come round for ever.
    if !PANICKED.load(Ordering::Relaxed) {
        PANICKED.store(true, Ordering::Relaxed);
        // Where, without its words: those would bring in the library's formatting.
        if let Some(place) = info.location() {
            defmt::error!("panic in {}, line {}", place.file(), place.line());
        }
    }
    exit(Code::Panic)
}
