//! A display over SPI: clock on GP18, data on GP19, chip select on GP17; data/command and reset as the table of pins says.

use crate::SPI_DIVIDER;
use crate::clocks::CPU_HZ;
use crate::pins::{Data, Reset};
use crate::rp_hal::Spi;
use crate::rp_hal::fugit::RateExtU32;
use crate::rp_hal::gpio::bank0::{Gpio17, Gpio18, Gpio19};
use crate::rp_hal::gpio::{FunctionNull, FunctionSpi, Pin, PullDown};
use crate::rp_hal::pac::{RESETS, SPI0};
use crate::rp_hal::spi::Enabled;
use board_common::cortex_m::ClockDelay;
use board_drivers::{ColorPanel, Display};
use core::convert::Infallible;
use embedded_hal::spi::{ErrorType, MODE_3, SpiBus};
use embedded_hal_bus::spi::ExclusiveDevice;
use embedded_hal_nb::spi::FullDuplex;

/// The module, as the features choose it.
mod chosen {
    include!(concat!(env!("OUT_DIR"), "/display.rs"));
}

/// The layout of the pictures: in colour, in 115,200 bytes for 240x240 pixels.
pub type Picture = chosen::Colour;
/// The layout of the panic screen: after a panic there may be no RAM for a second picture in colour.
pub type PanicPicture = chosen::Mono;

/// The clock of the bus.
const SPI_HZ: u32 = CPU_HZ / SPI_DIVIDER;
const _: () = assert!(SPI_HZ <= 62_500_000, "the displays' limit");

/// A pin after reset.
type Free<I> = Pin<I, FunctionNull, PullDown>;
/// Chip select, clock, data out, data/command and reset.
type Pins = (Free<Gpio17>, Free<Gpio18>, Free<Gpio19>, Free<Data>, Free<Reset>);
type Lines = (Pin<Gpio19, FunctionSpi, PullDown>, Pin<Gpio18, FunctionSpi, PullDown>);

/// Sets the display up on the pins for chip select, clock, data out, data/command and reset.
pub fn new(
    spi: SPI0,
    (select, clock, out, data, reset): Pins,
    resets: &mut RESETS,
) -> impl Display<Picture> + Display<PanicPicture> + use<> {
    let lines: Lines = (out.into_function(), clock.into_function());
    let bus = Spi::<_, _, _, 8>::new(spi, lines).init(resets, CPU_HZ.Hz(), SPI_HZ.Hz(), MODE_3);
    let Ok(bus) = ExclusiveDevice::new_no_delay(WriteBus(bus), select.into_push_pull_output());
    match ColorPanel::new(
        chosen::MODULE,
        bus,
        data.into_push_pull_output(),
        &mut reset.into_push_pull_output(),
        &mut ClockDelay::<CPU_HZ>,
    ) {
        Some(display) => display,
        None => unreachable!("neither this bus nor its pins can fail"),
    }
}

/// A bus whose `write` does not read a byte for each one that it sends, which would take most of its time.
struct WriteBus(Spi<Enabled, SPI0, Lines, 8>);

impl ErrorType for WriteBus {
    type Error = Infallible;
}

impl SpiBus for WriteBus {
    fn write(&mut self, bytes: &[u8]) -> Result<(), Infallible> {
        for byte in bytes {
            // Bytes received meanwhile are dropped once the receive queue is full.
            while FullDuplex::write(&mut self.0, *byte).is_err() {}
        }
        Ok(())
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        self.0.flush()?;
        while FullDuplex::read(&mut self.0).is_ok() {}
        Ok(())
    }

    fn read(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        self.flush()?;
        SpiBus::read(&mut self.0, bytes)
    }

    fn transfer(&mut self, read: &mut [u8], write: &[u8]) -> Result<(), Infallible> {
        self.flush()?;
        self.0.transfer(read, write)
    }

    fn transfer_in_place(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        self.flush()?;
        self.0.transfer_in_place(bytes)
    }
}
