//! The display over I2C.

use crate::nrf_hal::gpio::{Floating, Input, Pin};
use crate::nrf_hal::pac::TWIM0;
use crate::nrf_hal::twim::{Frequency, Pins, Twim};
use board_drivers::{Display, Mono128x64, Ssd1306};

/// Sets up the SSD1306, or the SH1106. The pins get pull-ups, which keep the bus idle without a display.
pub fn new(twim: TWIM0, scl: Pin<Input<Floating>>, sda: Pin<Input<Floating>>) -> impl Display<Mono128x64> {
    // A panic may have interrupted a transfer.
    twim.enable.reset();
    let new = if cfg!(feature = "sh1106") { Ssd1306::sh1106 } else { Ssd1306::new };
    new(Twim::new(twim, Pins { scl, sda }, Frequency::K400))
}
