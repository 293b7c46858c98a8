//! The board: its serial line, which carries pictures and commands, and its timer.

use crate::registers::{timer0, uart};
use board_common::{FnSerial, Mono128x64, NoButtons, SharedBoard, TickTimer};
use pantin_app::{Board, frame_stream};
use pantin_figure::rotation::Rotation;
use pantin_figure::surface::Framebuffer;

/// The timer's frequency.
const TIMER_HZ: u32 = 16_000_000;

include!(concat!(env!("OUT_DIR"), "/capacity.rs"));

/// Sets the board up.
pub fn new() -> impl Board<Layout = Mono128x64, Rotation = Rotation, Capacity = Capacity> {
    uart::ENABLE.write(4);
    uart::START_TRANSMITTER.write(1);
    #[cfg(feature = "update")]
    crate::uart_rx::listen();
    uart::START_RECEIVER.write(1);
    // A counter of 32 bits without prescaler.
    timer0::BIT_MODE.write(3);
    timer0::PRESCALER.write(0);
    timer0::START.write(1);
    let display = |framebuffer: &mut Framebuffer<Mono128x64>| frame_stream::send(framebuffer, send);
    SharedBoard::new(display, FnSerial { send, poll }, NoButtons, TickTimer::<TIMER_HZ, _, _>::new(now, || {}), || {})
}

fn now() -> u32 {
    timer0::CAPTURE_0.write(1);
    timer0::CC_0.read()
}

fn send(bytes: &[u8]) {
    for &byte in bytes {
        uart::TRANSMITTED.write(0);
        uart::TXD.write(u32::from(byte));
        while uart::TRANSMITTED.read() == 0 {}
    }
}

/// Returns the next byte received.
pub fn poll() -> Option<u8> {
    if uart::RECEIVED.read() == 0 {
        return None;
    }
    // Cleared before the byte is read: reading lets the next one in.
    uart::RECEIVED.write(0);
    Some(uart::RXD.read() as u8)
}
