//! Receives live motion over a line that loses bytes: a serial line, or UDP. No heap, no float, no panic path.
//!
//! The bytes of a line go to a [`packet::Receiver`], its packets to a [`Link`], and [`Link::step`] yields a pose per frame. After a loss the
//! receiver recovers by itself. `LINK.md` specifies the protocol; the sender runs on a host and is part of the crate `pantin-line`.
//!
//! ```
//! use pantin_link::packet::Receiver;
//! use pantin_link::{Channel, Link, MAX_PACKET, QUEUE_PACKETS};
//!
//! // The form of a clip with the same rig tells what the values of a pose mean.
//! let form = pantin::Form::default();
//! let (mut channels, mut pose) = ([Channel::default(); 8], [0; 8]);
//! let mut link = Link::<QUEUE_PACKETS>::new(form, &mut channels, &mut pose);
//! let mut receiver = Receiver::<MAX_PACKET>::new();
//!
//! // Once per frame: take the bytes that have arrived, advance, draw.
//! for byte in [0, 3, 1, 7, 0] {
//!     if let Some(packet) = receiver.push(byte) {
//!         let _ = link.receive(&packet);
//!     }
//! }
//! link.step();
//! assert_eq!(link.pose().values.len(), 8);
//! assert!(!link.is_synced());
//! ```
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

mod channel;
mod cobs;
mod event;
mod head;
mod link;
mod message;
pub mod packet;
mod parity;
mod symbols;
pub mod tables;
#[cfg(feature = "key")]
mod tag;

pub use channel::Channel;
pub use event::{EVENT_NAME_BYTES, EventQueue, LineEvent, MAX_EVENT};
pub use head::{ChannelKind, EXPONENTIAL_BYTES, Head, MAX_PACE, fits, pace, read_starts};
pub use link::{ClipMismatch, Counts, Link, MAX_PACKET, MAX_PAYLOAD, QUEUE_PACKETS};
pub use message::{Message, Messages, Refresh, units};

/// The fields of payloads, for encoders: the crate `pantin-line` has one, which runs on a host.
pub mod wire {
    pub use crate::head::{COUNT_BITS, FIRST_BITS, HEAD_CHECK};
    pub use crate::message::{AHEAD_BITS, END, FRAME, FRAME_BITS, PASS};
    pub use crate::symbols::{Coder, Table};
}
