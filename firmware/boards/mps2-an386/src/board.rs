//! The board's line, which carries pictures and keys, and its timer for the program.

use crate::registers::uart0;
use board_common::cortex_m::SysTick;
use board_common::markers;
use pantin_app::{Board, frame_stream};
use pantin_figure::surface::{Framebuffer, Gray4Rows};

/// Kilohertz of the core clock.
const RATE: u32 = 25_000;
/// Clocks a bit: 115 200 bits a second.
const BAUD_CLOCKS: u32 = 217;

const TRANSMIT_FULL: u32 = 1 << 0;
const RECEIVE_FULL: u32 = 1 << 1;

/// The pictures: 128x64 pixels of 16 greys, as on the reference machine.
pub type Oled = Gray4Rows<128, 64, 1024>;

/// The board.
pub struct Mps2 {
    timer: SysTick<RATE>,
}

impl Mps2 {
    pub fn new() -> Self {
        uart0::BAUDDIV.write(BAUD_CLOCKS);
        // Transmitter and receiver.
        uart0::CTRL.write(1 << 0 | 1 << 1);
        Mps2 { timer: SysTick::new() }
    }
}

fn send(bytes: &[u8]) {
    for &byte in bytes {
        while uart0::STATE.read() & TRANSMIT_FULL != 0 {}
        uart0::DATA.write(u32::from(byte));
    }
}

impl Board for Mps2 {
    type Layout = Oled;
    #[cfg(not(feature = "micromath"))]
    type Rotation = pantin_figure::rotation::Rotation;
    #[cfg(feature = "micromath")]
    type Rotation = pantin_figure::rotation_float::FloatRotation;
    type Capacity = board_common::Capacity;

    fn present(&mut self, framebuffer: &mut Framebuffer<Oled>) {
        frame_stream::send(framebuffer, send);
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
        send(bytes);
    }

    fn poll(&mut self) -> Option<u8> {
        (uart0::STATE.read() & RECEIVE_FULL != 0).then(|| uart0::DATA.read() as u8)
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
