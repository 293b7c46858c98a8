//! Motion sent over a line while it plays.

pub mod line;
pub mod pace;
