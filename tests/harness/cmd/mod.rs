//! One command a file.

pub mod bench;
pub mod conformance;
pub mod demo;
pub mod fuzz;
pub mod gallery;
mod packages;
pub mod steps;
pub mod test;
pub mod vectors;
