//! Motion sent over a line while it plays.

pub mod address;
pub mod body;
pub mod live;
mod osc;
pub mod pace;
mod turns;
mod vmc;
