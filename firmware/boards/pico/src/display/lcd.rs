//! The ST7789: clock on GP18, data on GP19, chip select on GP17, data or command on GP20.

use super::Free;
use board_parts::St7789;
use core::convert::Infallible;
use embedded_graphics::pixelcolor::Rgb565;
use embedded_hal::delay::DelayNs;
use embedded_hal::spi::{ErrorType, MODE_0, SpiBus};
use embedded_hal_bus::spi::{ExclusiveDevice, NoDelay};
use embedded_hal_nb::spi::FullDuplex;
use pantin_figure::surface::{Framebuffer, Layout, MonoPages, Rgb565Rows};
use rp2040_hal::Spi;
use rp2040_hal::fugit::RateExtU32;
use rp2040_hal::gpio::bank0::{Gpio17, Gpio18, Gpio19, Gpio20};
use rp2040_hal::gpio::{FunctionSio, FunctionSpi, Pin, PullDown, SioOutput};
use rp2040_hal::pac::{RESETS, SPI0};
use rp2040_hal::spi::Enabled;

/// How the display's pixels are kept: in colour, in 115,200 bytes.
pub type Lit = Rgb565Rows<240, 240, 28800>;
/// How a page of words is kept: where the program came to harm there may be no room for another picture in colour.
pub type Words = MonoPages<240, 240, 7200>;

/// Fastest clock of the bus that the chip makes of its own: half of it.
const RATE: u32 = crate::clocks::RATE / 2;

/// Select, clock, data out, and whether these are data.
pub type Pins = (Free<Gpio17>, Free<Gpio18>, Free<Gpio19>, Free<Gpio20>);
type Out<I> = Pin<I, FunctionSio<SioOutput>, PullDown>;
type Lines = (Pin<Gpio19, FunctionSpi, PullDown>, Pin<Gpio18, FunctionSpi, PullDown>);
type Bus = ExclusiveDevice<Quick, Out<Gpio17>, NoDelay>;

/// Waits by counting.
struct Wait;

impl DelayNs for Wait {
    fn delay_ns(&mut self, nanoseconds: u32) {
        cortex_m::asm::delay(nanoseconds.div_ceil(1000) * (crate::clocks::RATE / 1_000_000));
    }
}

/// The bus, whose `write` fetches no byte for each one that it sends: that is most of its time.
struct Quick(Spi<Enabled, SPI0, Lines, 8>);

impl ErrorType for Quick {
    type Error = Infallible;
}

impl SpiBus for Quick {
    fn write(&mut self, bytes: &[u8]) -> Result<(), Infallible> {
        for byte in bytes {
            // What comes in meanwhile is lost where the queue for it is full.
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

/// The display.
pub struct Display(St7789<Bus, Out<Gpio20>>);

impl Display {
    /// Of the bus, its pins in the order of their numbers, and what sets it up.
    pub fn new(bus: SPI0, pins: Pins, resets: &mut RESETS) -> Self {
        let (select, clock, out, data) = pins;
        let lines: Lines = (out.into_function(), clock.into_function());
        let bus = Spi::<_, _, _, 8>::new(bus, lines).init(resets, crate::clocks::RATE.Hz(), RATE.Hz(), MODE_0);
        let Ok(bus) = ExclusiveDevice::new_no_delay(Quick(bus), select.into_push_pull_output());
        match St7789::new(bus, data.into_push_pull_output(), &mut Wait) {
            Some(display) => Display(display),
            None => unreachable!("neither this bus nor its pins can fail"),
        }
    }

    /// Brings it up to date.
    pub fn show<L: Layout<Ink: Into<Rgb565>>>(&mut self, frame: &mut Framebuffer<L>) {
        let Ok(()) = self.0.show(frame);
    }
}
