//! Why bytes are not a clip, or memory does not fit one.

/// Why bytes could not be opened as a rig or a clip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum OpenError {
    /// The file does not begin with the magic of a clip: it is something else.
    BadMagic,
    /// A clip of a version that this decoder does not play.
    UnsupportedVersion(u8),
    /// The bytes end before the clip does.
    Truncated,
    /// A CRC does not match: the bytes were damaged.
    BadCrc,
    /// The CRC matches but a field is outside its bounds: the encoder is at fault.
    Malformed,
    /// The clip carries no rig and none was given, or not the one that it was made for.
    WrongRig,
    /// The bank holds no clip of this name.
    NoSuchClip,
    /// The file is a bank of clips: [`Bank::new_checked`](crate::Bank::new_checked) opens it.
    IsBank,
}

/// The memory lent to a player is too small for the clip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TooSmall {
    /// Which slice is too small.
    pub memory: Memory,
    /// The elements that the clip needs.
    pub needed: usize,
    /// The elements that were given.
    pub given: usize,
}

/// The memory that a caller lends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Memory {
    /// Channel states: [`Clip::moving`](crate::Clip::moving) of them.
    States,
    /// Values of a pose: [`Rig::channels`](crate::Rig::channels) of them.
    Values,
    /// The buffer of a stream, in bytes: [`Stream::BUFFER`](crate::Stream::BUFFER).
    Buffer,
    /// The bytes of a rig that arrives with its clip.
    Rig,
}

impl core::fmt::Display for OpenError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            OpenError::BadMagic => f.write_str("not a pantin clip"),
            OpenError::UnsupportedVersion(v) => write!(f, "clip version {v:#04x} is not supported"),
            OpenError::Truncated => f.write_str("the clip is truncated"),
            OpenError::BadCrc => f.write_str("a CRC does not match: the clip is damaged"),
            OpenError::Malformed => f.write_str("the clip is malformed"),
            OpenError::NoSuchClip => f.write_str("the bank has no clip of this name"),
            OpenError::IsBank => f.write_str("a bank of clips, not a clip: open it as a bank"),
            OpenError::WrongRig => f.write_str("the clip needs another rig"),
        }
    }
}

impl core::fmt::Display for TooSmall {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let memory = match self.memory {
            Memory::States => "channel states",
            Memory::Values => "values of a pose",
            Memory::Buffer => "bytes of buffer",
            Memory::Rig => "bytes for the rig",
        };
        write!(f, "the clip needs {} {memory}; {} were given", self.needed, self.given)
    }
}

impl core::error::Error for OpenError {}

impl core::error::Error for TooSmall {}
