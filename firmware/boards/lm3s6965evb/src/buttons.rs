//! The board's five buttons: up, down, left and right on port E, select on port F. Their pins are low while they are pressed.

use crate::registers::{gpio_e, gpio_f};
use board_common::Buttons;

/// Sets the pins up. The emulator holds every pin low until its key has been pressed and released once: buttons that are low now
/// give no command.
pub fn start() -> Buttons<impl FnMut() -> u32> {
    for port in [gpio_e::DEN, gpio_f::DEN] {
        port.write(port.read() | 0x1f);
    }
    Buttons::new(held(), held)
}

/// Returns the buttons that are held. The pins are in the order of the bits.
fn held() -> u32 {
    let low = !gpio_e::PINS_0_TO_3.read() & 0xf;
    let select = !gpio_f::PIN_1.read() >> 1 & 1;
    low | (select * Buttons::SELECT)
}
