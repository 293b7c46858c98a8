//! The machine: its serial line, which carries pictures and commands, and its clock.

use crate::registers::{MTIME, uart};
use board_common::{Capacity, FnSerial, Mono128x64, NoButtons, SharedBoard, TickTimer};
use pantin_app::{Board, frame_stream};
use pantin_figure::rotation::Rotation;
use pantin_figure::surface::Framebuffer;

/// The clock's frequency.
const MTIME_HZ: u32 = 10_000_000;

const RECEIVED: u8 = 1 << 0;
const TRANSMIT_EMPTY: u8 = 1 << 5;

/// Makes the board. The pictures are those of an ESP32-C3 with its SSD1306.
pub fn new() -> impl Board<Layout = Mono128x64, Rotation = Rotation, Capacity = Capacity> {
    let timer = TickTimer::<MTIME_HZ, _, _>::new(|| MTIME.read(), || {});
    let display = |framebuffer: &mut Framebuffer<Mono128x64>| frame_stream::send(framebuffer, send);
    SharedBoard::new(display, FnSerial { send, poll }, NoButtons, timer, || {})
}

fn send(bytes: &[u8]) {
    for &byte in bytes {
        while uart::LINE_STATUS.read() & TRANSMIT_EMPTY == 0 {}
        uart::DATA.write(byte);
    }
}

fn poll() -> Option<u8> {
    (uart::LINE_STATUS.read() & RECEIVED != 0).then(|| uart::DATA.read())
}
