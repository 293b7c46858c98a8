//! The rows of a table.

use crate::transition::Transition;
use fixed::types::I16F16;

/// What makes a transition happen. Tables of a later version may have more causes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Cause {
    /// The clip, which is no loop, has ended.
    End,
    /// An input was fired, or is held.
    Input(u8),
    /// An input is not held.
    Released(u8),
    /// The clip's event of this id was passed.
    Event(u8),
    /// A parameter is above the threshold.
    Above(u8, i16),
    /// A parameter is below the threshold.
    Below(u8, i16),
}

/// A row of the table's transitions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TransitionRow {
    /// What makes it happen.
    pub cause: Cause,
    /// The state that it leads to.
    pub to: u8,
    /// How.
    pub transition: Transition,
    /// The new clip's first frame; `None` for the one that is in step with the old clip.
    pub first_frame: Option<u8>,
}

/// A row of the table's layers: a clip that an input plays over some joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LayerRow<'a> {
    /// The clip's index in the bank.
    pub clip: u8,
    /// The input.
    pub input: u8,
    /// How long it takes to come and to go.
    pub fade_us: u32,
    /// A bit for each state in which it may play.
    pub states: u64,
    /// Patterns of [`crate::Mask::set`], one a line.
    pub joints: &'a str,
}

/// A row of the table's states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateRow {
    /// The clip's index in the bank.
    pub clip: u8,
    /// Another clip into which a parameter blends: its index in the bank, and the parameter's.
    pub blend: Option<(u8, u8)>,
    /// The time in which the blend goes from one clip to the other at the fastest, however fast the parameter changes.
    pub follow_us: u32,
    /// The speed.
    pub speed: I16F16,
    /// The first of its transitions, and how many there are.
    pub(crate) transitions: (u8, u8),
}
