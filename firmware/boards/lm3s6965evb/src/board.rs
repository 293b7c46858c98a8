//! The board's display, timer and line for the program.

use crate::buttons::Buttons;
use crate::display;
use crate::registers::uart0;
use core::sync::atomic::{AtomicU32, Ordering};
use cortex_m::Peripherals;
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::exception;
use pantin_app::{Board, Key};
use pantin_figure::rotation::Rotation;
use pantin_figure::surface::{Frame, Gray4Rows};

/// One tick of the core clock as it is out of reset: 12.5 MHz.
const CLOCK_NS: u32 = 80;
/// The timer counts 24 bits.
const LONGEST: u32 = 1 << 24;

const TRANSMIT_FULL: u32 = 1 << 5;
const RECEIVE_EMPTY: u32 = 1 << 4;

/// The display: 128x64 pixels of 16 greys.
pub type Oled = Gray4Rows<128, 64, 1024>;

/// Timer periods since the start.
static PERIODS: AtomicU32 = AtomicU32::new(0);

#[exception]
fn SysTick() {
    PERIODS.fetch_add(1, Ordering::Relaxed);
}

/// The board.
pub struct Lm3s {
    timer: Option<SYST>,
    /// Timer periods in a tick: more than one where a tick is longer than the timer can count.
    periods: u32,
    /// Ticks that the program was told of.
    told: u32,
    buttons: Buttons,
}

impl Lm3s {
    pub fn new() -> Self {
        display::start();
        Lm3s { timer: Peripherals::take().map(|peripherals| peripherals.SYST), periods: 1, told: 0, buttons: Buttons::new() }
    }

    fn ticks(&self) -> u32 {
        (PERIODS.load(Ordering::Relaxed) / self.periods).wrapping_sub(self.told)
    }
}

impl Board for Lm3s {
    type Layout = Oled;
    type Turning = Rotation;

    fn show(&mut self, frame: &mut Frame<Oled>) {
        display::show(frame);
    }

    fn start_timer(&mut self, nanoseconds: u32) {
        let clocks = nanoseconds / CLOCK_NS;
        self.periods = clocks.div_ceil(LONGEST).max(1);
        self.told = PERIODS.load(Ordering::Relaxed) / self.periods;
        if let Some(timer) = &mut self.timer {
            timer.set_clock_source(SystClkSource::Core);
            timer.set_reload((clocks / self.periods).max(2) - 1);
            timer.clear_current();
            timer.enable_interrupt();
            timer.enable_counter();
        }
    }

    fn wait_ticks(&mut self) -> u32 {
        loop {
            let ticks = self.ticks();
            if ticks > 0 {
                self.told = self.told.wrapping_add(ticks);
                return ticks;
            }
            cortex_m::asm::wfi();
        }
    }

    fn send(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            while uart0::FR.read() & TRANSMIT_FULL != 0 {}
            uart0::DR.write(u32::from(byte));
        }
    }

    fn receive(&mut self) -> u8 {
        while uart0::FR.read() & RECEIVE_EMPTY != 0 {}
        uart0::DR.read() as u8
    }

    fn poll(&mut self) -> Option<u8> {
        (uart0::FR.read() & RECEIVE_EMPTY == 0).then(|| uart0::DR.read() as u8)
    }

    fn button(&mut self) -> Option<Key> {
        self.buttons.pressed()
    }

    #[inline(always)]
    #[allow(unsafe_code)]
    fn mark_start(&mut self) {
        // Safety: moves a register to itself. Memory counts as touched, so that stores stay on their side of it.
        unsafe { core::arch::asm!("mov r9, r9", options(nostack, preserves_flags)) }
    }

    #[inline(always)]
    #[allow(unsafe_code)]
    fn mark_stop(&mut self) {
        // Safety: as above.
        unsafe { core::arch::asm!("mov r10, r10", options(nostack, preserves_flags)) }
    }
}
