//! State machines of `pantin-animator`: from a text file to the table in a bank, and a picture of their states.
//!
//! The text is TOML; `firmware/animator/MACHINE.md` describes it.

pub mod graph;
pub mod playback;
mod source;
mod table;

pub use source::{Source, Text};
pub use table::{Made, Warning, make};
