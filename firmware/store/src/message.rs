//! What is said over the line while a clip is replaced.
//!
//! Messages are [packets](pantin_link::packet) of these kinds, and go one by one: who sends the clip requests, the board answers, and what
//! is not answered in time is asked again. Every message names the clip by its CRC-32, so none is taken for that of another clip, and
//! each can be said twice without harm. Numbers are of 4 bytes, the least first.
//!
//! | kind | message | payload | answers |
//! |---|---|---|---|
//! | 0x10 | [`Request::Begin`] | CRC-32, length, name (up to 28 bytes) | want, done, refused |
//! | 0x11 | [`Request::Data`] | CRC-32, offset, bytes | want, refused |
//! | 0x12 | [`Request::End`] | CRC-32 | want, done, refused |
//! | 0x18 | [`Response::Next`] | CRC-32, offset | |
//! | 0x19 | [`Response::Done`] | CRC-32 | |
//! | 0x1a | [`Response::Refused`] | CRC-32, reason (a byte), number | |
//!
//! Data are [`BLOCK_BYTES`] bytes from a multiple of that, only the last ones fewer. `want` says from where the board wants
//! them next: the clip's length when it has them all. Beginning again what is under way answers `want` with how far it came; so a
//! transfer goes on after the line was lost. `done` means that the clip stands in flash, sealed, and plays.
//!
//! The board gives a transfer up when [`IDLE_FRAMES`] pictures went by without a message, or another begins. It tells letters
//! (keys) from packets by the zero that a packet begins with: bytes up to the next zero are the packet's. After a packet that was
//! damaged, or a byte that no terminal's letter has, it takes nothing for a letter until the next zero or [`SILENCE_FRAMES`] pictures without a byte.

use crate::BLOCK_BYTES;
use crate::header::{ClipInfo, NAME_BYTES, Name, number};
use pantin::OpenError;
use pantin_link::packet::{self, Packet};

/// Pictures without a message after which a transfer is given up.
pub const IDLE_FRAMES: u16 = 1024;
/// Pictures without a byte after which a packet that was begun is.
pub const SILENCE_FRAMES: u16 = 16;

/// Transfers that may bring data before one is sealed or the board restarts: a sender that begins again and again must not wear out the flash.
pub const MAX_STARTS: u8 = 32;

/// Most bytes of a message to the board, as a receiver counts them.
pub const MAX_REQUEST: usize = 8 + BLOCK_BYTES + packet::OVERHEAD;
/// Most bytes of an answer, as a receiver counts them.
pub const MAX_RESPONSE: usize = 9 + packet::OVERHEAD;

/// Numbers of the kinds of messages: all of [`packet::kind::UPDATES`].
mod kind {
    pub const BEGIN: u8 = 0x10;
    pub const DATA: u8 = 0x11;
    pub const END: u8 = 0x12;
    pub const NEXT: u8 = 0x18;
    pub const DONE: u8 = 0x19;
    pub const REFUSED: u8 = 0x1a;
}

/// What is said to the board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request<'a> {
    /// A clip is to come.
    Begin(ClipInfo),
    /// Bytes of it.
    Data {
        /// The clip's CRC-32.
        id: u32,
        /// Where they belong in the clip.
        offset: u32,
        /// At most [`BLOCK_BYTES`].
        bytes: &'a [u8],
    },
    /// That was all: check it and play it.
    End {
        /// The clip's CRC-32.
        id: u32,
    },
}

/// What the board says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Response {
    /// Bytes from this offset on are wanted next.
    Next {
        /// The clip's CRC-32.
        id: u32,
        /// Its length when all are there.
        offset: u32,
    },
    /// The clip plays.
    Done {
        /// Its CRC-32.
        id: u32,
    },
    /// The clip will not play.
    Refused {
        /// Its CRC-32.
        id: u32,
        /// Why.
        refusal: Refusal,
    },
}

/// Why a clip is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// The clip is longer than the slot's capacity.
    TooLong {
        /// Of the slot.
        capacity: u32,
    },
    /// No such transfer is under way (any more): begin it.
    NotBegun,
    /// The bytes in the flash are not those that were claimed.
    BadCrc,
    /// They are, but no clip that can be opened.
    Clip(OpenError),
    /// The board has not the memory to play it.
    TooBig,
    /// The flash cannot be erased or written.
    Flash,
    /// [`MAX_STARTS`] transfers have brought data since the board last started or took a clip. Each erases a sector.
    TooManyStarts,
}

/// Writes a message of up to `N` bytes as a packet; none if `out` has not the capacity.
fn packet<const N: usize>(kind: u8, sequence: u8, parts: &[&[u8]], out: &mut [u8]) -> Option<usize> {
    let mut payload = [0; N];
    let mut len = 0;
    for &byte in parts.iter().copied().flatten() {
        *payload.get_mut(len)? = byte;
        len += 1;
    }
    packet::encode(kind, sequence, payload.get(..len)?, out)
}

