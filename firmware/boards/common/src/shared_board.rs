//! The board that all boards are made of.

use crate::{ButtonSource, SerialPort, TickSource};
use board_drivers::Display;
use core::marker::PhantomData;
use pantin_app::{Board, Capacity, Command};
use pantin_figure::rotation::RotationBackend;
use pantin_figure::surface::{Framebuffer, Layout};

/// The types that a board chooses, of which it holds no values.
type Kinds<L, C, R> = fn() -> (L, C, R);

/// A board of a display, a serial port, buttons, a timer, and a function that feeds the watchdog.
///
/// `L` is the layout of the framebuffer, `C` the largest clip, and `R` the arithmetic of rotations. A board's function that makes one returns
/// `impl Board<Layout = L, Capacity = C, Rotation = R>`, from which the compiler infers these three.
pub struct SharedBoard<L, C, R, D, S, B, T, W> {
    display: D,
    serial: S,
    buttons: B,
    timer: T,
    /// Nanoseconds of the timer's tick.
    tick_ns: u32,
    feed: W,
    kinds: PhantomData<Kinds<L, C, R>>,
}

impl<L, C, R, D, S, B, T, W: FnMut()> SharedBoard<L, C, R, D, S, B, T, W> {
    /// Makes a board. The watchdog that `feed` feeds must wait for 1 s at least; a board without one passes `|| {}`.
    #[inline(always)]
    pub fn new(display: D, serial: S, buttons: B, timer: T, feed: W) -> Self {
        SharedBoard { display, serial, buttons, timer, tick_ns: 0, feed, kinds: PhantomData }
    }
}

impl<L: Layout, C, R, D: Display<L>, S, B: ButtonSource, T, W> SharedBoard<L, C, R, D, S, B, T, W> {
    /// Passes on that time has passed.
    fn pass(&mut self, ticks: u32) {
        let ns = self.tick_ns.saturating_mul(ticks);
        self.display.pass(ns);
        self.buttons.read(ns);
    }
}

impl<L, C, R, D, S, B, T, W> Board for SharedBoard<L, C, R, D, S, B, T, W>
where
    L: Layout,
    C: Capacity,
    R: RotationBackend,
    D: Display<L>,
    S: SerialPort,
    B: ButtonSource,
    T: TickSource,
    W: FnMut(),
{
    type Layout = L;
    type Rotation = R;
    type Capacity = C;

    fn present(&mut self, framebuffer: &mut Framebuffer<L>) {
        #[cfg(not(feature = "emulated"))]
        crate::restart::Stage::Sending.enter();
        self.display.present(framebuffer);
        #[cfg(not(feature = "emulated"))]
        crate::restart::Stage::Playing.enter();
        (self.feed)();
    }

    #[inline(always)]
    fn overlay(&mut self, lines: [&str; 2]) -> bool {
        self.display.overlay(lines)
    }

    fn start_timer(&mut self, period_ns: u32) {
        self.tick_ns = period_ns;
        self.timer.start(period_ns);
    }

    fn ticks(&mut self) -> u32 {
        let ticks = self.timer.ticks();
        if ticks > 0 {
            self.pass(ticks);
        }
        ticks
    }

    fn wait_ticks(&mut self) -> u32 {
        let ticks = self.timer.wait(&mut self.feed);
        self.pass(ticks);
        ticks
    }

    fn send(&mut self, bytes: &[u8]) {
        self.serial.send(bytes);
    }

    fn poll(&mut self) -> Option<u8> {
        (self.feed)();
        #[cfg(feature = "buffered")]
        return crate::uart_rx::pop();
        #[cfg(not(feature = "buffered"))]
        self.serial.poll()
    }

    fn button(&mut self) -> Option<Command> {
        self.buttons.take()
    }

    #[cfg(feature = "steer")]
    fn held(&mut self) -> u16 {
        self.buttons.held()
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

#[cfg(not(feature = "emulated"))]
impl<P, L, C, R, D, S, B, T, W> crate::PanicBoard<P> for SharedBoard<L, C, R, D, S, B, T, W>
where
    P: Layout,
    D: Display<P>,
    S: SerialPort,
    W: FnMut(),
{
    fn show(&mut self, framebuffer: &mut Framebuffer<P>) {
        self.display.present(framebuffer);
    }

    fn feed(&mut self) {
        (self.feed)();
    }

    fn send(&mut self, bytes: &[u8]) {
        self.serial.send(bytes);
    }
}
