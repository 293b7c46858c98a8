//! A panic stays on the display for ten seconds, and a cross on the lights; then the board starts anew.
#![allow(unsafe_code)]

use crate::oled::Oled;
use crate::{dog, leds};
use board_parts::ssd1306::Pages;
use board_parts::tiny::Lights;
use core::panic::PanicInfo;
use nrf52833_hal::gpio::{p0, p1};
use nrf52833_hal::pac::Peripherals;
use pantin_figure::surface::Framebuffer;

/// How long it stays, in milliseconds, and clocks of one.
const STAYS: u32 = 10_000;
const MILLISECOND: u32 = 64_000;

const CROSS: Lights = [[3, 0, 0, 0, 3], [0, 3, 0, 3, 0], [0, 0, 3, 0, 0], [0, 3, 0, 3, 0], [3, 0, 0, 0, 3]];

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    cortex_m::interrupt::disable();
    board_common::last_words(info, |page| {
        #[cfg(feature = "defmt")]
        defmt::error!("{}", defmt::Display2Format(info));
        tell(page);
    });
    // At once, not by the watchdog, which may not run yet.
    cortex_m::peripheral::SCB::sys_reset()
}

fn tell(page: &mut Framebuffer<Pages>) {
    // Safety: whoever had the peripherals does not run any more.
    let parts = unsafe { Peripherals::steal() };
    let (p0, p1) = (p0::Parts::new(parts.P0), p1::Parts::new(parts.P1));
    let clock = p0.p0_26.into_floating_input().degrade();
    Oled::new(parts.TWIM0, clock, p1.p1_00.into_floating_input().degrade()).show(page);
    let mut dog = dog::start(parts.WDT);
    leds::set(&CROSS);
    for _ in 0..STAYS {
        if let Some(dog) = &mut dog {
            dog.pet();
        }
        leds::next();
        cortex_m::asm::delay(MILLISECOND);
    }
}
