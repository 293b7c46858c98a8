//! The phone: its display, serial line and timer.

use crate::display;
use crate::registers::{timer1, uart1};
use board_common::{Capacity, FnSerial, NoButtons, SharedBoard, TickTimer};
use pantin_app::Board;
use pantin_figure::rotation::Rotation;
use pantin_figure::surface::Rgb565Rows;

/// The display's layout: 176x220 pixels of 16 bits.
pub type Lcd = Rgb565Rows<176, 220, 19360>;

/// The timer's frequency.
const TIMER_HZ: u32 = 6_000_000;

const RECEIVED: u8 = 1 << 0;
const TRANSMITTER_EMPTY: u8 = 1 << 5;

/// Sets the phone up.
pub fn new() -> impl Board<Layout = Lcd, Rotation = Rotation, Capacity = Capacity> {
    display::start();
    timer1::LOAD.write(u32::MAX);
    // Clock on, reloaded at 0, started.
    timer1::CONTROL.write(1 << 5 | 1 << 1 | 1 << 0);
    // The timer counts down.
    let timer = TickTimer::<TIMER_HZ, _, _>::new(|| !timer1::READ.read(), || {});
    SharedBoard::new(display::show, FnSerial { send, poll }, NoButtons, timer, || {})
}

fn send(bytes: &[u8]) {
    for &byte in bytes {
        while uart1::LINE_STATUS.read() & TRANSMITTER_EMPTY == 0 {}
        uart1::DATA.write(byte);
    }
}

fn poll() -> Option<u8> {
    (uart1::LINE_STATUS.read() & RECEIVED != 0).then(|| uart1::DATA.read())
}
