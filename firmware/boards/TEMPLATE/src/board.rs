//! The board: its display, serial line, buttons, timer and watchdog.

use crate::placeholder;
use board_common::cortex_m::SysTick;
use board_common::{Capacity, NbSerial, PanicBoard, SharedBoard, five_buttons, report_bus, report_restart};
use board_drivers::i2c_wires::{Guarded, free_wires};
use board_drivers::{Heartbeat, Mono128x64, Ssd1306};
use pantin_app::Board;
use pantin_figure::rotation::Rotation;

// YOUR BOARD: the processor's clock.
pub const CPU_HZ: u32 = 16_000_000;

/// Sets the board up. The panic handler calls it again: `singleton!` then returns `None`, the watchdog runs already, and clocks that may be
/// set only once, as by `embassy_stm32::init`, are set in `main.rs` instead.
// YOUR BOARD: give it the chip's peripherals, and replace each placeholder by a driver of the chip's own crate. `Capacity` is for 64 KiB of
// RAM or more; with less, `pantin_app::MaxClip<144, 96, 36>`.
pub fn new() -> impl Board<Layout = Mono128x64, Rotation = Rotation, Capacity = Capacity> + PanicBoard<Mono128x64> {
    // First of all, a watchdog that resets the board after 2 s.
    let feed_watchdog = || {};
    // While the pins of the bus are open-drain outputs with pull-ups: a display that was reset amid a byte holds the data wire, and is clocked free.
    let wires = free_wires(&mut placeholder::Pin, &mut placeholder::Pin, || cortex_m::asm::delay(CPU_HZ / 200_000));
    // Any `embedded_hal::i2c::I2c` of at most 400 kHz whose `transaction` is implemented. Enable the pull-ups of both pins, if there are any. If it waits for
    // ever while a wire is held low, `Guarded` begins no transfer then; its function reads both pins.
    let mut i2c = Guarded::new(placeholder::Bus, || true);
    // 115,200 baud: any port of `embedded_hal_nb::serial` whose `write` returns `WouldBlock` in `NbSerial`, or two functions in `FnSerial`,
    // as for a port with the traits of `embedded-io`.
    let mut serial = NbSerial(placeholder::Port);
    // What the program was doing if the watchdog has reset the board: give it the flag of the chip's register of reset reasons, and clear that.
    report_restart(&mut serial, false);
    // The addresses that answer, as a line over the serial port: for who wires a display and sees nothing.
    report_bus(&mut serial, wires, &mut i2c);
    // An LED that blinks while pictures are sent, whether the display answers or not. A board without one passes the display itself.
    let display = Heartbeat::new(Ssd1306::new(i2c), placeholder::Pin);
    // Any `embedded_hal::digital::InputPin` with a pull-up: up, down, left, right and select, all of one type. A board without buttons has
    // `NoButtons`.
    let buttons = five_buttons([placeholder::Pin; 5]);
    // On another processor than a Cortex-M: `TickTimer`, over a free-running counter.
    let timer = SysTick::<CPU_HZ>::new();
    SharedBoard::new(display, serial, buttons, timer, feed_watchdog)
}
