//! Writes the bytes of a clip or a bank as source text of firmware: a C header, a Rust module, or items of Rust that a build script includes.
//!
//! Each number has one name in all of them: `FRAMES`, `FRAME_TIME_NS`, `CLIPS`, and the sizes of [`MemoryNeeds`](crate::facts::MemoryNeeds).

mod c;
mod described;
mod names;
mod rust;

pub use c::{c_header, c_header_of_bank, c_header_of_look, header};
pub use described::Described;
pub use rust::{RustText, rust_module, rust_module_of_bank};
