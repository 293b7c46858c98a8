//! The whole firmware but the hardware: plays a clip on a 128x64 display of 16 greys.
//!
//! A board brings its display, timer and line through [`Board`]; [`run`] does the rest.
#![no_std]
#![forbid(unsafe_code)]

mod board;
mod options;
mod run;

pub use board::{Board, Exit};
pub use options::{Mode, Options};
pub use run::{BYTES, HEIGHT, WIDTH, run};
