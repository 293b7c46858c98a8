//! Emulators, screens and images of the firmware, for tests and for `cargo xtask`.

#[cfg(feature = "full")]
pub mod animator;
pub mod build;
#[cfg(feature = "full")]
pub mod chip;
pub mod clips;
#[cfg(feature = "full")]
pub mod conformance;
#[cfg(feature = "full")]
pub mod defmt_log;
#[cfg(feature = "full")]
pub mod differential;
pub mod display;
#[cfg(feature = "full")]
pub mod download;
#[cfg(feature = "full")]
pub mod equal;
#[cfg(feature = "full")]
pub mod gba;
pub mod icount;
#[cfg(feature = "full")]
pub mod image;
#[cfg(feature = "full")]
pub mod independent;
#[cfg(feature = "full")]
pub mod lossy;
#[cfg(feature = "full")]
pub mod panel;
pub mod pictures;
pub mod qemu;
pub mod qmp;
#[cfg(feature = "full")]
pub mod rp2040;
pub mod screen;
#[cfg(feature = "full")]
mod segments;
#[cfg(feature = "full")]
mod sha256;
#[cfg(feature = "simulator")]
pub mod simulator;
#[cfg(feature = "full")]
pub mod size_tables;
#[cfg(feature = "full")]
pub mod sizes;
#[cfg(feature = "full")]
pub mod soak;
#[cfg(feature = "full")]
pub mod stack;
#[cfg(feature = "full")]
pub mod steered;
#[cfg(feature = "full")]
pub mod stm32;
pub mod sync;
#[cfg(feature = "full")]
pub mod uf2;
#[cfg(feature = "full")]
pub mod unicorn;
#[cfg(feature = "full")]
pub mod update;
#[cfg(feature = "full")]
pub mod vectors;
#[cfg(feature = "full")]
pub mod web;
pub mod wire;

pub use xtask::{paths, setup};
