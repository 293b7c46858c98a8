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
mod front;
mod history;
mod index;
pub mod layout;
pub mod names;
mod opening;
mod player;
mod position;
mod prefix;
mod rig;
pub mod segment;
mod snapshots;
mod stream;
pub mod tables;
pub mod units;

pub use channel::{ChannelState, length, step_size};
pub use clip::{Clip, Event, has_choice, index_seed};
pub use error::{OpenError, TooSmall};
pub use front::Front;
pub use history::Undo;
pub use player::{Memory, Player};
pub use rig::{Joint, Joints, Kind, Kinds, Rig, Scalar, Scalars};
pub use snapshots::Mark;
pub use stream::{Step, Stream};
