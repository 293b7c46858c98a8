//! What symbols cost: the format's tables, in bits, ready for the search.

use crate::encode::entropy::{cost, magnitude_cost};
use crate::encode::segment::{mode_symbol, number_symbol};
use pantin::layout::MAX_MAGNITUDE;
use pantin::segment::CONTEXTS;
use pantin::tables;
use std::sync::OnceLock;

/// Numbers whose symbol tells them whole: |n| below this.
const LIMIT: i32 = MAX_MAGNITUDE as i32;

/// Costs in bits.
pub struct Costs {
    modes: Vec<[f32; 64]>,
    numbers: Vec<[f32; 2 * MAX_MAGNITUDE as usize + 1]>,
    excess: Vec<f32>,
}

impl Costs {
    /// The costs under the format's tables.
    pub fn get() -> &'static Costs {
        static COSTS: OnceLock<Costs> = OnceLock::new();
        COSTS.get_or_init(Costs::of_tables)
    }

    fn of_tables() -> Costs {
        let mode = |after: u8, mode: u8| {
            let (symbol, length) = mode_symbol(mode);
            (cost(tables::mode(after), symbol) + if length.is_some() { 4.0 } else { 0.0 }) as f32
        };
        let number = |context: u8, index: usize| cost(tables::number(context), number_symbol(index as i32 - LIMIT).0) as f32;
        Costs {
            modes: (0..64).map(|after| std::array::from_fn(|m| mode(after, m as u8))).collect(),
            numbers: (0..CONTEXTS as u8).map(|context| std::array::from_fn(|index| number(context, index))).collect(),
            excess: (0..=32).map(|bits| (cost(&tables::EXCESS, bits) + f64::from(bits)) as f32).collect(),
        }
    }

    /// A segment's mode after another.
    #[inline]
    pub fn mode(&self, after: u8, mode: u8) -> f64 {
        f64::from(self.modes[usize::from(after)][usize::from(mode)])
    }

    /// A number, its sign already turned as its context says.
    #[inline]
    pub fn number(&self, context: u8, number: i32) -> f64 {
        let row = &self.numbers[usize::from(context)];
        if number.abs() < LIMIT {
            return f64::from(row[(number + LIMIT) as usize]);
        }
        let excess = number.unsigned_abs() - MAX_MAGNITUDE;
        f64::from(
            row[if number < 0 { 0 } else { 2 * LIMIT as usize }] + self.excess[(u32::BITS - excess.leading_zeros()) as usize],
        )
    }

    /// How a moving channel begins, in multiples of its grids.
    pub fn start(&self, p: i32, v: i32) -> f64 {
        magnitude_cost(&tables::POSITION, p) + magnitude_cost(&tables::VELOCITY, v)
    }
}
