//! The SSD1306: SDA on GP4, SCL on GP5.

use super::Free;
use board_parts::ssd1306::{ADDRESS, Pages, Ssd1306};
use pantin_figure::surface::Framebuffer;
use rp2040_hal::I2C;
use rp2040_hal::fugit::RateExtU32;
use rp2040_hal::gpio::bank0::{Gpio4, Gpio5};
use rp2040_hal::gpio::{FunctionI2C, Pin, PullUp};
use rp2040_hal::pac::{I2C0, RESETS};

/// How the display keeps its pixels.
pub type Lit = Pages;
/// How a page of words is kept.
pub type Words = Pages;

type Bus = I2C<I2C0, (Pin<Gpio4, FunctionI2C, PullUp>, Pin<Gpio5, FunctionI2C, PullUp>)>;

/// The display.
pub struct Display(Ssd1306<Bus>);

impl Display {
    pub fn new(bus: I2C0, data: Free<Gpio4>, clock: Free<Gpio5>, resets: &mut RESETS) -> Self {
        let bus = I2C::i2c0(bus, data.reconfigure(), clock.reconfigure(), 400.kHz(), resets, crate::clocks::RATE.Hz());
        Display(Ssd1306::new(bus, ADDRESS))
    }

    /// Brings it up to date. One that does not answer is asked again with the next picture.
    pub fn show(&mut self, frame: &mut Framebuffer<Pages>) {
        let _ = self.0.show(frame);
    }
}
