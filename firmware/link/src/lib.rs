//! Motion over a line that loses bytes, or anything else in packets: no heap, no float, no panic.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

mod channel;
mod cobs;
mod head;
mod link;
mod message;
pub mod packet;
mod parity;
mod symbols;
pub mod tables;

pub use channel::Channel;
pub use head::{ChannelKind, EXPONENTIAL_BYTES, Head, MAX_PACE, fits, pace, read_starts};
pub use link::{ClipMismatch, Counts, Link, MAX_PACKET, MAX_PAYLOAD, QUEUE_PACKETS};
pub use message::{Message, Messages, Refresh, units};

/// What an encoder of payloads needs. It runs on a host: the crate `pantin-tools` has one.
pub mod wire {
    pub use crate::head::{COUNT_BITS, FIRST_BITS, HEAD_CHECK};
    pub use crate::message::{AHEAD_BITS, END, FRAME, FRAME_BITS, PASS};
    pub use crate::symbols::{Coder, Table};
}
