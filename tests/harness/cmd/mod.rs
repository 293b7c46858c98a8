//! One command a file.

pub mod conformance;
pub mod demo;
mod packages;
mod steps;
pub mod test;
pub mod vectors;
