//! Pictures of clips, drawn by the very code that the firmware runs.

pub mod gif;
pub mod screen;
pub mod sheet;
