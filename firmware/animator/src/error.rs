//! What can go wrong when an animator is set up or is given another clip.

use pantin::{OpenError, TooSmall, WrongForm};

/// Why a call was refused. The animator is as it was before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// The player's memory does not hold the clip.
    Player(TooSmall),
    /// A clip of another rig or, for a layer, of another form.
    Form(WrongForm),
    /// A clip of the bank cannot be opened.
    Clip(OpenError),
    /// Other lent memory is too small.
    TooSmall {
        /// Which memory.
        what: &'static str,
        /// The elements that are needed.
        needed: usize,
        /// Those that were given.
        given: usize,
    },
    /// No joint and no scalar has a name that the pattern matches.
    NothingMatches,
    /// The rig has no joint of this name, or joints that do not hang on each other as they should.
    NoSuchJoint,
    /// The clip lacks footstep events, without which phases cannot be compared.
    NoFootsteps,
    /// The state machine's table is damaged or names what is not there.
    Machine(crate::machine::TableError),
}

impl From<TooSmall> for Error {
    fn from(error: TooSmall) -> Error {
        Error::Player(error)
    }
}

impl From<WrongForm> for Error {
    fn from(error: WrongForm) -> Error {
        Error::Form(error)
    }
}

impl From<OpenError> for Error {
    fn from(error: OpenError) -> Error {
        Error::Clip(error)
    }
}

impl core::fmt::Display for Error {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Error::Player(error) => error.fmt(f),
            Error::Form(error) => error.fmt(f),
            Error::Clip(error) => error.fmt(f),
            Error::TooSmall { what, needed, given } => write!(f, "{needed} {what} are needed; {given} were given"),
            Error::NothingMatches => f.write_str("no joint and no scalar matches the pattern"),
            Error::NoSuchJoint => f.write_str("the rig has no such joint, or not in this chain"),
            Error::NoFootsteps => f.write_str("the clip has no events left_foot_down and right_foot_down"),
            Error::Machine(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for Error {}
