//! Motion sent over a line while it plays.

pub mod line;
pub mod live;
pub mod pace;
