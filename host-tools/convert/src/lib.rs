//! Converts motions to clips and back: motion files in, clips whose error is bounded and verified out.

#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

pub mod budget;
pub mod channel_error;
pub mod edit;
pub mod encode;
pub mod errors;
mod euler;
pub mod events;
pub mod expand;
pub mod export;
pub mod facts;
pub mod fit;
pub mod fk;
pub mod import;
pub mod input;
pub mod keys;
pub mod motion;
pub mod number;
pub mod verify;
