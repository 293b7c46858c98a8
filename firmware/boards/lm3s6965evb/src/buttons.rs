//! The board's five buttons: up, down, left and right on port E, select on port F, all low while they are pressed.
//!
//! Alone, up and down change the speed, left and right go round the figure, and select pauses. While select is held, left and
//! right step back and forward, up goes to the next clip and down plays the other way round; select let go after that does not pause.

use crate::registers::{gpio_e, gpio_f};
use pantin_app::Key;

/// Bits of the buttons, as they are gathered here.
const UP: u32 = 1 << 0;
const DOWN: u32 = 1 << 1;
const LEFT: u32 = 1 << 2;
const RIGHT: u32 = 1 << 3;
const SELECT: u32 = 1 << 4;

/// Which are held, and what that has meant so far.
pub struct Buttons {
    held: u32,
    /// Another one was pressed while select was held.
    chord: bool,
}

impl Buttons {
    /// All let go. The emulator holds every line low until its key was once pressed and let go: what is low now does not count.
    pub fn new() -> Self {
        for port in [gpio_e::DEN, gpio_f::DEN] {
            port.write(port.read() | 0x1f);
        }
        Buttons { held: read(), chord: true }
    }

    /// What a button asks for that was pressed, or select when it is let go, since the last call.
    pub fn pressed(&mut self) -> Option<Key> {
        let now = read();
        let (down, up) = (now & !self.held, self.held & !now);
        self.held = now;
        let select = now & SELECT != 0;
        if down & SELECT != 0 {
            self.chord = false;
        }
        if up & SELECT != 0 && !self.chord {
            return Some(Key::Pause);
        }
        let key = match (down & !SELECT, select) {
            (UP, false) => Key::Faster,
            (DOWN, false) => Key::Slower,
            (LEFT, false) => Key::OrbitLeft,
            (RIGHT, false) => Key::OrbitRight,
            (UP, true) => Key::NextClip,
            (DOWN, true) => Key::Reverse,
            (LEFT, true) => Key::Back,
            (RIGHT, true) => Key::Step,
            _ => return None,
        };
        self.chord = true;
        Some(key)
    }
}

/// The buttons that are held.
fn read() -> u32 {
    let low = !gpio_e::PINS_0_TO_3.read() & 0xf;
    let select = !gpio_f::PIN_1.read() >> 1 & 1;
    low | (select * SELECT)
}
