//! The board: its serial line, which carries pictures and commands, and its timer.

use crate::registers::uart0;
use crate::{BAUD_CLOCKS, CPU_HZ};
use board_common::cortex_m::SysTick;
use board_common::{Capacity, FnSerial, NoButtons, SharedBoard};
use pantin_app::{Board, frame_stream};
use pantin_figure::surface::{Framebuffer, Gray4Rows};

#[cfg(not(feature = "micromath"))]
use pantin_figure::rotation::Rotation;
#[cfg(feature = "micromath")]
use pantin_figure::rotation_float::FloatRotation as Rotation;

const TRANSMIT_FULL: u32 = 1 << 0;
const RECEIVE_FULL: u32 = 1 << 1;

/// The pictures' layout: 128x64 pixels of 16 greys, as on the reference machine.
type Pictures = Gray4Rows<128, 64, 1024>;

/// Sets the board up.
pub fn new() -> impl Board<Layout = Pictures, Rotation = Rotation, Capacity = Capacity> {
    uart0::BAUDDIV.write(BAUD_CLOCKS);
    // Transmitter and receiver on.
    uart0::CTRL.write(1 << 0 | 1 << 1);
    let display = |framebuffer: &mut Framebuffer<Pictures>| frame_stream::send(framebuffer, send);
    SharedBoard::new(display, FnSerial { send, poll }, NoButtons, SysTick::<CPU_HZ>::new(), || {})
}

fn send(bytes: &[u8]) {
    for &byte in bytes {
        while uart0::STATE.read() & TRANSMIT_FULL != 0 {}
        uart0::DATA.write(u32::from(byte));
    }
}

fn poll() -> Option<u8> {
    (uart0::STATE.read() & RECEIVE_FULL != 0).then(|| uart0::DATA.read() as u8)
}
