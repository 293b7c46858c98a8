//! A state machine's table in a bank: what its bytes say. [`MACHINE.md`](https://docs.rs/pantin-animator) describes them.

mod check;
mod error;
mod feet;
mod rows;

use crate::Error;
use crate::transition::Transition;
pub use error::TableError;
pub use feet::{Contact, Entry, FEET, FEET_SECTION, FEET_VERSION, FeetTable, FootRow, POINTS};
use fixed::types::I16F16;
use pantin::Bank;
pub use rows::{Cause, LayerRow, StateRow, TransitionRow};

/// The type of a bank's section that holds a table.
pub const SECTION: u8 = 4;

/// The version of tables that this library reads.
pub const VERSION: u8 = 1;

/// Most states of a table.
pub const STATES: usize = 64;
/// Most parameters of a table.
pub const PARAMETERS: usize = 8;
/// Most inputs of a table.
pub const INPUTS: usize = 32;
/// Most layers of a table.
pub const LAYERS: usize = 4;

const HEADER: usize = 8;
const STATE: usize = 8;
const TRANSITION: usize = 8;
const PARAMETER: usize = 6;
const LAYER: usize = 12;
/// The unit of a row's times: 1/64 s.
const UNIT_US: u32 = 15_625;
/// In place of a second clip.
const NONE: u8 = 255;
/// In place of a first frame: in step with the old clip.
const IN_STEP: u8 = 255;

/// A checked table.
#[derive(Clone, Copy, Debug)]
pub struct Table<'a> {
    /// Without the CRC.
    bytes: &'a [u8],
}

