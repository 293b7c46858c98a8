//! The command line `pantin`: its commands, the terminal player, the web server, and what they print.

#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

pub mod board_clip;
pub mod cmd;
pub mod memory;
pub mod open;
pub mod output;
pub mod play;
pub mod serve;
pub mod words;
