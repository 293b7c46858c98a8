//! What symbols cost: the format's tables, in bits, ready for the search.

use super::extend::least_of_contexts;
use crate::encode::entropy::{cost, magnitude_cost};
use crate::encode::segment::{NumberCode, mode_symbol};
use pantin::codec::layout::{GROUPS, group};
use pantin::codec::segment::{CONTEXTS, SECOND};
use pantin::codec::tables;
use std::sync::OnceLock;

/// Numbers of at most this size have their cost at hand.
const AT_HAND: i32 = group(GROUPS + 1) as i32 - 1;

/// Costs in bits.
pub struct Costs {
    modes: Vec<[f32; 64]>,
    numbers: Vec<[f32; 2 * AT_HAND as usize + 1]>,
    /// The least cost of a number in all contexts of each length: of accelerations, then of slopes.
    least_number: [[f32; 16]; 2],
}

impl Costs {
    /// The costs under the format's tables.
    pub fn get() -> &'static Costs {
        static COSTS: OnceLock<Costs> = OnceLock::new();
        COSTS.get_or_init(Costs::of_tables)
    }

    fn of_tables() -> Costs {
        let mode = |after: u8, mode: u8| {
            let (symbol, second) = mode_symbol(mode);
            let second = second.map_or(0.0, |second| cost(tables::mode(SECOND), second));
            (cost(tables::mode(after), symbol) + second) as f32
        };
        let number = |context: u8, index: usize| number_cost(context, index as i32 - AT_HAND) as f32;
        let numbers: Vec<[f32; _]> =
            (0..CONTEXTS as u8).map(|context| std::array::from_fn(|index| number(context, index))).collect();
        let least: Vec<f32> = numbers.iter().map(|costs| costs.iter().copied().fold(f32::MAX, f32::min)).collect();
        Costs {
            least_number: [false, true].map(|slope| std::array::from_fn(|index| least_of_contexts(slope, index, &least))),
            numbers,
            modes: (0..64).map(|after| std::array::from_fn(|m| mode(after, m as u8))).collect(),
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
        if number.abs() <= AT_HAND {
            return f64::from(self.numbers[usize::from(context)][(number + AT_HAND) as usize]);
        }
        number_cost(context, number)
    }

    /// What no number of a segment of length `index` costs less than: those beyond the ones at hand cost more.
    #[inline]
    pub fn least_number(&self, slope: bool, index: usize) -> f64 {
        f64::from(self.least_number[usize::from(slope)][index])
    }

    /// A constant channel's position, in multiples of its grid.
    pub fn position(&self, p: i32) -> f64 {
        magnitude_cost(&tables::POSITION, p)
    }

    /// How a moving channel begins, in multiples of its grids.
    pub fn start(&self, p: i32, v: i32) -> f64 {
        self.position(p) + magnitude_cost(&tables::VELOCITY, v)
    }
}

fn number_cost(context: u8, number: i32) -> f64 {
    let code = NumberCode::of(number);
    let (_, count) = code.bits;
    let far = if code.far() { cost(&tables::FAR, count) } else { 0.0 };
    cost(tables::number(context), code.symbol) + far + f64::from(count)
}
