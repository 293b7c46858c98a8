//! Stores the clip that a board plays in a reserved part of its flash, so that it can be replaced without rebuilding the firmware: by
//! an image of `pantin flash-image`, or over the serial line by `pantin update`.
//!
//! The flash has two [slots](Slot). The board plays the [newest](Store::open) one whose header and bytes are valid. The next clip is written
//! to the other one, and its header is [written last](InactiveSlot::seal): an interruption leaves the old clip intact. If neither slot is
//! valid, the board plays its built-in clips. [`message`] specifies the transfer over the line.
//!
//! A slot starts with a [header] in a block of [`BLOCK_BYTES`] bytes; the clip follows. A slot is a whole number of sectors. The flash
//! may have words of 1 to 256 bytes and sectors of any multiple of 256 bytes, for example those of the nRF51 (4 and 1,024), the nRF52833
//! (4 and 4,096), the RP2040 (256 and 4,096) and the large sectors of the STM32F411 (1 to 4, and 131,072).
//!
//! Limitation: a word whose writing was interrupted may read differently each time. Such a word in the header may show
//! the new clip until it shows the old one again; a transfer in between leaves the built-in clips.
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
