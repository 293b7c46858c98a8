//! Why a table cannot be used.

/// Why a table cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TableError {
    /// The bank has no section of a state machine, or ends before it should.
    Missing,
    /// The bank has more than one section of a state machine.
    Several,
    /// The table ends before it should, or goes on after it.
    Truncated,
    /// The table's check sum is wrong.
    BadCrc,
    /// The table's version is not [`VERSION`](super::VERSION).
    UnsupportedVersion(u8),
    /// There are no states, or more states, parameters, inputs or layers than there may be.
    BadCount,
    /// A state, or a layer (counted after the states), names a clip that the bank lacks.
    NoSuchClip {
        /// The state.
        state: u8,
    },
    /// A state is first, or a transition leads to it, that the table lacks.
    NoSuchState(u8),
    /// A state or a transition names a parameter or an input that the table lacks.
    NoSuchInput(u8),
    /// A state's transitions lie outside the table.
    NoSuchTransition {
        /// The state.
        state: u8,
    },
    /// A speed, a parameter's range or a transition's kind or cause is none.
    BadValue,
    /// A state has two transitions with the same cause, of which the second can never happen.
    Ambiguous {
        /// The state; 255 for the transitions from any state.
        state: u8,
    },
    /// No transition leads to a state.
    Unreachable(u8),
}

impl core::fmt::Display for TableError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            TableError::Missing => f.write_str("the bank has no state machine"),
            TableError::Several => f.write_str("the bank has more than one state machine"),
            TableError::Truncated => f.write_str("the state machine's table has another length than it says"),
            TableError::BadCrc => f.write_str("the state machine's table is damaged"),
            TableError::UnsupportedVersion(version) => write!(f, "state machine version {version} is not supported"),
            TableError::BadCount => {
                f.write_str("the state machine has no states, or too many states, parameters, inputs or layers")
            }
            TableError::NoSuchClip { state } => write!(f, "state {state} plays a clip that the bank lacks"),
            TableError::NoSuchState(state) => write!(f, "there is no state {state}"),
            TableError::NoSuchInput(input) => write!(f, "there is no parameter or input {input}"),
            TableError::NoSuchTransition { state } => write!(f, "the transitions of state {state} are not in the table"),
            TableError::BadValue => {
                f.write_str("a speed, range, kind or cause of the table has a value that the format does not define")
            }
            TableError::Ambiguous { state } => write!(f, "state {state} has two transitions with the same cause"),
            TableError::Unreachable(state) => write!(f, "no transition leads to state {state}"),
        }
    }
}

impl core::error::Error for TableError {}
