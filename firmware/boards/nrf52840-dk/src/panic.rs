//! The panic handler: the display shows the panic for 10 s, then the board resets.
#![allow(unsafe_code)]

use crate::{CPU_HZ, oled, watchdog};
use board_common::cortex_m::ClockDelay;
use board_common::{PanicBoard, panic_screen};
use board_drivers::Mono128x64;
use core::panic::PanicInfo;
use nrf52840_hal::gpio::p0;
use nrf52840_hal::pac::Peripherals;

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    panic_screen(info, set_up, ClockDelay::<CPU_HZ>);
    cortex_m::peripheral::SCB::sys_reset()
}

fn set_up() -> impl PanicBoard<Mono128x64> {
    // Safety: the code that had the peripherals does not run any more.
    let parts = unsafe { Peripherals::steal() };
    let p0 = p0::Parts::new(parts.P0);
    let display = oled::new(
        parts.TWIM0,
        p0.p0_27.into_floating_input().degrade(),
        p0.p0_26.into_floating_input().degrade(),
        &mut |_, _| {},
    );
    (display, watchdog::start(parts.WDT))
}