impl<'a> Table<'a> {
    /// Finds and checks the table of a bank, whose bytes these are.
    pub fn of_bank(bytes: &'a [u8]) -> Result<Table<'a>, Error> {
        Table::of_checked(&Bank::new_checked(bytes)?).map_err(Error::Machine)
    }

    /// [`Table::of_bank`] for a bank that is open.
    pub(crate) fn of_checked(bank: &Bank<'a>) -> Result<Table<'a>, TableError> {
        let section = bank.section(SECTION).map_err(|_| TableError::Several)?;
        Table::new(section.ok_or(TableError::Missing)?, bank.len())
    }

    /// A byte of the header, a number.
    fn number(&self, at: usize) -> usize {
        self.bytes.get(at).copied().map_or(0, usize::from)
    }

    /// Number of states.
    pub fn states(&self) -> usize {
        self.number(1)
    }

    /// Number of transitions of all states, and of those from any state, which come first.
    fn transitions(&self) -> usize {
        self.number(2)
    }

    /// Number of parameters.
    pub fn parameters(&self) -> usize {
        self.number(3)
    }

    /// Number of inputs.
    pub fn inputs(&self) -> usize {
        self.number(4)
    }

    /// The state in which the machine starts.
    pub(crate) fn first(&self) -> u8 {
        self.number(5) as u8
    }

    /// Number of transitions that lead from any state.
    pub(crate) fn any_transitions(&self) -> usize {
        self.number(6)
    }

    /// Number of layers.
    pub fn layers(&self) -> usize {
        self.number(7)
    }

    fn transitions_at(&self) -> usize {
        HEADER + STATE * self.states()
    }

    fn parameters_at(&self) -> usize {
        self.transitions_at() + TRANSITION * self.transitions()
    }

    fn layers_at(&self) -> usize {
        self.parameters_at() + PARAMETER * self.parameters()
    }

    fn names_at(&self) -> usize {
        self.layers_at() + LAYER * self.layers()
    }

    /// A layer; `None` if there is none of this index.
    pub fn layer(&self, index: usize) -> Option<LayerRow<'a>> {
        let at = self.layers_at() + LAYER * index;
        if index >= self.layers() {
            return None;
        }
        let &[clip, input, fade, reserved, ref states @ ..] = self.bytes.get(at..at + LAYER)? else { return None };
        let states = u64::from_le_bytes(states.try_into().ok()?);
        let before = self.states() + self.parameters() + self.inputs();
        let joints = core::str::from_utf8(self.names().nth(before + index)?).ok()?;
        (reserved == 0).then_some(LayerRow { clip, input, fade_us: u32::from(fade) * UNIT_US, states, joints })
    }

    /// A state; `None` if there is none of this index.
    pub fn state(&self, index: u8) -> Option<StateRow> {
        let at = HEADER + STATE * usize::from(index);
        let &[clip, other, parameter, follow, low, high, first, count] = self.bytes.get(at..at + STATE)? else { return None };
        let speed = i16::from_le_bytes([low, high]);
        if usize::from(index) >= self.states() || (other == NONE && follow != 0) || !(-1024..=1024).contains(&speed) {
            return None;
        }
        let blend = (other != NONE).then_some((other, parameter));
        let (speed, follow_us) = (I16F16::from_bits(i32::from(speed) << 8), u32::from(follow) * UNIT_US);
        Some(StateRow { clip, blend, follow_us, speed, transitions: (first, count) })
    }

    /// A transition; `None` if there is none of this index.
    pub fn transition(&self, index: usize) -> Option<TransitionRow> {
        let at = self.transitions_at() + TRANSITION * index;
        let &[cause, argument, low, high, to, kind, frames, first] = self.bytes.get(at..at + TRANSITION)? else { return None };
        if index >= self.transitions() {
            return None;
        }
        let threshold = i16::from_le_bytes([low, high]);
        let cause = match cause {
            0 => Cause::End,
            1 => Cause::Input(argument),
            2 => Cause::Released(argument),
            3 => Cause::Event(argument),
            4 => Cause::Above(argument, threshold),
            5 => Cause::Below(argument, threshold),
            _ => return None,
        };
        let transition = match kind {
            0 => Transition::Cut,
            1 => Transition::Inertialized(frames),
            2 => Transition::Faded(frames),
            _ => return None,
        };
        Some(TransitionRow { cause, to, transition, first_frame: (first != IN_STEP).then_some(first) })
    }

    /// The least, the greatest and the first value of a parameter.
    pub(crate) fn parameter_row(&self, index: usize) -> [i16; 3] {
        let at = self.parameters_at() + PARAMETER * index;
        match self.bytes.get(at..at + PARAMETER) {
            Some(&[a, b, c, d, e, f]) => [[a, b], [c, d], [e, f]].map(i16::from_le_bytes),
            _ => [0; 3],
        }
    }

    /// The names of states, parameters and inputs, and the patterns of layers, in this order.
    fn names(&self) -> impl Iterator<Item = &'a [u8]> + use<'a> {
        let mut rest = self.bytes.get(self.names_at()..).unwrap_or_default();
        core::iter::from_fn(move || {
            let (len, after) = rest.split_first()?;
            let (name, after) = after.split_at_checked(usize::from(*len))?;
            rest = after;
            Some(name)
        })
    }

    /// The name at an index among `count` that stand behind `before` others; empty for none, or one that is not UTF-8.
    fn name(&self, before: usize, count: usize, index: u8) -> &'a str {
        let name = self.names().skip(before).take(count).nth(index.into()).unwrap_or_default();
        core::str::from_utf8(name).unwrap_or("")
    }

    /// The name of a state; empty if it has none, or one that is not UTF-8.
    pub fn state_name(&self, state: u8) -> &'a str {
        self.name(0, self.states(), state)
    }

    /// The name of a parameter; empty if it has none, or one that is not UTF-8.
    pub fn parameter_name(&self, parameter: u8) -> &'a str {
        self.name(self.states(), self.parameters(), parameter)
    }

    /// The least, the greatest and the first value of a parameter; zeros for one that the table lacks.
    pub fn range(&self, parameter: u8) -> [i16; 3] {
        if usize::from(parameter) < self.parameters() { self.parameter_row(parameter.into()) } else { [0; 3] }
    }

    /// The name of an input; empty if it has none, or one that is not UTF-8.
    pub fn input_name(&self, input: u8) -> &'a str {
        self.name(self.states() + self.parameters(), self.inputs(), input)
    }

    /// The index of a parameter by its name.
    pub fn parameter(&self, name: &str) -> Option<u8> {
        let mut names = self.names().skip(self.states()).take(self.parameters());
        names.position(|other| other == name.as_bytes()).map(|index| index as u8)
    }

    /// The index of an input by its name.
    pub fn input(&self, name: &str) -> Option<u8> {
        let mut names = self.names().skip(self.states() + self.parameters()).take(self.inputs());
        names.position(|other| other == name.as_bytes()).map(|index| index as u8)
    }
}
