//! Emulators, screens and images of the firmware, for tests and for `cargo xtask`.

pub mod build;
pub mod clips;
pub mod conformance;
pub mod defmt_log;
pub mod display;
pub mod equal;
pub mod icount;
pub mod image;
pub mod lossy;
pub mod qemu;
pub mod qmp;
pub mod rp2040;
pub mod screen;
pub mod simulator;
pub mod size_tables;
pub mod sizes;
pub mod stack;
pub mod sync;
pub mod uf2;
pub mod update;
pub mod vectors;
pub mod web;
pub mod wire;

pub use xtask::{paths, setup};

/// The README's examples, compiled with the documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;
