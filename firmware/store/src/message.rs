//! Messages that replace a board's clip over the line.
//!
//! Messages are [packets](pantin_link::packet) of the kinds below. The host sends a request, the board answers it, and the host repeats a request that is not
//! answered in time. Every message contains the CRC-32 of its clip, so messages of another clip and repeated messages are harmless. Numbers have 4
//! bytes, little-endian.
//!
//! | kind | message | payload | answers |
//! |---|---|---|---|
//! | 0x10 | [`Request::Begin`] | CRC-32, length, name (up to 28 bytes) | next, done, refused |
//! | 0x11 | [`Request::Data`] | CRC-32, offset, bytes | next, refused |
//! | 0x12 | [`Request::End`] | CRC-32 | next, done, refused |
//! | 0x18 | [`Response::Next`] | CRC-32, offset | |
//! | 0x19 | [`Response::Done`] | CRC-32 | |
//! | 0x1a | [`Response::Refused`] | CRC-32, reason (1 byte), number |
//!
//! Data are [`BLOCK_BYTES`] bytes from a multiple of that; only the last ones are fewer. `next` is the offset that the board expects next: the clip's
//! length when it has all. A repeated `begin` of the current transfer returns how far it has come, so a transfer resumes after the line was
//! interrupted. `done` means that the clip is sealed in flash and plays.
//!
//! The board abandons a transfer after [`IDLE_FRAMES`] frames without a message, or when another one begins. A zero starts a packet, and the bytes up to the next
//! zero belong to it; other bytes are keys. After a damaged packet, or a byte that is no key of a terminal, the board ignores keys until the
//! next zero or [`SILENCE_FRAMES`] frames without a byte.

use crate::BLOCK_BYTES;
use crate::header::{ClipInfo, NAME_BYTES, Name, number};
use pantin::OpenError;
use pantin_link::packet::{self, Packet};

/// Frames without a message after which the board abandons a transfer.
pub const IDLE_FRAMES: u16 = 1024;
/// Frames without a byte after which the board abandons an incomplete packet.
pub const SILENCE_FRAMES: u16 = 16;

/// Most transfers that may bring data before one is sealed or the board restarts: a sender that begins again and again must not wear out the flash.
pub const MAX_STARTS: u8 = 32;

/// Most bytes of a request, as [`packet::Receiver`] counts them.
pub const MAX_REQUEST: usize = 8 + BLOCK_BYTES + packet::OVERHEAD;
/// Most bytes of a response, as [`packet::Receiver`] counts them.
pub const MAX_RESPONSE: usize = 9 + packet::OVERHEAD;

/// Packet kinds of the messages, within [`packet::kind::UPDATES`].
mod kind {
    pub const BEGIN: u8 = 0x10;
    pub const DATA: u8 = 0x11;
    pub const END: u8 = 0x12;
    pub const NEXT: u8 = 0x18;
    pub const DONE: u8 = 0x19;
    pub const REFUSED: u8 = 0x1a;
}

/// A message to the board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request<'a> {
    /// Starts or resumes the transfer of a clip.
    Begin(ClipInfo),
    /// Sends bytes of the clip.
    Data {
        /// The clip's CRC-32.
        id: u32,
        /// The offset of `bytes` in the clip.
        offset: u32,
        /// 1 to [`BLOCK_BYTES`] bytes.
        bytes: &'a [u8],
    },
    /// Ends the transfer: the board checks the clip and plays it.
    End {
        /// The clip's CRC-32.
        id: u32,
    },
}

/// A message from the board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Response {
    /// The board expects the bytes from this offset on.
    Next {
        /// The clip's CRC-32.
        id: u32,
        /// The clip's length if the board has all of it.
        offset: u32,
    },
    /// The clip plays.
    Done {
        /// The clip's CRC-32.
        id: u32,
    },
    /// The clip is refused; the old one keeps playing.
    Refused {
        /// The clip's CRC-32.
        id: u32,
        /// The reason.
        refusal: Refusal,
    },
}

/// The reason why a clip is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Refusal {
    /// The slot is too small.
    TooLong {
        /// The longest clip that fits, in bytes.
        capacity: u32,
    },
    /// The board does not know this transfer, or has abandoned it: begin again.
    NotBegun,
    /// The bytes in the flash are not those of the clip.
    BadCrc,
    /// The decoder cannot open the clip.
    Clip(OpenError),
    /// The board has too little RAM for the clip's channels or joints.
    TooBig,
    /// The flash cannot be erased or written.
    Flash,
    /// [`MAX_STARTS`] transfers have brought data since the board last started or took a clip. Each erases a sector.
    TooManyStarts,
}

/// Encodes the concatenated `parts`, at most `N` bytes, as a packet. Returns `None` if `out` is too small.
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
    /// Reads a packet. Returns `None` if it is no request.
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

    /// Encodes the request as a packet and returns its length. Returns `None` if `out` is smaller than [`packet::line_len`] of 264.
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
    /// Reads a packet. Returns `None` if it is no response.
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

    /// Encodes the response as a packet and returns its length. Returns `None` if `out` is smaller than [`packet::line_len`] of 9.
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
    /// Returns the reason and the number that go over the line.
    fn code(self) -> (u8, u32) {
        match self {
            Refusal::TooLong { capacity } => (1, capacity),
            Refusal::NotBegun => (2, 0),
            Refusal::BadCrc => (3, 0),
            Refusal::TooBig => (4, 0),
            Refusal::Flash => (5, 0),
            Refusal::TooManyStarts => (6, 0),
            Refusal::Clip(OpenError::BadMagic | OpenError::IsBank) => (16, 0),
            Refusal::Clip(OpenError::UnsupportedVersion(version)) => (17, version.into()),
            Refusal::Clip(OpenError::Truncated) => (18, 0),
            Refusal::Clip(OpenError::BadCrc) => (19, 0),
            Refusal::Clip(OpenError::WrongRig) => (21, 0),
            // Also errors that later decoders may add.
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
            Refusal::Clip(OpenError::UnsupportedVersion(2)) => {
                f.write_str("it is a key clip, and the board's firmware is built without feature `keys`; send segments")
            }
            Refusal::Clip(error) => write!(f, "the board's decoder cannot open it: {error}"),
            Refusal::TooBig => f.write_str("the board has not the memory to play it (its channels or joints are too many)"),
            Refusal::Flash => f.write_str("the board's flash cannot be written"),
            Refusal::TooManyStarts => {
                write!(f, "{MAX_STARTS} transfers were begun and not completed; restart the board to allow more")
            }
        }
    }
}
