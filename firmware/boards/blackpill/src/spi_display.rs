//! A display over SPI, on the pins that the board chooses.

use crate::board::{CPU_HZ, SpiPins};
use board_common::cortex_m::ClockDelay;
use board_drivers::{ColorPanel, Display};
use embedded_hal::spi::MODE_3;
use embedded_hal_bus::spi::ExclusiveDevice;
use stm32f4xx_hal::gpio::Speed;
use stm32f4xx_hal::pac::SPI1;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::Rcc;

/// The module, as the features choose it.
mod chosen {
    include!(concat!(env!("OUT_DIR"), "/display.rs"));
}

/// The layout of the pictures: 16 greys, in 28,800 bytes for 240x240 pixels. A picture in colour would leave too little RAM for the stack.
pub type Picture = chosen::Greys;
/// The layout of the panic screen: after a panic there may be no RAM for a second picture in greys.
pub type PanicPicture = chosen::Mono;

/// The clock of the bus: a quarter of the chip's, 21 MHz, which jumper wires carry. With the feature `fast` it is half of the chip's, the fastest.
const SPI_HZ: u32 = CPU_HZ / if cfg!(feature = "fast") { 2 } else { 4 };

/// Sets the display up on the pins for chip select, clock, data out, data/command and reset.
pub fn new(
    spi: SPI1,
    (select, clock, out, data, reset): SpiPins,
    clocks: &mut Rcc,
) -> impl Display<Picture> + Display<PanicPicture> + use<> {
    // After reset, pins are at low speed, which is 4 MHz at 50 pF (STM32F411 data sheet, table 56), and the HAL leaves them there.
    let fast = Speed::VeryHigh;
    let (clock, out) = (clock.into_alternate::<5>().speed(fast), out.into_alternate::<5>().speed(fast));
    let (select, data) = (select.into_push_pull_output().speed(fast), data.into_push_pull_output().speed(fast));
    let bus = spi.spi((Some(clock), SPI1::NoMiso, Some(out)), MODE_3, SPI_HZ.Hz(), clocks);
    let Ok(bus) = ExclusiveDevice::new_no_delay(bus, select);
    match ColorPanel::new(chosen::MODULE, bus, data, &mut reset.into_push_pull_output(), &mut ClockDelay::<CPU_HZ>) {
        Some(display) => display,
        None => panic!("the display's bus fails"),
    }
}
