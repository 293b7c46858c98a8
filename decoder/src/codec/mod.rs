//! What an encoder shares with the decoder: the format's numbers and tables, CRCs, the range coder. Players need none of it.

pub mod crc;
pub mod entropy;
#[cfg(feature = "keys")]
pub use crate::keys::layout as keys;
pub mod layout;
pub mod segment;
pub mod tables;
pub mod varint;

pub use crate::channel::{segment_frames, step_size};
pub use crate::clip::index_seed;
pub use crate::joint::has_choice;
pub use crate::player::write_snapshot;
pub use crate::start::Statuses;
