//! What boards share. [`SharedBoard`] is the board itself, over a display, a serial port, buttons, a timer and a watchdog; [`run_forever`]
//! and `run_emulated` are the program. A board's own crate has its pins, clocks, memory map and interrupt handlers.
#![no_std]

mod bus_report;
mod buttons;
mod capacity;
#[cfg(feature = "cortex-m")]
pub mod cortex_m;
#[cfg(feature = "emulated-log")]
mod emulated_panic;
#[cfg(feature = "emulated")]
mod exit;
mod flash;
#[cfg(feature = "solid")]
mod look {
    include!(concat!(env!("OUT_DIR"), "/look.rs"));
}
#[cfg(not(feature = "emulated"))]
mod oled;
// Panics of emulated boards end the emulator; one of these boards has no atomic memory access.
#[cfg(not(feature = "emulated"))]
mod panic_screen;
mod register;
#[cfg(not(feature = "emulated"))]
mod restart;
#[cfg(feature = "emulated")]
mod run_emulated;
mod run_forever;
#[cfg(all(feature = "emulated", feature = "steer"))]
mod run_steered;
mod serial;
mod shared_board;
mod ticks;
#[cfg(feature = "buffered")]
pub mod uart_rx;

pub use board_drivers::Mono128x64;
/// The character that buttons steer: a bank with a state machine, `PANTIN_CHARACTER` when this was built, or our own.
#[cfg(feature = "steer")]
pub static CHARACTER: &[u8] = include_bytes!(env!("PANTIN_CHARACTER"));

pub use bus_report::report_bus;
pub use buttons::{ButtonSource, Buttons, NoButtons, five_buttons, two_buttons};
pub use capacity::Capacity;
pub use embedded_storage::nor_flash;
#[cfg(feature = "emulated")]
pub use exit::{Code, exit};
pub use flash::{Flash, NoFlash};
#[cfg(feature = "solid")]
pub use look::{LOOK, OTHER_LOOK};
#[cfg(not(feature = "emulated"))]
pub use oled::{OledPicture, oled};
#[cfg(not(feature = "emulated"))]
pub use panic_screen::{PanicBoard, panic_screen, refusal_screen};
pub use register::Register;
#[cfg(not(feature = "emulated"))]
pub use restart::report_restart;
#[cfg(feature = "emulated")]
pub use run_emulated::run_emulated;
pub use run_forever::{IN_STEP, run_forever};
#[cfg(all(feature = "emulated", feature = "steer"))]
pub use run_steered::run_steered;
pub use serial::{FnSerial, NbSerial, SerialPort};
pub use shared_board::SharedBoard;
pub use ticks::{TickSource, TickTimer};

// Linked for what they provide: the log's transport.
#[cfg(all(feature = "defmt", not(feature = "emulated")))]
use defmt_rtt as _;
#[cfg(feature = "emulated-log")]
use defmt_semihosting as _;
