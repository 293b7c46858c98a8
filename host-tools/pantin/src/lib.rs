//! The host side of pantin: motion files in, clips out, and pictures of both.

#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

#[cfg(feature = "cli")]
pub mod cmd;
#[cfg(feature = "cli")]
pub mod face;
#[cfg(feature = "cli")]
pub mod line;
#[cfg(feature = "cli")]
pub mod machine;
#[cfg(feature = "cli")]
pub mod memory;
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
#[cfg(feature = "cli")]
pub mod words;
