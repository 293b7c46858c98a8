//! The board: its display, LEDs, serial line, buttons, timer and watchdog.

use crate::{leds, oled, serial, watchdog};
use board_common::{Capacity, SharedBoard, TickTimer, report_bus, report_restart, two_buttons};
use board_drivers::led_matrix::reduce;
use board_drivers::{Display, Mono128x64};
use nrf52833_hal::gpio::{Level, p0, p1};
use nrf52833_hal::pac::Peripherals;
use nrf52833_hal::{Clocks, Timer};
use pantin_app::Board;
use pantin_figure::rotation::Rotation;
use pantin_figure::surface::Framebuffer;

/// The frequency of the HAL's timers.
const TIMER_HZ: u32 = 1_000_000;

/// Sets the board up, once.
pub fn new(parts: Peripherals) -> impl Board<Layout = Mono128x64, Rotation = Rotation, Capacity = Capacity> {
    // Before all that can hang.
    let by_watchdog = watchdog::has_reset(&parts.POWER);
    let feed = watchdog::start(parts.WDT);
    Clocks::new(parts.CLOCK).enable_ext_hfosc();
    let (p0, p1) = (p0::Parts::new(parts.P0), p1::Parts::new(parts.P1));
    let tx = p0.p0_06.into_push_pull_output(Level::High).degrade();
    let mut serial = serial::new(parts.UARTE0, tx, p1.p1_08.into_pullup_input().degrade());
    report_restart(&mut serial, by_watchdog);
    // SCL on P19, SDA on P20 of the edge connector.
    let (scl, sda) = (p0.p0_26.into_floating_input().degrade(), p1.p1_00.into_floating_input().degrade());
    let mut oled = oled::new(parts.TWIM0, scl, sda, &mut |wires, mut bus| report_bus(&mut serial, wires, &mut bus));
    let rows = [p0.p0_21.degrade(), p0.p0_22.degrade(), p0.p0_15.degrade(), p0.p0_24.degrade(), p0.p0_19.degrade()];
    let columns = [p0.p0_28.degrade(), p0.p0_11.degrade(), p0.p0_31.degrade(), p1.p1_05.degrade(), p0.p0_30.degrade()];
    leds::start(rows, columns, parts.TIMER1);
    let display = move |framebuffer: &mut Framebuffer<Mono128x64>| {
        leds::set(&reduce(framebuffer));
        oled.present(framebuffer);
    };
    let buttons = two_buttons([p0.p0_14.into_floating_input().degrade(), p0.p0_23.into_floating_input().degrade()]);
    let mut timer = Timer::periodic(parts.TIMER0);
    timer.start(u32::MAX);
    // The interrupt that lights the LEDs ends the sleep every millisecond.
    let tick_timer = TickTimer::<TIMER_HZ, _, _>::new(move || timer.read(), cortex_m::asm::wfi);
    SharedBoard::new(display, serial, buttons, tick_timer, feed)
}
