//! The whole firmware but the hardware: plays clips on a small display and does what buttons and letters ask for.
//!
//! A board brings its display, timer and line through [`Board`]; [`run`] does the rest.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

mod board;
mod capacity;
pub mod commands;
mod content;
pub mod frame_stream;
mod hud;
#[cfg(feature = "link")]
mod link;
mod log;
mod multi;
mod options;
mod run;
#[cfg(feature = "update")]
mod stored;
mod text_screen;
mod update;
mod view_state;

pub use board::{Board, Exit};
pub use capacity::{Capacity, Figure, MaxClip, RIG};
pub use commands::Command;
pub use multi::{FIGURES, FigureBuffers, multi};
pub use options::{Mode, Options};
pub use run::{NEXT, QUIT, SHOWN, run};
#[cfg(feature = "update")]
pub use stored::run_stored;
pub use text_screen::TextScreen;
pub use view_state::Entry;
