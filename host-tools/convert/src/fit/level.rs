//! The encoder's efforts, from fast to small.

use super::descent::Plan;
use super::rotation_coding::Rotations;
use super::search::Effort;
use crate::pose_bound::PoseBound;
use std::fmt;
use std::str::FromStr;

/// Encoder effort, 1 to 9: speed against size. Each level finds smaller clips than the one below it, in at most 1.8 times the time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Level(u8);

/// How a level searches.
struct Row {
    passes: usize,
    /// Further rounds: beyond the default these find more than as much time spent on more passes or more hypotheses.
    rounds: usize,
    beam: usize,
    margin: f64,
    both_steps: bool,
    /// Hypotheses of a frame that are extended by slopes, once half of the passes are done.
    slopes: usize,
}

const fn row(passes: usize, beam: usize, margin: f64, both_steps: bool, slopes: usize) -> Row {
    Row { passes, rounds: 0, beam, margin, both_steps, slopes }
}

const fn rounds(rounds: usize) -> Row {
    Row { rounds, ..row(12, 14, 9.0, true, 4) }
}

const ROWS: [Row; 9] = [
    row(2, 3, 3.0, false, 0),
    row(3, 4, 5.0, false, 4),
    row(4, 7, 7.0, false, 4),
    row(5, 6, 5.5, true, 4),
    row(7, 10, 8.0, true, 4),
    rounds(0),
    rounds(2),
    rounds(5),
    rounds(12),
];

impl Level {
    /// Level 1, for previews: many times faster than real time.
    pub const FAST: Level = Level(1);
    /// Level 6.
    pub const DEFAULT: Level = Level(6);
    /// Level 9: captured clips are 1 to 2 % smaller than at the default, in some four times the time.
    pub const BEST: Level = Level(9);
    /// What [`Level::from_str`] reads, for messages.
    pub const EXPECTED: &str = "expected 1 to 9, fast (1), default (6) or best (9)";

    /// The level of a number from 1 to 9; `None` for others.
    pub fn new(number: u8) -> Option<Level> {
        (1..=ROWS.len() as u8).contains(&number).then_some(Level(number))
    }

    /// The number, 1 to 9.
    pub fn number(self) -> u8 {
        self.0
    }

    /// The plan of this level for a bound.
    pub fn plan(self, bound: PoseBound) -> Plan {
        let &Row { passes, rounds, beam, margin, both_steps, slopes } = &ROWS[usize::from(self.0) - 1];
        Plan {
            bound,
            passes,
            rounds,
            prices: (FIRST_PRICE_AT_1_CM * bound.max_cm.powf(FIRST_PRICE_FALLS).clamp(0.5, 4.0), LAST_PRICE),
            both_steps,
            thorough: false,
            effort: Effort { beam, margin, slopes, all_alike: false },
            rotations: Rotations::ByCost,
        }
    }
}

/// The price of the first pass. A tight bound takes many bits a frame, and an error must cost as much: measured on ten clips at 0.1 to 3 cm.
const FIRST_PRICE_AT_1_CM: f64 = 11.0;
const FIRST_PRICE_FALLS: f64 = -0.45;
const LAST_PRICE: f64 = 0.2;

impl FromStr for Level {
    type Err = String;

    fn from_str(text: &str) -> Result<Level, String> {
        match text {
            "fast" => Ok(Level::FAST),
            "default" => Ok(Level::DEFAULT),
            "best" => Ok(Level::BEST),
            number => number.parse().ok().and_then(Level::new).ok_or_else(|| Level::EXPECTED.to_owned()),
        }
    }
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::super::descent::ROUND_PART;
    use super::*;

    #[test]
    fn levels_are_read_by_number_and_by_name() {
        let read = ["1", "fast", "6", "default", "9", "best"].map(|text| text.parse::<Level>().unwrap().number());
        assert_eq!(read, [1, 1, 6, 6, 9, 9]);
        assert!(["0", "10", "", "-1", "1.5", "Best"].iter().all(|text| text.parse::<Level>().is_err()));
    }

    #[test]
    fn every_level_looks_at_more_than_the_one_below() {
        let passes = |row: &Row| row.passes as f64 * (1.0 + ROUND_PART * row.rounds as f64);
        let searched = |row: &Row| passes(row) * row.beam as f64 * if row.both_steps { 2.0 } else { 1.0 };
        assert!(ROWS.windows(2).all(|pair| searched(&pair[0]) < searched(&pair[1])));
    }
}
