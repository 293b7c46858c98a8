//! What can go wrong when an animator is set up or is given another clip.

use pantin::{OpenError, TooSmall, WrongForm};

/// A joint's name or a pattern, for an error: its first 31 bytes, whole characters of UTF-8.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Name {
    len: u8,
    bytes: [u8; 31],
}

impl Name {
    /// The name's beginning.
    pub(crate) fn new(name: &str) -> Name {
        let len = (0..=name.len().min(31)).rev().find(|&len| name.is_char_boundary(len)).unwrap_or(0);
        let mut bytes = [0; 31];
        bytes.iter_mut().zip(name.as_bytes().iter().take(len)).for_each(|(own, byte)| *own = *byte);
        Name { len: len as u8, bytes }
    }

    /// The name's beginning.
    pub fn as_str(&self) -> &str {
        self.bytes.get(..self.len.into()).and_then(|bytes| core::str::from_utf8(bytes).ok()).unwrap_or("")
    }
}

impl core::fmt::Debug for Name {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        self.as_str().fmt(f)
    }
}

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
    /// No joint and no scalar has a name that this pattern matches.
    NothingMatches(Name),
    /// The rig has no joint of this name.
    NoSuchJoint(Name),
    /// The joint of this name has too few joints above it, or bones without length.
    ChainTooShort(Name),
    /// The direction in which a joint looks has no length.
    NoDirection,
    /// The rig has no joints, or not the one that is to carry the figure.
    NoCarrier,
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
            Error::NothingMatches(pattern) => write!(f, "no joint and no scalar matches `{}`", pattern.as_str()),
            Error::NoSuchJoint(name) => write!(f, "the rig has no joint `{}`", name.as_str()),
            Error::ChainTooShort(name) => {
                write!(f, "joint `{}` has too few joints above it, or bones without length", name.as_str())
            }
            Error::NoDirection => f.write_str("the direction of the look has no length"),
            Error::NoCarrier => f.write_str("the rig has no joint that can carry the figure"),
            Error::NoFootsteps => f.write_str("the clip has no events left_foot_down and right_foot_down"),
            Error::Machine(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for Error {}
