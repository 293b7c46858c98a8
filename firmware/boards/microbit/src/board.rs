//! The board's line, which carries pictures and keys, and its timer for the program.

use crate::registers::{timer0, uart};
use board_common::{Pace, markers};
use pantin_app::{Board, frame_stream};
use pantin_figure::rotation::Rotation;
use pantin_figure::surface::{Framebuffer, MonoPages};

/// The pictures: 128x64 pixels, lit or dark.
pub type Pages = MonoPages<128, 64, 1024>;

/// Counts of the timer a microsecond.
const RATE: u32 = 16;

include!(concat!(env!("OUT_DIR"), "/capacity.rs"));

/// The board.
pub struct Microbit {
    pace: Pace,
}

impl Microbit {
    pub fn new() -> Self {
        uart::ENABLE.write(4);
        uart::START_TRANSMITTER.write(1);
        #[cfg(feature = "update")]
        crate::received::start();
        uart::START_RECEIVER.write(1);
        // 32 bits, every clock.
        timer0::BIT_MODE.write(3);
        timer0::PRESCALER.write(0);
        timer0::START.write(1);
        Microbit { pace: Pace::new(RATE) }
    }
}

/// Where the timer is.
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

impl Board for Microbit {
    type Layout = Pages;
    type Rotation = Rotation;
    type Capacity = Capacity;

    fn present(&mut self, framebuffer: &mut Framebuffer<Pages>) {
        frame_stream::send(framebuffer, send);
    }

    fn start_timer(&mut self, period_ns: u32) {
        self.pace.start(period_ns, now());
    }

    fn ticks(&mut self) -> u32 {
        self.pace.ticks(now())
    }

    fn send(&mut self, bytes: &[u8]) {
        send(bytes);
    }

    #[cfg(feature = "update")]
    fn poll(&mut self) -> Option<u8> {
        crate::received::take()
    }

    #[cfg(not(feature = "update"))]
    fn poll(&mut self) -> Option<u8> {
        if uart::RECEIVED.read() == 0 {
            return None;
        }
        // Before the byte is fetched: fetching it lets the next one in.
        uart::RECEIVED.write(0);
        Some(uart::RXD.read() as u8)
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
