//! The host side of pantin: motion files in, clips out, and pictures of both.

#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

pub mod budget;
pub mod channel_error;
#[cfg(feature = "cli")]
pub mod cmd;
pub mod edit;
pub mod encode;
pub mod errors;
mod euler;
pub mod events;
pub mod expand;
pub mod export;
#[cfg(feature = "cli")]
pub mod face;
pub mod facts;
pub mod fit;
pub mod fk;
pub mod import;
pub mod input;
pub mod keys;
#[cfg(feature = "cli")]
pub mod line;
#[cfg(feature = "cli")]
pub mod machine;
pub mod motion;
pub mod number;
#[cfg(feature = "cli")]
pub mod open;
#[cfg(feature = "cli")]
pub mod output;
#[cfg(feature = "cli")]
pub mod play;
#[cfg(feature = "pictures")]
pub mod render;
#[cfg(feature = "sender")]
pub mod sender;
#[cfg(feature = "cli")]
pub mod serve;
#[cfg(feature = "cli")]
pub mod stream;
#[cfg(feature = "cli")]
pub mod train;
#[cfg(feature = "cli")]
pub mod update;
pub mod verify;
