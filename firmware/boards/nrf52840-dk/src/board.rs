//! The board: its display, serial line, buttons, timer and watchdog.

use crate::{CPU_HZ, oled, serial, watchdog};
use board_common::cortex_m::SysTick;
use board_common::{Capacity, SharedBoard, report_bus, report_restart, two_buttons};
use board_drivers::{Heartbeat, Mono128x64};
use nrf52840_hal::Clocks;
use nrf52840_hal::gpio::{Level, p0};
use nrf52840_hal::pac::Peripherals;
use pantin_app::Board;
use pantin_figure::rotation::Rotation;

/// Sets the board up, once.
pub fn new(parts: Peripherals) -> impl Board<Layout = Mono128x64, Rotation = Rotation, Capacity = Capacity> {
    // Before all that can hang.
    let by_watchdog = watchdog::has_reset(&parts.POWER);
    let feed = watchdog::start(parts.WDT);
    Clocks::new(parts.CLOCK).enable_ext_hfosc();
    let p0 = p0::Parts::new(parts.P0);
    let tx = p0.p0_06.into_push_pull_output(Level::High).degrade();
    let mut serial = serial::new(parts.UARTE0, tx, p0.p0_08.into_pullup_input().degrade());
    report_restart(&mut serial, by_watchdog);
    // Buttons 1 and 2.
    let buttons = two_buttons([p0.p0_11.into_pullup_input().degrade(), p0.p0_12.into_pullup_input().degrade()]);
    let (scl, sda) = (p0.p0_27.into_floating_input().degrade(), p0.p0_26.into_floating_input().degrade());
    let display = oled::new(parts.TWIM0, scl, sda, &mut |wires, mut bus| report_bus(&mut serial, wires, &mut bus));
    // LED 1.
    let display = Heartbeat::new(display, p0.p0_13.into_push_pull_output(Level::High));
    SharedBoard::new(display, serial, buttons, SysTick::<CPU_HZ>::new(), feed)
}
