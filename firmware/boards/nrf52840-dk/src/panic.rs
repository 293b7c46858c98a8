//! The panic handler: the display shows the panic for 10 s, then the board resets.
#![allow(unsafe_code)]

use crate::pins::pins;
use crate::{CPU_HZ, oled, watchdog};
use board_common::cortex_m::ClockDelay;
use board_common::{OledPicture, PanicBoard, panic_screen};
use core::panic::PanicInfo;
use nrf52840_hal::gpio::{p0, p1};
use nrf52840_hal::pac::Peripherals;

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    panic_screen(info, set_up, ClockDelay::<CPU_HZ>);
    cortex_m::peripheral::SCB::sys_reset()
}

fn set_up() -> impl PanicBoard<OledPicture> {
    // Safety: the code that had the peripherals does not run any more.
    let parts = unsafe { Peripherals::steal() };
    let (p0, p1) = (p0::Parts::new(parts.P0), p1::Parts::new(parts.P1));
    let (_, _, (scl, sda), _) = pins!(p0, p1);
    let _ = &p1.p1_00;
    let (scl, sda) = (scl.into_floating_input().degrade(), sda.into_floating_input().degrade());
    let display = oled::new(parts.TWIM0, scl, sda, &mut |_, _| {});
    (display, watchdog::start(parts.WDT))
}
