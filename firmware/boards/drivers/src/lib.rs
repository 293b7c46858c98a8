//! Drivers for what boards have wired to them, over the traits of `embedded-hal`: the chip's own crate provides the bus.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

pub mod color_panels;
mod display;
mod heartbeat;
pub mod i2c_wires;
pub mod indexed;
pub mod led_matrix;
pub mod nrf52;
pub mod scan;
pub mod servo;
pub mod ssd1306;

pub use color_panels::ColorPanel;
pub use display::Display;
pub use heartbeat::Heartbeat;
pub use servo::Servo;
pub use ssd1306::{Mono72x40, Mono128x32, Mono128x64, Ssd1306};
