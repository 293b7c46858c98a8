//! A board's clip, replaced: as the image that is flashed beside the firmware, or sent over a line as `pantin_store::message` says.

pub mod image;
pub mod place;
mod send;
pub mod uf2;

pub use send::{Outcome, RetryPolicy, TransferError, send};
