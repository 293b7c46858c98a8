//! What the commands and the tests share, without dependencies that take long to compile: paths, tools, packages, steps.

pub mod browser;
pub mod build;
pub mod clip;
pub mod core_library;
pub mod crates;
pub mod functions;
pub mod npm;
pub mod packages;
pub mod pages;
pub mod paths;
pub mod repository_files;
pub mod setup;
pub mod shape;
pub mod steps;
pub mod test_programs;
