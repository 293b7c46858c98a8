//! Plays recorded character motion on small machines: three integer additions a channel a frame.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

mod blocks;
mod bytes;
mod channel;
mod clip;
mod clock;
pub mod codec;
mod error;
mod form;
#[doc = include_str!("../FORMAT.md")]
pub mod format {}
mod history;
mod index;
mod joint;
mod kind;
pub mod names;
mod partial;
mod play_state;
mod player;
mod prefix;
mod rig;
mod rig_collector;
mod room;
mod scalar;
mod snapshots;
mod start;
mod stream;
mod trig;
mod turn;
pub mod units;

use codec::{crc, entropy, layout, segment, tables};

pub use channel::ChannelState;
pub use clip::{Clip, Event};
pub use clock::Clock;
pub use error::{Memory, OpenError, TooSmall};
pub use form::{CodedKinds, Form, Pose, WrongForm};
pub use history::Undo;
pub use joint::{Joint, JointRef, Joints};
pub use kind::{Kind, Kinds};
pub use partial::{PartialClip, PausedClip};
pub use player::{Player, SeekCache};
pub use rig::Rig;
pub use rig_collector::{CollectError, RigCollector};
pub use room::Room;
pub use scalar::{Scalar, ScalarRef, Scalars};
pub use snapshots::SnapshotPos;
pub use stream::{Progress, Stream};
pub use turn::{Axis, EulerOrder, Matrix, Turn};
pub use units::{Angle, Component, Fraction};
