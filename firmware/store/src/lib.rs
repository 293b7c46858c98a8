//! The clip that a board plays, in flash of its own, replaced without building the firmware anew: written beside the firmware by
//! `pantin flash-image`, or over the serial line by `pantin update`.
//!
//! The flash is two [slots](Slot). The [newest](Store::open) whose header and bytes are right plays; the other is where the next clip
//! comes, whose header is [written last](InactiveSlot::seal): whatever interrupts that, the old clip goes on playing. Where neither slot is
//! right, the board plays the clips that it was built with. How a clip comes over the line is told in [`message`].
//!
//! A slot begins with a [header](header) in a block of [`BLOCK_BYTES`] bytes, and the clip follows. Flash that is written in words of 1 to
//! 256 bytes and erased in sectors of any multiple of 256 bytes will do: the nRF51's (4 and 1,024), the nRF52833's (4 and 4,096), the
//! RP2040's (256 and 4,096), the STM32F411's large sectors (1 to 4, and 131,072). A slot is complete sectors.
//!
//! What it cannot do: a word whose writing was cut off may read one way now and another way later. Such a word in the header may show
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
