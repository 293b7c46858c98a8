//! Shared parts of the player's modules: memory that the page writes, mutable statics, and strokes.
#![no_std]
// The page finds and writes memory by plain addresses.
#![allow(unsafe_code)]

pub mod memory;
mod stroke;

pub use memory::Only;
pub use stroke::{HEAD, Stroke};

#[panic_handler]
fn panic(_info: &core::panic::PanicInfo) -> ! {
    core::arch::wasm32::unreachable()
}
