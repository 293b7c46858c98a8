//! Converts motions to clips and back: motion files in, clips whose error is bounded and verified out.

#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

pub mod channel_error;
mod conversion;
pub mod edit;
#[cfg(feature = "internals")]
#[doc(hidden)]
pub mod encode;
#[cfg(not(feature = "internals"))]
#[allow(dead_code, reason = "tests and benches measure single steps")]
mod encode;
mod error;
pub mod error_text;
mod euler;
pub mod events;
pub mod expand;
pub mod expand_keys;
pub mod export;
pub mod facts;
mod fields;
#[cfg(feature = "internals")]
#[doc(hidden)]
pub mod fit;
#[cfg(not(feature = "internals"))]
#[allow(dead_code, reason = "tests and benches measure single steps")]
mod fit;
pub mod fk;
pub mod import;
pub mod input;
pub mod keys;
mod length;
mod memory;
mod moment;
pub mod motion;
mod note;
pub mod number;
mod options;
pub mod pose_bound;
mod posing;
pub mod verify;

#[cfg(feature = "internals")]
#[doc(hidden)]
pub use conversion::key_clip;
pub use conversion::{
    Converted, Errors, Made, Prepared, Progress, Recipe, RecordedClip, Recording, Report, SeamReport, agree_on_up, convert,
    of_one_rig, prepare, shared_coding,
};
pub use encode::{bank, rans};
pub use error::{Error, Problem, Setting};
pub use fit::level::Level;
pub use fit::raw;
pub use fit::rotation_coding::{Coding, Rotations};
pub use length::Length;
pub use memory::{Memory, parse as parse_size, size as size_text};
pub use moment::Moment;
pub use note::{Note, NoteKind, Place, Remedy, Severity};
pub use options::{ChannelBound, Options, UseKeys};
pub use posing::Posing;
