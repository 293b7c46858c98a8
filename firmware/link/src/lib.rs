//! Motion over a line that loses bytes, or anything else in packets: no heap, no float, no panic.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

mod cobs;
pub mod packet;
