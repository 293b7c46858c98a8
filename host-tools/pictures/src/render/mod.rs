//! Pictures of clips: figures drawn by the very code that the firmware runs, and charts of channels.

pub mod chart;
pub mod figure;
pub mod gallery;
pub mod scene;
pub mod screen;
pub mod smooth;
pub mod svg;
