//! One command a file.

pub mod bench;
pub mod conformance;
pub mod demo;
pub mod firmware;
pub mod fuzz;
pub mod gallery;
mod images;
mod packages;
mod pictures;
pub mod sizes;
pub mod steps;
pub mod strips;
pub mod test;
pub mod uf2;
pub mod vectors;
pub mod web;
