//! Pictures of clips: figures drawn by the very code that the firmware runs, and charts of channels.

pub mod animation;
#[cfg(feature = "cli")]
pub mod apng;
#[cfg(feature = "cli")]
pub mod canvas;
#[cfg(feature = "cli")]
pub mod chart;
#[cfg(feature = "cli")]
pub mod figure;
#[cfg(feature = "cli")]
pub mod gallery;
pub mod gif;
pub mod image;
pub mod palette;
#[cfg(feature = "cli")]
pub mod scene;
#[cfg(feature = "cli")]
pub mod screen;
#[cfg(feature = "cli")]
pub mod shades;
pub mod sheet;
#[cfg(feature = "cli")]
pub mod smooth;
#[cfg(feature = "cli")]
pub mod svg;
