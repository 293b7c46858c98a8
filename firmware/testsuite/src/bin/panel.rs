//! Speaks the `sync` protocol of `tests/harness/sync.rs` on lm3s6965evb, and shows greys that follow from place and frame.
//!
//! The pixel (x, y) of frame n has the grey (x / 8 + y + n) mod 16.
#![no_std]
#![no_main]
// The display and the serial port are registers at fixed addresses.
#![allow(unsafe_code)]

#[path = "../oled.rs"]
mod oled;

use testsuite as _;

#[cortex_m_rt::entry]
fn main() -> ! {
    oled::start();
    for frame in 0_u32.. {
        let grey = |x: u32, y: u32| (x / 8 + y + frame) % 16;
        let row = |y: u32| (0..128).step_by(2).map(move |x| (grey(x, y) << 4 | grey(x, y)) as u8);
        oled::put([0, 63], [0, 63], (0..64).flat_map(row));
        if oled::wait_for_host(frame) {
            break;
        }
    }
    semihosting::process::exit(0)
}
