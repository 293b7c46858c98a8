//! Speaks the `sync` protocol of `tests/harness/sync.rs` on lm3s6965evb, and shows greys that follow from place and frame.
//!
//! The pixel (x, y) of frame n has the grey (x / 8 + y + n) mod 16.
#![no_std]
#![no_main]
// The display and the serial port are registers at fixed addresses.
#![allow(unsafe_code)]

use testsuite as _;

const UART_DATA: u32 = 0x4000_c000;
const UART_FLAGS: u32 = 0x4000_c018;
const UART_RECEIVE_EMPTY: u32 = 0x10;
const SSI_CONTROL0: u32 = 0x4000_8000;
const SSI_CONTROL1: u32 = 0x4000_8004;
const SSI_DATA: u32 = 0x4000_8008;
const SSI_PRESCALE: u32 = 0x4000_8010;
/// Port C's data register as seen through a mask of pin 7 alone: high for display data, low for commands.
const DATA_PIN: u32 = 0x4000_6200;
const PORT_C_DIRECTION: u32 = 0x4000_6400;
const PORT_C_ENABLE: u32 = 0x4000_651c;

#[cortex_m_rt::entry]
fn main() -> ! {
    for (register, value) in [
        (PORT_C_DIRECTION, 0x80),
        (PORT_C_ENABLE, 0x80),
        (SSI_CONTROL1, 0),
        (SSI_PRESCALE, 2),
        (SSI_CONTROL0, 7),
        (SSI_CONTROL1, 2),
    ] {
        write(register, value);
    }
    for frame in 0_u32.. {
        draw(frame);
        [&b"F"[..], &frame.to_le_bytes()[..]].into_iter().flatten().for_each(|&byte| write(UART_DATA, byte.into()));
        match receive() {
            b'\n' => {}
            b'q' => break,
            _ => semihosting::process::exit(1),
        }
    }
    semihosting::process::exit(0)
}

fn draw(frame: u32) {
    write(DATA_PIN, 0);
    [0x15, 0, 63, 0x75, 0, 63].into_iter().for_each(send);
    write(DATA_PIN, 0x80);
    for y in 0..64 {
        for x in (0..128).step_by(2) {
            let grey = (x / 8 + y + frame) % 16;
            send(grey << 4 | grey);
        }
    }
}

/// Sends a byte to the display and takes the one that comes back: a full receiver would stop the sender.
fn send(byte: u32) {
    write(SSI_DATA, byte);
    read(SSI_DATA);
}

fn receive() -> u8 {
    while read(UART_FLAGS) & UART_RECEIVE_EMPTY != 0 {}
    read(UART_DATA) as u8
}

fn write(register: u32, value: u32) {
    // SAFETY: only the addresses above are passed, registers that this machine has and nothing else uses.
    unsafe { (register as *mut u32).write_volatile(value) }
}

fn read(register: u32) -> u32 {
    // SAFETY: as for writing.
    unsafe { (register as *const u32).read_volatile() }
}
