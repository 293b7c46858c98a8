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
mod page;
mod run;
mod scene;
mod show;
#[cfg(feature = "update")]
mod stored;
mod update;
pub mod wire;

pub use board::{Board, Exit};
pub use crowd::{FIGURES, Seat, crowd};
pub use keys::Key;
pub use options::{Mode, Options};
pub use page::Page;
pub use run::{NEXT, QUIT, RIG, SHOWN, run};
pub use scene::Entry;
#[cfg(feature = "update")]
pub use stored::run_stored;
