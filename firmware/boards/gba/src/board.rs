//! The console: its display, buttons and frames. It has no serial line that a user can reach.

use crate::display::{Lcd, Screen};
use crate::keys::Keys;
use crate::registers::WAIT_STATES;
use crate::timer::BlankTimer;
use board_common::{FnSerial, SharedBoard};
use pantin_app::Board;
use pantin_figure::rotation::Rotation;

include!(concat!(env!("OUT_DIR"), "/capacity.rs"));

/// The cartridge's memory with 3 and 1 wait states, and with prefetch: what all games use.
const FAST_CARTRIDGE: u16 = 0x4317;

/// Sets the console up.
pub fn new() -> impl Board<Layout = Lcd, Rotation = Rotation, Capacity = Capacity> {
    WAIT_STATES.write(FAST_CARTRIDGE);
    let no_serial = FnSerial { send: |_: &[u8]| {}, poll: || None };
    SharedBoard::new(Screen::start(), no_serial, Keys::new(), BlankTimer::new(), || {})
}
