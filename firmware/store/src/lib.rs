//! Stores the clip that a board plays in its flash, and replaces it without building the firmware again: `pantin flash-image` writes it beside the
//! firmware, and `pantin update` sends it over the serial line.
//!
//! The flash has two [slots](Slot). [`Store::open`] returns the newest clip whose header and bytes are valid, and the inactive slot for the next clip.
//! The header of the next clip is [written last](InactiveSlot::seal), so an interruption at any time leaves the old clip. If neither slot is valid, the board
//! plays its built-in clips. [`message`] specifies how a clip arrives over the line.
//!
//! A slot starts with a [header] in a block of [`BLOCK_BYTES`], followed by the clip. Flash may have words of 1 to 256 bytes and sectors
//! of any multiple of 256 bytes, as the nRF51 (4 and 1,024), the nRF52833 (4 and 4,096), the RP2040 (256 and 4,096) and the large sectors of the
//! STM32F411 (1 to 4, and 131,072). A slot is a whole number of sectors.
//!
//! One case is not covered: a word whose write was interrupted may read differently each time. Such a word in the header may show the new clip at
//! one start and the old clip at another, until the next transfer.
//!
//! ```
//! use pantin_store::{ClipInfo, Request};
//! use pantin_store::message::MAX_REQUEST;
//! use pantin_link::packet::{Receiver, line_len};
//!
//! // The host's side of a transfer starts with this request.
//! let clip = [7; 1000];
//! let info = ClipInfo::of(&clip, "walk").unwrap();
//! let mut line = [0; line_len(MAX_REQUEST)];
//! let len = Request::Begin(info).write(0, &mut line).unwrap();
//!
//! let mut receiver = Receiver::<MAX_REQUEST>::new();
//! let request = line[..len].iter().find_map(|&byte| receiver.push(byte).and_then(|packet| match Request::read(&packet) {
//!     Some(Request::Begin(info)) => Some(info),
//!     _ => None,
//! }));
//! assert_eq!(request, Some(info));
//! assert_eq!((info.length, info.name.as_str()), (1000, "walk"));
//! ```
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

pub mod header;
mod inactive_slot;
mod line;
pub mod message;
pub mod region;
mod slot;
mod store;
mod update;

pub use header::{ClipInfo, Name};
pub use inactive_slot::InactiveSlot;
pub use message::{Refusal, Request, Response};
pub use slot::Slot;
pub use store::{Store, StoredClip};
pub use update::Update;

/// Bytes of a slot that its header takes, of the data of a packet, and of one write to the flash.
pub const BLOCK_BYTES: usize = 256;
