//! One command a file.

pub mod bench;
pub mod conformance;
pub mod demo;
pub mod fuzz;
pub mod gallery;
mod packages;
mod pictures;
pub mod steps;
pub mod strips;
pub mod test;
pub mod uf2;
pub mod vectors;
