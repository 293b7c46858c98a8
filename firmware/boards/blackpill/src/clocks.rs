//! The chip's clocks: 100 MHz, from the crystal.

use stm32f4xx_hal::pac::RCC;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::{Config, Rcc};

/// Megahertz of the crystal.
const CRYSTAL: u32 = 25;
/// Megahertz of the processor.
pub const RATE: u32 = 100;

/// Starts them.
pub fn start(control: RCC) -> Rcc {
    control.freeze(Config::hse(CRYSTAL.MHz()).sysclk(RATE.MHz()))
}

/// Waits by counting.
pub fn wait(nanoseconds: u32) {
    cortex_m::asm::delay(nanoseconds.div_ceil(1000) * RATE);
}
