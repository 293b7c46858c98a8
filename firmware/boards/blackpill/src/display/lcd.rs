//! The ST7789: chip select on PA4, clock on PA5, data on PA7, data or command on PB0.

use crate::clocks;
use board_parts::St7789;
use embedded_graphics::pixelcolor::Rgb565;
use embedded_hal::delay::DelayNs;
use embedded_hal::spi::MODE_0;
use embedded_hal_bus::spi::{ExclusiveDevice, NoDelay};
use pantin_figure::surface::{Framebuffer, Gray4Rows, Layout, MonoPages};
use stm32f4xx_hal::gpio::{Output, PA4, PA5, PA7, PB0};
use stm32f4xx_hal::pac::SPI1;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::Rcc;
use stm32f4xx_hal::spi::Spi;

/// How the display's pixels are kept: in 16 greys, in 28,800 bytes. In colour they would leave too little of the RAM for the stack.
pub type Lit = Gray4Rows<240, 240, 7200>;
/// How a page of words is kept: where the program came to harm there may be no room for another picture.
pub type Words = MonoPages<240, 240, 7200>;

/// Select, clock, data out, and whether these are data.
pub type Pins = (PA4, PA5, PA7, PB0);

/// Waits by counting.
struct Wait;

impl DelayNs for Wait {
    fn delay_ns(&mut self, nanoseconds: u32) {
        clocks::wait(nanoseconds);
    }
}

/// The display.
pub struct Display(St7789<ExclusiveDevice<Spi<SPI1>, PA4<Output>, NoDelay>, PB0<Output>>);

impl Display {
    /// Of the bus, its pins, and what sets it up.
    pub fn new(bus: SPI1, pins: Pins, control: &mut Rcc) -> Self {
        let (select, clock, out, data) = pins;
        // The chip's fastest: half of its clock.
        let bus = bus.spi((Some(clock), SPI1::NoMiso, Some(out)), MODE_0, 50.MHz(), control);
        let Ok(bus) = ExclusiveDevice::new_no_delay(bus, select.into_push_pull_output());
        match St7789::new(bus, data.into_push_pull_output(), &mut Wait) {
            Some(display) => Display(display),
            None => panic!("the display's bus fails"),
        }
    }

    /// Brings it up to date. What a bus that fails has lost is sent when it changes again.
    pub fn show<L: Layout<Ink: Into<Rgb565>>>(&mut self, frame: &mut Framebuffer<L>) {
        let _ = self.0.show(frame);
    }
}
