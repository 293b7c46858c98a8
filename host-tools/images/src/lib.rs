//! Pictures of displays as images: pixels, palettes, contact sheets, GIF and PNG files that move.

#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

pub mod animation;
pub mod apng;
pub mod canvas;
pub mod gif;
pub mod image;
pub mod palette;
pub mod shades;
pub mod sheet;
