//! The board's five buttons: up, down, left and right on port E, select on port F, all low while they are pressed.

use crate::registers::{gpio_e, gpio_f};
use board_common::Buttons;

/// The buttons, on pins that are set up. The emulator holds every line low until its key was once pressed and let go: what is low now
/// does not count.
pub fn start() -> Buttons {
    for port in [gpio_e::DEN, gpio_f::DEN] {
        port.write(port.read() | 0x1f);
    }
    Buttons::new(read())
}

/// Those that are held: the pins are in the order of their bits.
pub fn read() -> u32 {
    let low = !gpio_e::PINS_0_TO_3.read() & 0xf;
    let select = !gpio_f::PIN_1.read() >> 1 & 1;
    low | (select * Buttons::SELECT)
}
