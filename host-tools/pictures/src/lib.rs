//! Pictures of clips, drawn by the code that firmware runs: figures, faces, charts, and characters of state machines.

#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

pub mod face;
pub mod machine;
pub mod render;
