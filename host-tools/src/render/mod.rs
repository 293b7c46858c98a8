//! Pictures of clips: figures drawn by the very code that the firmware runs, and charts of channels.

pub mod animation;
pub mod apng;
pub mod canvas;
pub mod chart;
pub mod figure;
pub mod gallery;
pub mod gif;
pub mod image;
pub mod palette;
pub mod scene;
pub mod screen;
pub mod shades;
pub mod sheet;
pub mod smooth;
pub mod svg;
