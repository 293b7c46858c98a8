//! The SSD0323 on synchronous serial port 0: 128x64 pixels of 16 greys, two a byte.
//!
//! Its chip select is pin 0 of port D, which is active after reset: this module does not use port D.

use crate::board::Oled;
use crate::registers::{gpio_c, ssi0, system};
use pantin_figure::surface::{Cell, Framebuffer};

const PIN_7: u32 = 1 << 7;
/// The port is still sending.
const BUSY: u32 = 1 << 4;
const RECEIVE_NOT_EMPTY: u32 = 1 << 2;

/// Sets up the port and the display.
pub fn start() {
    // Clocks of port C and of the serial port on.
    system::RCGC1.write(system::RCGC1.read() | 1 << 4);
    system::RCGC2.write(system::RCGC2.read() | 1 << 2 | 1 << 0);
    gpio_c::DIR.write(gpio_c::DIR.read() | PIN_7);
    gpio_c::DEN.write(gpio_c::DEN.read() | PIN_7);
    ssi0::CR1.write(0);
    ssi0::CPSR.write(2);
    // Frames of 8 bits.
    ssi0::CR0.write(7);
    ssi0::CR1.write(2);
    // Memory row by row.
    command(&[0xa0, 0]);
}

/// Sends what changed since the last call.
pub fn show(frame: &mut Framebuffer<Oled>) {
    for window in frame.send() {
        let cells = window.cells::<Oled>();
        // The display counts columns in bytes of two pixels; a cell has four bytes.
        let [left, right] = cells.columns.map(|column| column as u8 * 4);
        let [top, bottom] = cells.rows.map(|row| row as u8);
        command(&[0x15, left, right + 3, 0x75, top, bottom]);
        gpio_c::PIN_7.write(PIN_7);
        frame.stretches(window).flatten().for_each(|cell| send(&cell.wire()));
        wait();
    }
}

fn command(bytes: &[u8]) {
    gpio_c::PIN_7.write(0);
    send(bytes);
    wait();
}

fn send(bytes: &[u8]) {
    for &byte in bytes {
        ssi0::DR.write(u32::from(byte));
        // Each byte sent receives one; unless it is read, the port stalls after eight.
        while ssi0::SR.read() & RECEIVE_NOT_EMPTY == 0 {}
        ssi0::DR.read();
    }
}

/// Waits until the last bit is sent. Only then may pin 7 change.
fn wait() {
    while ssi0::SR.read() & BUSY != 0 {}
}
