//! The 5x5 LEDs. They are wired in rows and columns, so that one row is lit at a time, for 1 ms. An LED's brightness is the number of rounds
//! out of three in which it is lit.
#![allow(unsafe_code)]

use board_drivers::led_matrix::{Leds, SIDE};
use core::sync::atomic::{AtomicU32, AtomicUsize, Ordering};
use nrf52833_hal::Timer;
use nrf52833_hal::gpio::{Disconnected, Level, Pin};
use nrf52833_hal::pac::{NVIC, P0, P1, TIMER1, interrupt};

/// The time for which a row is lit.
const ROW_US: u32 = 1000;
/// The bits of the rows and columns in port 0; one column is in port 1. An LED is lit while its row is high and its column low.
const ROWS: [u32; SIDE] = [1 << 21, 1 << 22, 1 << 15, 1 << 24, 1 << 19];
const COLUMNS: [u32; SIDE] = [1 << 28, 1 << 11, 1 << 31, 0, 1 << 30];
const FOURTH: u32 = 1 << 5;
const ALL: [u32; 2] = [ROWS[0] | ROWS[1] | ROWS[2] | ROWS[3] | ROWS[4], COLUMNS[0] | COLUMNS[1] | COLUMNS[2] | COLUMNS[4]];

/// The LEDs that are lit in each round, row by row, the first LED of a row in its lowest bit.
static ROUNDS: [AtomicU32; 3] = [AtomicU32::new(0), AtomicU32::new(0), AtomicU32::new(0)];

/// Sets up the pins of rows and columns, and the timer whose interrupt lights row after row.
pub fn start(rows: [Pin<Disconnected>; SIDE], columns: [Pin<Disconnected>; SIDE], timer: TIMER1) {
    let _ = rows.map(|row| row.into_push_pull_output(Level::Low));
    let _ = columns.map(|column| column.into_push_pull_output(Level::High));
    let mut timer = Timer::periodic(timer);
    timer.enable_interrupt();
    timer.start(ROW_US);
    // Safety: no critical section relies on this interrupt's mask.
    unsafe { NVIC::unmask(interrupt::TIMER1) };
}

#[interrupt]
fn TIMER1() {
    // Safety: nothing else writes this register after the set-up.
    unsafe { &*TIMER1::ptr() }.events_compare[0].reset();
    next();
}

/// Sets the brightness of the LEDs, from the next row on.
pub fn set(leds: &Leds) {
    for (least, round) in (1..).zip(&ROUNDS) {
        let bits = leds.as_flattened().iter().rev().fold(0, |bits, led| bits << 1 | u32::from(*led >= least));
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
    // Safety: writes to these registers change only the pins whose bits are set, and these are the LEDs'.
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
