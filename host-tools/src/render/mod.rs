//! Pictures of clips: figures drawn by the very code that the firmware runs, and charts of channels.

pub mod canvas;
pub mod chart;
pub mod gallery;
pub mod gif;
pub mod screen;
pub mod sheet;