impl<'a> Request<'a> {
    /// Reads a packet; none if it is something else.
    pub fn read(packet: &Packet<'a>) -> Option<Request<'a>> {
        let (id, rest) = number(packet.payload)?;
        match packet.kind {
            kind::BEGIN => {
                let (length, name) = number(rest)?;
                (name.len() <= NAME_BYTES).then(|| Request::Begin(ClipInfo { length, crc: id, name: Name::of_bytes(name) }))
            }
            kind::DATA => {
                let (offset, bytes) = number(rest)?;
                (!bytes.is_empty() && bytes.len() <= BLOCK_BYTES).then_some(Request::Data { id, offset, bytes })
            }
            kind::END => rest.is_empty().then_some(Request::End { id }),
            _ => None,
        }
    }

    /// Writes it as it goes over the line: how many bytes. None if `out` has not the capacity: [`packet::line_len`] of 264 is enough.
    pub fn write(&self, sequence: u8, out: &mut [u8]) -> Option<usize> {
        let (kind, id, number, bytes) = match *self {
            Request::Begin(ClipInfo { length, crc, ref name }) => {
                (kind::BEGIN, crc, &length.to_le_bytes()[..], name.as_str().as_bytes())
            }
            Request::Data { id, offset, bytes } => (kind::DATA, id, &offset.to_le_bytes()[..], bytes),
            Request::End { id } => (kind::END, id, &[][..], &[][..]),
        };
        packet::<{ 8 + BLOCK_BYTES }>(kind, sequence, &[&id.to_le_bytes(), number, bytes], out)
    }
}

impl Response {
    /// Reads a packet; none if it is something else.
    pub fn read(packet: &Packet) -> Option<Response> {
        let (id, rest) = number(packet.payload)?;
        match (packet.kind, rest) {
            (kind::NEXT, rest) => match number(rest)? {
                (offset, []) => Some(Response::Next { id, offset }),
                _ => None,
            },
            (kind::DONE, []) => Some(Response::Done { id }),
            (kind::REFUSED, &[reason, ref rest @ ..]) => match number(rest)? {
                (detail, []) => Some(Response::Refused { id, refusal: Refusal::of(reason, detail)? }),
                _ => None,
            },
            _ => None,
        }
    }

    /// Writes it as it goes over the line: how many bytes. None if `out` has not the capacity: [`packet::line_len`] of 9 is enough.
    pub fn write(&self, sequence: u8, out: &mut [u8]) -> Option<usize> {
        match *self {
            Response::Next { id, offset } => packet::<9>(kind::NEXT, sequence, &[&id.to_le_bytes(), &offset.to_le_bytes()], out),
            Response::Done { id } => packet::<9>(kind::DONE, sequence, &[&id.to_le_bytes()], out),
            Response::Refused { id, refusal } => {
                let (reason, detail) = refusal.code();
                packet::<9>(kind::REFUSED, sequence, &[&id.to_le_bytes(), &[reason], &detail.to_le_bytes()], out)
            }
        }
    }
}

impl Refusal {
    /// Reason and number, as they go over the line.
    fn code(self) -> (u8, u32) {
        match self {
            Refusal::TooLong { capacity } => (1, capacity),
            Refusal::NotBegun => (2, 0),
            Refusal::BadCrc => (3, 0),
            Refusal::TooBig => (4, 0),
            Refusal::Flash => (5, 0),
            Refusal::TooManyStarts => (6, 0),
            Refusal::Clip(OpenError::BadMagic) => (16, 0),
            Refusal::Clip(OpenError::UnsupportedVersion(version)) => (17, version.into()),
            Refusal::Clip(OpenError::Truncated) => (18, 0),
            Refusal::Clip(OpenError::BadCrc) => (19, 0),
            Refusal::Clip(OpenError::WrongRig) => (21, 0),
            // Also what later decoders may find wrong.
            Refusal::Clip(_) => (20, 0),
        }
    }

    fn of(reason: u8, detail: u32) -> Option<Refusal> {
        Some(match reason {
            1 => Refusal::TooLong { capacity: detail },
            2 => Refusal::NotBegun,
            3 => Refusal::BadCrc,
            4 => Refusal::TooBig,
            5 => Refusal::Flash,
            6 => Refusal::TooManyStarts,
            16 => Refusal::Clip(OpenError::BadMagic),
            17 => Refusal::Clip(OpenError::UnsupportedVersion(detail as u8)),
            18 => Refusal::Clip(OpenError::Truncated),
            19 => Refusal::Clip(OpenError::BadCrc),
            20 => Refusal::Clip(OpenError::Malformed),
            21 => Refusal::Clip(OpenError::WrongRig),
            _ => return None,
        })
    }
}

impl core::fmt::Display for Refusal {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Refusal::TooLong { capacity } => write!(f, "the board has capacity for a clip of {capacity} bytes"),
            Refusal::NotBegun => f.write_str("the board gave this transfer up"),
            Refusal::BadCrc => f.write_str("the clip did not arrive as it was sent"),
            Refusal::Clip(error) => write!(f, "the board's decoder cannot open it: {error}"),
            Refusal::TooBig => f.write_str("the board has not the memory to play it (its channels or joints are too many)"),
            Refusal::Flash => f.write_str("the board's flash cannot be written"),
            Refusal::TooManyStarts => {
                write!(f, "{MAX_STARTS} transfers were begun and not completed; restart the board to allow more")
            }
        }
    }
}
