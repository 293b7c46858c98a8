//! Plays every golden vector and prints the CRC of every frame: for each vector its name, then `step` or `seek` and a CRC in
//! hexadecimal for each pose, in the order of [`conformance::play`].
#![no_std]
#![no_main]

mod vectors;

#[cfg(start = "bare")]
mod bare;
#[cfg(start = "cortex_m")]
mod cortex_m;
#[cfg(target_os = "none")]
mod semihosted;
#[cfg(start = "wasm")]
mod wasm;
