//! The whole firmware but the hardware: plays clips on a small display and does what buttons and letters ask for.
//!
//! A board brings its display, timer and line through [`Board`]; [`run`] does the rest.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

mod board;
mod crowd;
mod hud;
pub mod keys;
#[cfg(feature = "link")]
mod link;
mod log;
mod options;
mod run;
mod scene;
mod show;
pub mod wire;

pub use board::{Board, Exit};
pub use crowd::{FIGURES, Seat, crowd};
pub use keys::Key;
pub use options::{Mode, Options};
pub use run::{NEXT, QUIT, RIG, SHOWN, run};
pub use scene::Entry;
