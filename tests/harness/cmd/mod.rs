//! One command a file.

pub mod bench;
pub mod demo;
mod packages;
pub mod steps;
pub mod test;
