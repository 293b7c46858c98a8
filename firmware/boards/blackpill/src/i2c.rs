//! The I2C bus. The HAL's driver waits for ever if a wire is held low: the wires are freed first, and read before each transfer.
#![allow(unsafe_code)]

use crate::board::CPU_HZ;
use board_common::{SerialPort, report_bus};
use board_drivers::i2c_wires::{Guarded, free_wires};
use embedded_hal::i2c::I2c;
use stm32f4xx_hal::gpio::alt::i2c1::{Scl, Sda};
use stm32f4xx_hal::gpio::{Input, Pin, PinState};
use stm32f4xx_hal::pac::{GPIOB, I2C1};
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::Rcc;

/// 5 us.
const HALF_CLOCK: u32 = CPU_HZ / 200_000;

/// Sets the bus up over two pins of port B, and reports it over the serial line.
pub fn new<const SCL: u8, const SDA: u8, S: SerialPort>(
    i2c: I2C1,
    scl: Pin<'B', SCL>,
    sda: Pin<'B', SDA>,
    clocks: &mut Rcc,
    serial: &mut S,
) -> impl I2c + use<SCL, SDA, S>
where
    Pin<'B', SCL>: Into<Scl>,
    Pin<'B', SDA>: Into<Sda>,
{
    // Without a display, the pull-ups keep the bus idle.
    let mut scl = scl.internal_pull_up(true).into_open_drain_output_in_state(PinState::High);
    let mut sda = sda.internal_pull_up(true).into_open_drain_output_in_state(PinState::High);
    let wires = free_wires(&mut scl, &mut sda, || cortex_m::asm::delay(HALF_CLOCK));
    let pins: (Pin<'B', SCL, Input>, Pin<'B', SDA, Input>) = (scl.into_input(), sda.into_input());
    // Safety: the port's input register, which reading does not change.
    let levels = || unsafe { (*GPIOB::ptr()).idr().read().bits() };
    let both = 1 << SCL | 1 << SDA;
    let mut bus = Guarded::new(i2c.i2c(pins, 400.kHz(), clocks), move || levels() & both == both);
    report_bus(serial, wires, &mut bus);
    bus
}
