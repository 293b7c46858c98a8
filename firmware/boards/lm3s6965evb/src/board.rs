//! The board: its display, serial line, buttons and timer.

#[cfg(feature = "ethernet")]
use crate::ethernet::Ethernet;
use crate::registers::uart0;
use crate::{buttons, display};
use board_common::cortex_m::SysTick;
use board_common::{FnSerial, SharedBoard};
use pantin_app::Board;
use pantin_figure::rotation::Rotation;
use pantin_figure::surface::Gray4Rows;

/// The core clock after reset.
const CPU_HZ: u32 = 12_500_000;

const TRANSMIT_FULL: u32 = 1 << 5;
const RECEIVE_EMPTY: u32 = 1 << 4;
/// Bytes of 8 bits, and a buffer of 16 of them while the program draws.
#[cfg(feature = "link")]
const EIGHT_BITS: u32 = 3 << 5;
#[cfg(feature = "link")]
const FIFO: u32 = 1 << 4;

include!(concat!(env!("OUT_DIR"), "/capacity.rs"));

/// The display's layout: 128x64 pixels of 16 greys.
pub type Oled = Gray4Rows<128, 64, 1024>;

/// Sets the board up.
pub fn new() -> impl Board<Layout = Oled, Rotation = Rotation, Capacity = Capacity> {
    display::start();
    #[cfg(feature = "link")]
    uart0::LCRH.write(EIGHT_BITS | FIFO);
    #[cfg(feature = "ethernet")]
    let poll = {
        let mut ethernet = Ethernet::new();
        move || poll().or_else(|| ethernet.poll())
    };
    SharedBoard::new(display::show, FnSerial { send, poll }, buttons::start(), SysTick::<CPU_HZ>::new(), || {})
}

fn send(bytes: &[u8]) {
    for &byte in bytes {
        while uart0::FR.read() & TRANSMIT_FULL != 0 {}
        uart0::DR.write(u32::from(byte));
    }
}

fn poll() -> Option<u8> {
    (uart0::FR.read() & RECEIVE_EMPTY == 0).then(|| uart0::DR.read() as u8)
}
