//! One command a file.

pub mod conformance;
pub mod demo;
pub mod fuzz;
mod packages;
mod steps;
pub mod test;
pub mod vectors;
