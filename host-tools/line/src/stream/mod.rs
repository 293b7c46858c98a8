//! Motion sent over a line while it plays.

pub mod address;
pub mod live;
pub mod pace;
