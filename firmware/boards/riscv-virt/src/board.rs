//! The machine's line, which carries pictures and keys, and its time for the program.

use crate::registers::{MTIME, uart};
use board_common::{Pace, markers};
use pantin_app::{Board, frame_stream};
use pantin_figure::rotation::Rotation;
use pantin_figure::surface::{Framebuffer, MonoPages};

/// The pictures: 128x64 pixels, lit or dark, as on the SSD1306 of an ESP32-C3.
pub type Pages = MonoPages<128, 64, 1024>;

/// Counts of the time a microsecond.
const RATE: u32 = 10;

const RECEIVED: u8 = 1 << 0;
const TRANSMIT_EMPTY: u8 = 1 << 5;

/// The machine.
pub struct Virt {
    pace: Pace,
}

impl Virt {
    pub fn new() -> Self {
        Virt { pace: Pace::new(RATE) }
    }
}

fn send(bytes: &[u8]) {
    for &byte in bytes {
        while uart::LINE_STATUS.read() & TRANSMIT_EMPTY == 0 {}
        uart::DATA.write(byte);
    }
}

impl Board for Virt {
    type Layout = Pages;
    type Rotation = Rotation;
    type Capacity = board_common::Capacity;

    fn present(&mut self, framebuffer: &mut Framebuffer<Pages>) {
        frame_stream::send(framebuffer, send);
    }

    fn start_timer(&mut self, period_ns: u32) {
        self.pace.start(period_ns, MTIME.read());
    }

    fn ticks(&mut self) -> u32 {
        self.pace.ticks(MTIME.read())
    }

    fn send(&mut self, bytes: &[u8]) {
        send(bytes);
    }

    fn poll(&mut self) -> Option<u8> {
        (uart::LINE_STATUS.read() & RECEIVED != 0).then(|| uart::DATA.read())
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
