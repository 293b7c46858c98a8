//! The ST7789: chip select on PA4, clock on PA5, data on PA7, data/command on PB0.

use crate::board::CPU_HZ;
use board_common::cortex_m::ClockDelay;
use board_drivers::{Display, St7789};
use embedded_hal::spi::MODE_0;
use embedded_hal_bus::spi::ExclusiveDevice;
use pantin_figure::surface::{Gray4Rows, MonoPages};
use stm32f4xx_hal::gpio::{PA4, PA5, PA7, PB0};
use stm32f4xx_hal::pac::SPI1;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::Rcc;

/// The layout of the pictures: 16 greys, in 28,800 bytes. A picture in colour would leave too little RAM for the stack.
pub type Picture = Gray4Rows<240, 240, 7200>;
/// The layout of the panic screen: after a panic there may be no RAM for a second picture in greys.
pub type PanicPicture = MonoPages<240, 240, 7200>;

/// The fastest clock of the bus: half of the chip's.
const SPI_HZ: u32 = CPU_HZ / 2;

/// Sets the display up on the pins for chip select, clock, data out and data/command.
pub fn new(
    spi: SPI1,
    (select, clock, out, data): (PA4, PA5, PA7, PB0),
    clocks: &mut Rcc,
) -> impl Display<Picture> + Display<PanicPicture> + use<> {
    let bus = spi.spi((Some(clock), SPI1::NoMiso, Some(out)), MODE_0, SPI_HZ.Hz(), clocks);
    let Ok(bus) = ExclusiveDevice::new_no_delay(bus, select.into_push_pull_output());
    match St7789::new(bus, data.into_push_pull_output(), &mut ClockDelay::<CPU_HZ>) {
        Some(display) => display,
        None => panic!("the display's bus fails"),
    }
}
