//! Plays recorded character motion on small machines: three integer additions a channel a frame.
#![cfg_attr(not(any(test, feature = "std")), no_std)]
#![forbid(unsafe_code)]

mod bytes;
pub mod crc;
mod error;
pub mod layout;
mod rig;
pub mod units;

pub use error::{OpenError, TooSmall};
pub use rig::{Joint, Joints, Kind, Kinds, Rig, Scalar, Scalars};
