//! Motion over a line that loses bytes, or anything else in packets: no heap, no float, no panic.
#![cfg_attr(not(any(test, feature = "std")), no_std)]
#![forbid(unsafe_code)]

mod channel;
mod cobs;
mod head;
mod link;
mod message;
pub mod packet;
mod parity;
#[cfg(any(test, feature = "std"))]
pub mod sender;
mod symbols;
mod tables;

pub use channel::Channel;
#[cfg(any(test, feature = "std"))]
pub use head::write_starts;
pub use head::{ChannelKind, EXPONENTIAL_BYTES, Head, MAX_PACE, fits, pace, read_starts};
pub use link::{ClipMismatch, Counts, Link, MAX_PACKET, MAX_PAYLOAD, QUEUE_PACKETS};
pub use message::{Message, Messages, Refresh, units};
