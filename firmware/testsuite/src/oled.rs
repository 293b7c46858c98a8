//! The display and the serial port of lm3s6965evb, in step with the host.

use pantin_figure::surface::{Cell, Framebuffer, Gray4Rows};

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

/// Sets up the port and the display.
pub fn start() {
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
    // Memory row by row.
    write(DATA_PIN, 0);
    [0xa0, 0].into_iter().for_each(send);
}

/// Sends bytes to a window of the display's memory: first and last column, in bytes, and row.
pub fn put(columns: [u32; 2], rows: [u32; 2], bytes: impl Iterator<Item = u8>) {
    let ([left, right], [top, bottom]) = (columns, rows);
    write(DATA_PIN, 0);
    [0x15, left, right, 0x75, top, bottom].into_iter().for_each(send);
    write(DATA_PIN, 0x80);
    bytes.for_each(|byte| send(byte.into()));
}

/// Sends what changed since the last call.
#[allow(dead_code)]
pub fn show(frame: &mut Framebuffer<Gray4Rows<128, 64, 1024>>) {
    for window in frame.send() {
        let cells = window.cells::<Gray4Rows<128, 64, 1024>>();
        let [left, right] = cells.columns.map(|column| column as u32 * 4);
        let bytes = frame.stretches(window).flatten().flat_map(|cell| cell.wire());
        put([left, right + 3], cells.rows.map(|row| row as u32), bytes);
    }
}

/// Tells the host the picture's number, and waits for its answer; true if it is the end.
pub fn wait_for_host(number: u32) -> bool {
    [&b"F"[..], &number.to_le_bytes()[..]].into_iter().flatten().for_each(|&byte| write(UART_DATA, byte.into()));
    match receive() {
        b'\n' => false,
        b'q' => true,
        _ => semihosting::process::exit(1),
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
