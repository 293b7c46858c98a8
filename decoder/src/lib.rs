//! Plays recorded character motion on small machines: three integer additions per moving channel and frame, without heap,
//! float, `unsafe` or panic.
//!
//! `pantin convert walk.bvh -o walk.ptn` makes a clip; this crate plays it, and `pantin-figure` draws it:
//!
//! ```
//! use pantin::{Clip, Clock, EulerOrder, Room};
//!
//! static WALK: &[u8] = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/walk.ptn"));
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let clip = Clip::new_checked(WALK)?;                // checks every byte once: afterwards playing cannot fail
//! let mut room = Room::<96, 144>::new();              // memory for 144 channels, 96 of them moving; can be a `static`
//! let mut player = room.player(clip)?;
//! let knee = clip.find("left-shin").ok_or("no such joint")?;
//! let order = knee.euler_order().unwrap_or(EulerOrder::ZXY); // its own: other orders have jumps
//! let mut clock = Clock::new(&clip);
//! for _ in 0..100 {
//!     let [first, ..] = player.turn(&knee)?.euler(order); // a shin of this clip has one angle, about x
//!     println!("frame {}: {} degrees", player.frame(), first.degrees());
//!     player.advance(&mut clock, 16_667);             // 60 pictures a second, whatever the clip's rate
//! }
//! # Ok(())
//! # }
//! ```
//!
//! # Which type do I want?
//!
//! | to | use |
//! |---|---|
//! | open a file in flash | [`Clip::new_checked`] |
//! | open one of many clips in one file | [`Bank::new_checked`], [`Bank::clip`] |
//! | know what happens when: footfalls, sounds | [`Clip::events`], [`Clip::event_name`], [`Player::events`] |
//! | play it frame by frame, seek, rewind | [`Player`], in the memory of a [`Room`] |
//! | play it by time, at any display rate and speed | [`Clock`] with [`Player::advance`]; [`Player::interpolate`] between frames |
//! | list a clip's joints | [`Rig::joints`] of [`Clip::rig`] |
//! | read a joint's angles | [`Clip::find`], [`Player::turn`], then [`Turn::euler`] in the joint's own order, [`JointRef::euler_order`], or another |
//! | know how far a hinge bends, wherever its axis lies | [`Turn::angle`] |
//! | read a morph weight or a servo channel by name | [`Clip::find_scalar`], [`Player::scalar`] |
//! | know where joints are in the world | `pantin_math::Kinematics`, `pantin_math::JointChain` |
//! | draw a figure or a face | `pantin_figure::FigureRenderer`, `pantin_face` |
//! | step back, or seek often | [`SeekCache`] with [`Player::step_back`] and [`Player::seek_with`] |
//! | play bytes as they arrive and forget them | [`Stream`]; [`RigCollector`] if the rig arrives too |
//! | play a file while its buffer fills | [`PartialClip`]; [`PausedClip`] if the buffer moves as it grows |
//! | play clips in turn | one [`Room`]: a player gives it back when it goes out of scope |
//! | play several at once | a [`Room`] each |
//! | keep a player beside its memory in one structure | [`DetachedPlayer`] |
//! | mix poses, or draw one clip with another's renderer | compare their [`Form`] first: [`Form::check`] |
//! | write an encoder | [`codec`] and [`format`](mod@format) |
//!
//! A loop starts again where it started: its root position jumps back. A place beyond the loop is the program's sum.
//!
//! Angles, quaternion components and fractions are types of [`units`]. Sizes for [`Room`] are printed by `pantin info`, and
//! `pantin expand -o clip.rs` writes them as constants.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

mod bank;
mod blocks;
mod bytes;
mod channel;
mod clip;
mod clock;
pub mod codec;
#[cfg(feature = "defmt")]
mod defmt_formats;
mod detached;
mod error;
mod form;
#[doc = include_str!("../FORMAT.md")]
pub mod format {}
mod history;
mod index;
mod joint;
#[cfg(feature = "keys")]
mod keys;
mod kind;
#[cfg(feature = "mint")]
mod mint_types;
pub mod names;
mod partial;
mod play_state;
mod player;
mod pose;
mod prefix;
mod rig;
mod rig_collector;
mod room;
mod scalar;
mod seam;
mod snapshots;
mod start;
mod stream;
mod trig;
mod turn;
pub mod units;

use codec::{crc, entropy, layout, segment, tables};

/// The crate of the types of [`units`], so that programs need not depend on it.
pub use fixed;

pub use bank::{Bank, BankEntries, BankEntry};
pub use channel::ChannelState;
pub use clip::{Clip, Event, LEFT_FOOT_DOWN, RIGHT_FOOT_DOWN};
pub use clock::Clock;
pub use detached::{DetachedPlayer, LoopStart};
pub use error::{Memory, OpenError, TooSmall};
pub use form::{CodedKinds, Form, FormRef, WrongForm};
pub use history::Undo;
pub use joint::{Joint, JointRef, Joints};
#[cfg(feature = "keys")]
pub use keys::{ChannelKeys, Interpolation};
pub use kind::{Kind, Kinds};
pub use partial::{PartialClip, PausedClip};
pub use player::{Player, SeekCache};
pub use pose::Pose;
pub use rig::{Rig, Up};
pub use rig_collector::{CollectError, RigCollector};
pub use room::Room;
pub use scalar::{Scalar, ScalarRef, Scalars};
pub use snapshots::SnapshotPos;
pub use stream::{Progress, Stream};
pub use turn::{Axis, EulerOrder, Matrix, Turn};
pub use units::{Angle, Component, Fraction};
