//! Why a board starts: what the program was doing when the watchdog reset it stands in RAM that a reset does not clear.

use crate::SerialPort;
#[cfg(feature = "cortex-m")]
use crate::cortex_m::kept::{keep, kept};
use portable_atomic::{AtomicBool, Ordering};

/// What the program is doing, as the word that is kept. Whatever else stands there is nothing that a program has written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Stage {
    /// It sets the board up.
    SetUp = 0x7061_6e01,
    /// It computes and draws, or waits for the next frame.
    Playing = 0x7061_6e02,
    /// It sends a picture to the display.
    Sending = 0x7061_6e03,
    /// A panic is shown.
    Panic = 0x7061_6e04,
}

impl Stage {
    /// Notes that the program is here.
    pub fn enter(self) {
        #[cfg(feature = "cortex-m")]
        keep(self as u32);
    }

    /// What the line says of a reset in the stage that was kept.
    fn words(kept: u32) -> &'static [u8] {
        match kept {
            _ if kept == Stage::SetUp as u32 => b" while it set the board up",
            _ if kept == Stage::Playing as u32 => b" while it played",
            _ if kept == Stage::Sending as u32 => b" while it sent a picture to the display",
            _ if kept == Stage::Panic as u32 => b" or panicked",
            _ => b"",
        }
    }
}

/// Sends a line over the serial port if the watchdog reset the board, once: a panic sets the board up again.
pub fn report_restart(serial: &mut impl SerialPort, by_watchdog: bool) {
    static REPORTED: AtomicBool = AtomicBool::new(false);
    // Not `swap`: a Cortex-M0 has none.
    if REPORTED.load(Ordering::Relaxed) {
        return;
    }
    REPORTED.store(true, Ordering::Relaxed);
    if by_watchdog {
        #[cfg(feature = "cortex-m")]
        let kept = kept();
        #[cfg(not(feature = "cortex-m"))]
        let kept = 0;
        serial.send(b"Restarted by the watchdog: the program hung");
        serial.send(Stage::words(kept));
        serial.send(b"\r\n");
    }
    Stage::SetUp.enter();
}
