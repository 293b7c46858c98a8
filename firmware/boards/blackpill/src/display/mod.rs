//! The display: the small one over I2C, or with the feature `st7789` the large one over SPI.

#[cfg(feature = "st7789")]
mod lcd;
#[cfg(not(feature = "st7789"))]
mod oled;

#[cfg(feature = "st7789")]
pub use lcd::{Display, Lit, Words};
#[cfg(not(feature = "st7789"))]
pub use oled::{Display, Lit, Words};
