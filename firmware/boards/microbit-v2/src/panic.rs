//! The panic handler: the display shows the panic and the LEDs a cross for 10 s, then the board resets.
#![allow(unsafe_code)]

use crate::{CPU_HZ, leds, oled, watchdog};
use board_common::cortex_m::ClockDelay;
use board_common::{PanicBoard, panic_screen};
use board_drivers::Mono128x64;
use board_drivers::led_matrix::Leds;
use core::panic::PanicInfo;
use embedded_hal::delay::DelayNs;
use nrf52833_hal::gpio::{p0, p1};
use nrf52833_hal::pac::Peripherals;

const CROSS: Leds = [[3, 0, 0, 0, 3], [0, 3, 0, 3, 0], [0, 0, 3, 0, 0], [0, 3, 0, 3, 0], [3, 0, 0, 0, 3]];

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    panic_screen(info, set_up, LedDelay);
    // Not by the watchdog, which may not run yet.
    cortex_m::peripheral::SCB::sys_reset()
}

fn set_up() -> impl PanicBoard<Mono128x64> {
    // Safety: the code that had the peripherals does not run any more.
    let parts = unsafe { Peripherals::steal() };
    let (p0, p1) = (p0::Parts::new(parts.P0), p1::Parts::new(parts.P1));
    let oled = oled::new(
        parts.TWIM0,
        p0.p0_26.into_floating_input().degrade(),
        p1.p1_00.into_floating_input().degrade(),
        &mut |_, _| {},
    );
    leds::set(&CROSS);
    // Without the serial line, which cannot be set up twice.
    (oled, watchdog::start(parts.WDT))
}

/// A delay that refreshes the LEDs.
struct LedDelay;

impl DelayNs for LedDelay {
    fn delay_ns(&mut self, nanoseconds: u32) {
        ClockDelay::<CPU_HZ>.delay_ns(nanoseconds);
    }

    fn delay_ms(&mut self, ms: u32) {
        for _ in 0..ms {
            leds::next();
            self.delay_ns(1_000_000);
        }
    }
}
