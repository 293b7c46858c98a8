//! Lines to boards: motion that plays while it is sent, and clips that a board stores.

#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

pub mod connection;
pub mod sender;
pub mod stream;
pub mod update;
