//! State machines of `pantin-animator`: from a text file to the table in a bank, and a picture of their states.
//!
//! The text is TOML; `firmware/animator/MACHINE.md` describes it.

mod compile;
pub mod graph;
pub mod inputs;
pub mod playback;
mod source;
mod table;

pub use compile::{Compiled, compile};
pub use source::{Location, Source, Text};
pub use table::{Made, Warning, make};
