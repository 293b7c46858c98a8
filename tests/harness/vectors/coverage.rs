//! Which symbols of the format some motions use.

use std::collections::BTreeSet;

use anyhow::Result;
use pantin::codec::layout::{FAR_NUMBER, FOLLOW_BITS, LENGTHS, START_MODE, STATUS_CONTEXTS, STATUSES, STEP_CHANGES, status};
use pantin::codec::segment::{DIRECT_MODES, SECOND};
use pantin_convert::encode::clip::symbols;
use pantin_convert::encode::entropy::{Alphabet, Sink};
use pantin_convert::encode::rig;
use pantin_convert::encode::segment::mode_symbol;

use super::synthetic::Made;

/// Symbols by alphabet, modes, and the ways back to those that others follow.
#[derive(Default)]
struct Seen {
    symbols: BTreeSet<(Alphabet, u32)>,
    modes: BTreeSet<u8>,
    backs: BTreeSet<u32>,
    /// The last symbol, which tells what the bits behind it are.
    last: Option<(Alphabet, u32)>,
}

impl Sink for Seen {
    fn symbol(&mut self, alphabet: Alphabet, symbol: u32) {
        self.symbols.insert((alphabet, symbol));
        self.last = Some((alphabet, symbol));
        match alphabet {
            Alphabet::Mode(SECOND) => {
                self.modes.extend((0..START_MODE).filter(|&mode| mode_symbol(mode) == (DIRECT_MODES, Some(symbol))));
            }
            Alphabet::Mode(_) => self.modes.extend((0..START_MODE).filter(|&mode| mode_symbol(mode) == (symbol, None))),
            _ => {}
        }
    }

    fn bits(&mut self, value: u32, _: u32) {
        match self.last.take() {
            Some((Alphabet::Status(_), symbol)) if symbol == u32::from(status::FOLLOWS) => {
                self.backs.insert(value);
            }
            _ => {}
        }
    }
}

/// What of the format the motions leave out; nothing if they are complete.
pub fn left_out(motions: &[Made]) -> Result<Vec<String>> {
    let mut seen = Seen::default();
    for made in motions {
        let bytes = rig::encode(&made.rig)?;
        symbols(&made.coded, &pantin::Rig::new_checked(&bytes)?, &mut seen);
    }
    let mut missing = vec![];
    let mut wants = |there: bool, what: String| {
        if !there {
            missing.push(what);
        }
    };
    for mode in 0..START_MODE {
        wants(seen.modes.contains(&mode), format!("type {} of {} frames", mode >> 4, LENGTHS[usize::from(mode & 15)]));
    }
    let has =
        |of: &dyn Fn(Alphabet) -> bool, symbol| seen.symbols.iter().any(|&(alphabet, other)| of(alphabet) && other == symbol);
    for symbol in 0..=2 * FAR_NUMBER {
        wants(has(&|of| matches!(of, Alphabet::Number(context) if context < 48), symbol), format!("symbol {symbol} of w"));
        wants(has(&|of| matches!(of, Alphabet::Number(context) if context >= 48), symbol), format!("symbol {symbol} of k"));
    }
    for bits in 0..30 {
        wants(seen.symbols.contains(&(Alphabet::Far, bits)), format!("a far number of {bits} bits"));
    }
    for context in 0..STATUS_CONTEXTS as u8 {
        for status in 0..STATUSES as u32 {
            let like = |of: Alphabet| matches!(of, Alphabet::Status(_)) && of.table() == Alphabet::Status(context).table();
            wants(has(&like, status), format!("status {status} in a context like {context}"));
        }
    }
    for back in 0..1 << FOLLOW_BITS {
        wants(seen.backs.contains(&back), format!("one that follows {back} channels back"));
    }
    for (alphabet, last) in [(Alphabet::StepChange, STEP_CHANGES), (Alphabet::Position, 32), (Alphabet::Velocity, 31)] {
        for symbol in 0..=last {
            wants(seen.symbols.contains(&(alphabet, symbol)), format!("symbol {symbol} of {alphabet:?}"));
        }
    }
    Ok(missing)
}
