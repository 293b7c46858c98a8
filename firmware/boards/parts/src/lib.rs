//! Parts that boards have wired to them, over the traits of `embedded-hal`: a chip's own crate brings the bus.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

pub mod servo;
pub mod ssd1306;
pub mod st7789;
pub mod tiny;

pub use servo::Servo;
pub use ssd1306::Ssd1306;
pub use st7789::St7789;
pub use tiny::tiny;
