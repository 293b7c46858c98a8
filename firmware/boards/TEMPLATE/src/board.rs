//! The board's display, buttons, clock, line and watchdog for the program. In a copy, the chip's own types can stand for the parameters.

use board_common::{Buttons, Pace};
use board_parts::ssd1306::{ADDRESS, Pages, Ssd1306};
use embedded_hal::digital::InputPin;
use embedded_hal::i2c::I2c;
use embedded_hal_nb::nb;
use embedded_hal_nb::serial::{Read, Write};
use pantin_app::{Board, Command};
use pantin_figure::rotation::Rotation;
use pantin_figure::surface::Framebuffer;

/// A counter that runs on: 32 bits, and round again.
pub trait Clock {
    /// Counts a microsecond: 1 to 1000.
    const RATE: u32;

    /// Where it is.
    fn now(&self) -> u32;
}

/// What starts the board anew when the program is stuck; its patience is a second at least.
pub trait Watchdog {
    /// The program goes on.
    fn feed(&mut self);
}

/// The board.
pub struct MyBoard<B, L, P, C, W> {
    display: Ssd1306<B>,
    line: L,
    /// Up, down, left, right and select, to ground while they are pressed.
    pins: [P; 5],
    buttons: Buttons,
    clock: C,
    pace: Pace,
    watchdog: W,
}

impl<B: I2c, L, P, C: Clock, W> MyBoard<B, L, P, C, W> {
    /// Of a bus of at most 400 kHz, a line, pins with pull-ups, a clock and a watchdog.
    pub fn new(bus: B, line: L, pins: [P; 5], clock: C, watchdog: W) -> Self {
        let (display, buttons, pace) = (Ssd1306::new(bus, ADDRESS), Buttons::new(0), Pace::new(C::RATE));
        MyBoard { display, line, pins, buttons, clock, pace, watchdog }
    }
}

impl<B: I2c, L, P, C, W: Watchdog> MyBoard<B, L, P, C, W> {
    /// Shows words: a panic's.
    pub fn tell(&mut self, page: &mut Framebuffer<Pages>) {
        // Nobody is left who could be told that the display does not answer.
        let _ = self.display.show(page);
    }

    /// Tells the watchdog that the program goes on.
    pub fn feed(&mut self) {
        self.watchdog.feed();
    }
}

impl<B: I2c, L: Read + Write, P: InputPin, C: Clock, W: Watchdog> Board for MyBoard<B, L, P, C, W> {
    // YOUR BOARD: the display's layout, one of `pantin_figure::surface`, or your own.
    type Layout = Pages;
    // YOUR BOARD: in whole numbers; `FloatRotation` (feature `micromath` of `pantin-figure`) takes longer even on a Cortex-M4F.
    type Rotation = Rotation;
    type Capacity = board_common::Capacity;

    fn present(&mut self, framebuffer: &mut Framebuffer<Pages>) {
        // A display that does not answer is asked again with the next picture.
        let _ = self.display.show(framebuffer);
        self.watchdog.feed();
    }

    fn start_timer(&mut self, period_ns: u32) {
        self.pace.start(period_ns, self.clock.now());
    }

    fn ticks(&mut self) -> u32 {
        self.feed();
        let ticks = self.pace.ticks(self.clock.now());
        if ticks > 0 {
            let held = self.pins.iter_mut().rev().fold(0, |held, pin| held << 1 | u32::from(matches!(pin.is_low(), Ok(true))));
            self.buttons.look(held);
        }
        ticks
    }

    fn send(&mut self, bytes: &[u8]) {
        for byte in bytes {
            // A byte that the line cannot send is left out.
            let _ = nb::block!(self.line.write(*byte));
        }
    }

    fn poll(&mut self) -> Option<u8> {
        self.watchdog.feed();
        self.line.read().ok()
    }

    fn button(&mut self) -> Option<Command> {
        self.buttons.wish()
    }
}
