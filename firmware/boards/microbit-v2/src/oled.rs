//! The SSD1306 on the edge connector: SCL on P19, SDA on P20.

use board_parts::ssd1306::{ADDRESS, Pages, Ssd1306};
use nrf52833_hal::gpio::{Floating, Input, Pin};
use nrf52833_hal::pac::TWIM0;
use nrf52833_hal::twim::{Frequency, Pins, Twim};
use pantin_figure::surface::Framebuffer;

/// The display.
pub struct Oled(Ssd1306<Twim<TWIM0>>);

impl Oled {
    /// On a bus that without a display is idle: its pins pull it up.
    pub fn new(bus: TWIM0, clock: Pin<Input<Floating>>, data: Pin<Input<Floating>>) -> Self {
        // After a panic it may be in the middle of something.
        bus.enable.reset();
        Oled(Ssd1306::new(Twim::new(bus, Pins { scl: clock, sda: data }, Frequency::K400), ADDRESS))
    }

    /// Brings it up to date. One that does not answer is asked again with the next picture.
    pub fn show(&mut self, frame: &mut Framebuffer<Pages>) {
        let _ = self.0.show(frame);
    }
}
