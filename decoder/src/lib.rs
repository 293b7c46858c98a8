//! Plays recorded character motion on small machines: three integer additions a channel a frame.
#![cfg_attr(not(any(test, feature = "std")), no_std)]
#![forbid(unsafe_code)]

mod blocks;
mod bytes;
mod channel;
mod clip;
pub mod crc;
pub mod entropy;
mod error;
#[doc = include_str!("../FORMAT.md")]
pub mod format {}
mod history;
mod index;
pub mod layout;
pub mod names;
mod partial;
mod play_state;
mod player;
mod prefix;
mod rig;
pub mod segment;
mod snapshots;
mod start;
mod stream;
pub mod tables;
pub mod units;

pub use channel::{ChannelState, segment_frames, step_size};
pub use clip::{Clip, Event, has_choice, index_seed};
pub use error::{OpenError, TooSmall};
pub use history::Undo;
pub use partial::PartialClip;
pub use player::{Player, SeekCache};
pub use rig::{Joint, Joints, Kind, Kinds, Rig, Scalar, Scalars};
pub use snapshots::SnapshotPos;
pub use stream::{Progress, Stream};
