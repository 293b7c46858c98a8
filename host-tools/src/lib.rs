//! The host side of pantin: motion files in, clips out, and pictures of both.

pub mod channel_error;
pub mod cmd;
pub mod edit;
pub mod encode;
mod euler;
pub mod expand;
pub mod export;
pub mod face;
pub mod fit;
pub mod fk;
pub mod import;
pub mod keys;
pub mod motion;
pub mod play;
pub mod render;
pub mod stream;
pub mod train;
pub mod update;
pub mod verify;
