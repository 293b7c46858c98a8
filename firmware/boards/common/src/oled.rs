//! The display over I2C that a board's features choose: an SSD1306 of 128x64 pixels, or another one.

use board_drivers::Ssd1306;
use embedded_hal::i2c::I2c;

/// The layout of its pictures.
#[cfg(not(any(feature = "ssd1306-128x32", feature = "ssd1306-72x40")))]
pub type OledPicture = board_drivers::Mono128x64;
/// The layout of its pictures.
#[cfg(feature = "ssd1306-128x32")]
pub type OledPicture = board_drivers::Mono128x32;
/// The layout of its pictures.
#[cfg(feature = "ssd1306-72x40")]
pub type OledPicture = board_drivers::Mono72x40;

/// Makes its driver.
#[inline(always)]
pub fn oled<B: I2c>(bus: B) -> Ssd1306<B, OledPicture> {
    #[cfg(feature = "sh1106")]
    return Ssd1306::sh1106(bus);
    #[cfg(feature = "ssd1306-128x32")]
    return Ssd1306::of_128x32(bus);
    #[cfg(feature = "ssd1306-72x40")]
    return Ssd1306::of_72x40(bus);
    #[cfg(not(any(feature = "sh1106", feature = "ssd1306-128x32", feature = "ssd1306-72x40")))]
    Ssd1306::new(bus)
}
