//! The SSD1306: SCL on PB6, SDA on PB7.

use board_parts::ssd1306::{ADDRESS, Pages, Ssd1306};
use pantin_figure::surface::Framebuffer;
use stm32f4xx_hal::gpio::{PB6, PB7};
use stm32f4xx_hal::i2c::I2c;
use stm32f4xx_hal::pac::I2C1;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::Rcc;

/// How the display keeps its pixels.
pub type Lit = Pages;
/// How a page of words is kept.
pub type Words = Pages;

/// The display.
pub struct Display(Ssd1306<I2c<I2C1>>);

impl Display {
    /// On a bus that without a display is idle: its pins pull it up.
    pub fn new(bus: I2C1, clock: PB6, data: PB7, control: &mut Rcc) -> Self {
        let pins = (clock.internal_pull_up(true), data.internal_pull_up(true));
        Display(Ssd1306::new(bus.i2c(pins, 400.kHz(), control), ADDRESS))
    }

    /// Brings it up to date. One that does not answer is asked again with the next picture.
    pub fn show(&mut self, frame: &mut Framebuffer<Pages>) {
        let _ = self.0.show(frame);
    }
}
