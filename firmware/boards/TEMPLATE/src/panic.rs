//! The panic handler: the display shows the panic for 10 s, then the board resets. Faults of a Cortex-M are panics too.
// YOUR BOARD: `#![allow(unsafe_code)]` here.

use crate::board::{self, CPU_HZ};
use board_common::cortex_m::ClockDelay;
use core::panic::PanicInfo;

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    // YOUR BOARD: take the peripherals again, usually by `|| board::new(unsafe { Peripherals::steal() })`, with a `// Safety:` comment: the
    // code that had them does not run any more.
    board_common::panic_screen(info, board::new, ClockDelay::<CPU_HZ>);
    cortex_m::peripheral::SCB::sys_reset()
}
