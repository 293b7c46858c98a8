//! The phone's display, timer and line for the program.

use crate::display;
use crate::registers::{timer1, uart1};
use board_common::{Pace, markers};
use pantin_app::Board;
use pantin_figure::rotation::Rotation;
use pantin_figure::surface::{Framebuffer, Rgb565Rows};

/// The display: 176x220 pixels of 16 bits.
pub type Lcd = Rgb565Rows<176, 220, 19360>;

/// Counts of the timer a microsecond.
const RATE: u32 = 6;

const RECEIVED: u8 = 1 << 0;
const TRANSMITTER_EMPTY: u8 = 1 << 5;

/// The phone.
pub struct Sx1 {
    pace: Pace,
}

impl Sx1 {
    pub fn new() -> Self {
        display::start();
        timer1::LOAD.write(u32::MAX);
        // Clock on, loaded anew at 0, started.
        timer1::CONTROL.write(1 << 5 | 1 << 1 | 1 << 0);
        Sx1 { pace: Pace::new(RATE) }
    }
}

/// How far the timer has come: it counts down.
fn now() -> u32 {
    !timer1::READ.read()
}

impl Board for Sx1 {
    type Layout = Lcd;
    type Rotation = Rotation;
    type Capacity = board_common::Capacity;

    fn present(&mut self, framebuffer: &mut Framebuffer<Lcd>) {
        display::show(framebuffer);
    }

    fn start_timer(&mut self, period_ns: u32) {
        self.pace.start(period_ns, now());
    }

    fn ticks(&mut self) -> u32 {
        self.pace.ticks(now())
    }

    fn send(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            while uart1::LINE_STATUS.read() & TRANSMITTER_EMPTY == 0 {}
            uart1::DATA.write(byte);
        }
    }

    fn poll(&mut self) -> Option<u8> {
        (uart1::LINE_STATUS.read() & RECEIVED != 0).then(|| uart1::DATA.read())
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
