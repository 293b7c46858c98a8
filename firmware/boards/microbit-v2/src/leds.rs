//! The 5x5 lights. They share wires by rows and columns, so that a row is lit at a time, for a millisecond; brightness is how many of three
//! rounds a light is lit in.
#![allow(unsafe_code)]

use board_parts::tiny::{Lights, SIDE};
use core::sync::atomic::{AtomicU32, AtomicUsize, Ordering};
use nrf52833_hal::Timer;
use nrf52833_hal::gpio::{Disconnected, Level, Pin};
use nrf52833_hal::pac::{NVIC, P0, P1, TIMER1, interrupt};
use nrf52833_hal::timer::Periodic;

/// Microseconds for which a row is lit.
const ROW: u32 = 1000;
/// Bits of the rows and of the columns in port 0; one column is in port 1. A row is lit while high, its lights while their columns are low.
const ROWS: [u32; SIDE] = [1 << 21, 1 << 22, 1 << 15, 1 << 24, 1 << 19];
const COLUMNS: [u32; SIDE] = [1 << 28, 1 << 11, 1 << 31, 0, 1 << 30];
const FOURTH: u32 = 1 << 5;
const ALL: [u32; 2] = [ROWS[0] | ROWS[1] | ROWS[2] | ROWS[3] | ROWS[4], COLUMNS[0] | COLUMNS[1] | COLUMNS[2] | COLUMNS[4]];

/// The lights of each round, the first of a row in its lowest bit, row after row.
static ROUNDS: [AtomicU32; 3] = [AtomicU32::new(0), AtomicU32::new(0), AtomicU32::new(0)];

/// The timer that goes on to the next row.
pub struct Leds {
    _timer: Timer<TIMER1, Periodic>,
}

impl Leds {
    /// Of their pins: rows and columns.
    pub fn new(rows: [Pin<Disconnected>; SIDE], columns: [Pin<Disconnected>; SIDE], timer: TIMER1) -> Self {
        let _ = rows.map(|row| row.into_push_pull_output(Level::Low));
        let _ = columns.map(|column| column.into_push_pull_output(Level::High));
        let mut timer = Timer::periodic(timer);
        timer.enable_interrupt();
        timer.start(ROW);
        // Safety: nothing relies on that interrupt's being masked.
        unsafe { NVIC::unmask(interrupt::TIMER1) };
        Leds { _timer: timer }
    }
}

#[interrupt]
fn TIMER1() {
    // Safety: nothing else touches that register after the timer was set up.
    unsafe { &*TIMER1::ptr() }.events_compare[0].reset();
    next();
}

/// Shows these from the next row on.
pub fn set(lights: &Lights) {
    for (least, round) in (1..).zip(&ROUNDS) {
        let bits = lights.as_flattened().iter().rev().fold(0, |bits, light| bits << 1 | u32::from(*light >= least));
        round.store(bits, Ordering::Relaxed);
    }
}

/// Lights the next row.
pub fn next() {
    static SLOT: AtomicUsize = AtomicUsize::new(0);
    // Nothing else writes it.
    let slot = (SLOT.load(Ordering::Relaxed) + 1) % (SIDE * ROUNDS.len());
    SLOT.store(slot, Ordering::Relaxed);
    let bits = ROUNDS.get(slot / SIDE).map_or(0, |round| round.load(Ordering::Relaxed)) >> (slot % SIDE * SIDE);
    let lit = |column: &usize| bits >> column & 1 != 0;
    let columns = (0..SIDE).filter(lit).filter_map(|column| COLUMNS.get(column)).fold(0, |all, one| all | one);
    // Safety: these registers change the pins whose bits are written, all of them ours, and no others.
    let (low, high) = unsafe { (&*P0::ptr(), &*P1::ptr()) };
    low.outclr.write(|w| unsafe { w.bits(ALL[0]) });
    low.outset.write(|w| unsafe { w.bits(ALL[1]) });
    high.outset.write(|w| unsafe { w.bits(FOURTH) });
    low.outclr.write(|w| unsafe { w.bits(columns) });
    if lit(&3) {
        high.outclr.write(|w| unsafe { w.bits(FOURTH) });
    }
    low.outset.write(|w| unsafe { w.bits(ROWS.get(slot % SIDE).copied().unwrap_or(0)) });
}
