//! The board's display, timer and line for the program.

#[cfg(feature = "ethernet")]
use crate::ethernet::Ethernet;
use crate::registers::uart0;
use crate::{buttons, display};
use board_common::cortex_m::SysTick;
use board_common::{Buttons, markers};
use pantin_app::{Board, Command};
use pantin_figure::rotation::Rotation;
use pantin_figure::surface::{Framebuffer, Gray4Rows};

/// Kilohertz of the core clock as it is out of reset.
const RATE: u32 = 12_500;

const TRANSMIT_FULL: u32 = 1 << 5;
const RECEIVE_EMPTY: u32 = 1 << 4;
/// Bytes of 8 bits, and 16 of them held for a program that is drawing.
#[cfg(feature = "link")]
const EIGHT_BITS: u32 = 3 << 5;
#[cfg(feature = "link")]
const FIFO: u32 = 1 << 4;

/// The display: 128x64 pixels of 16 greys.
pub type Oled = Gray4Rows<128, 64, 1024>;

include!(concat!(env!("OUT_DIR"), "/capacity.rs"));

/// The board.
pub struct Lm3s {
    timer: SysTick<RATE>,
    buttons: Buttons,
    #[cfg(feature = "ethernet")]
    ethernet: Ethernet,
}

impl Lm3s {
    pub fn new() -> Self {
        display::start();
        #[cfg(feature = "link")]
        uart0::LCRH.write(EIGHT_BITS | FIFO);
        Lm3s {
            timer: SysTick::new(),
            buttons: buttons::start(),
            #[cfg(feature = "ethernet")]
            ethernet: Ethernet::new(),
        }
    }
}

impl Board for Lm3s {
    type Layout = Oled;
    type Rotation = Rotation;
    type Capacity = Capacity;

    fn present(&mut self, framebuffer: &mut Framebuffer<Oled>) {
        display::show(framebuffer);
    }

    fn start_timer(&mut self, period_ns: u32) {
        self.timer.start(period_ns);
    }

    fn ticks(&mut self) -> u32 {
        self.timer.ticks()
    }

    fn wait_ticks(&mut self) -> u32 {
        self.timer.wait(|| {})
    }

    fn send(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            while uart0::FR.read() & TRANSMIT_FULL != 0 {}
            uart0::DR.write(u32::from(byte));
        }
    }

    fn poll(&mut self) -> Option<u8> {
        let serial = || (uart0::FR.read() & RECEIVE_EMPTY == 0).then(|| uart0::DR.read() as u8);
        #[cfg(feature = "ethernet")]
        let mut serial = || serial().or_else(|| self.ethernet.poll());
        serial()
    }

    fn button(&mut self) -> Option<Command> {
        self.buttons.pressed(buttons::read())
    }

    #[inline(always)]
    fn mark_start(&mut self) {
        markers::start();
    }

    #[inline(always)]
    fn mark_stop(&mut self) {
        markers::stop();
    }
}
