//! The board: its display, serial line, buttons, timer and watchdog.

use crate::pins::pins;
use crate::{CPU_HZ, oled, serial, watchdog};
use board_common::cortex_m::SysTick;
use board_common::{Capacity, OledPicture, SharedBoard, report_bus, report_restart, two_buttons};
use board_drivers::Heartbeat;
use nrf52840_hal::Clocks;
use nrf52840_hal::gpio::{Level, p0, p1};
use nrf52840_hal::pac::Peripherals;
use pantin_app::Board;
use pantin_figure::rotation::Rotation;

/// Sets the board up, once.
pub fn new(parts: Peripherals) -> impl Board<Layout = OledPicture, Rotation = Rotation, Capacity = Capacity> {
    // Before all that can hang.
    let by_watchdog = watchdog::has_reset(&parts.POWER);
    let feed = watchdog::start(parts.WDT);
    Clocks::new(parts.CLOCK).enable_ext_hfosc();
    let (p0, p1) = (p0::Parts::new(parts.P0), p1::Parts::new(parts.P1));
    let ((tx, rx), (first, second), (scl, sda), led) = pins!(p0, p1);
    // One table has no pin of it.
    let _ = &p1.p1_00;
    let tx = tx.into_push_pull_output(Level::High).degrade();
    let mut serial = serial::new(parts.UARTE0, tx, rx.into_pullup_input().degrade());
    report_restart(&mut serial, by_watchdog);
    let buttons = two_buttons([first.into_pullup_input().degrade(), second.into_pullup_input().degrade()]);
    let (scl, sda) = (scl.into_floating_input().degrade(), sda.into_floating_input().degrade());
    let display = oled::new(parts.TWIM0, scl, sda, &mut |wires, mut bus| report_bus(&mut serial, wires, &mut bus));
    let display = Heartbeat::new(display, led.into_push_pull_output(Level::High));
    SharedBoard::new(display, serial, buttons, SysTick::<CPU_HZ>::new(), feed)
}
