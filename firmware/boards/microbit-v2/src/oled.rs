//! The display over I2C.

use crate::nrf_hal::gpio::{Floating, Input, Pin};
use crate::nrf_hal::pac::TWIM0;
use crate::nrf_hal::twim::{Frequency, Pins, Twim};
use board_drivers::Ssd1306;

/// Sets up the SSD1306, or the SH1106, on a bus that is reported first. The pins get pull-ups, which keep the bus idle without a display.
pub fn new(
    twim: TWIM0,
    scl: Pin<Input<Floating>>,
    sda: Pin<Input<Floating>>,
    report: impl FnOnce(&mut Twim<TWIM0>),
) -> Ssd1306<Twim<TWIM0>> {
    // A panic may have interrupted a transfer.
    twim.enable.reset();
    let mut bus = Twim::new(twim, Pins { scl, sda }, Frequency::K400);
    report(&mut bus);
    let new = if cfg!(feature = "sh1106") { Ssd1306::sh1106 } else { Ssd1306::new };
    new(bus)
}
