//! What came over the line, heard by interrupt.

use board_common::Inbox;
use esp_hal::Blocking;
use esp_hal::peripherals::UART0;
use esp_hal::uart::{Uart, UartInterrupt};

static RECEIVED: Inbox = Inbox::new();

/// Starts listening.
pub fn listen(line: &mut Uart<'static, Blocking>) {
    line.set_interrupt_handler(hear);
    // When the line's own room of 128 bytes is nearly full, or nothing came for ten bytes' time.
    line.listen(UartInterrupt::RxFifoFull | UartInterrupt::RxTimeout);
}

/// The next byte, if there is one.
pub fn take() -> Option<u8> {
    RECEIVED.take()
}

#[esp_hal::handler]
fn hear() {
    // Nothing else reads the line.
    let line = UART0::regs();
    while line.status().read().rxfifo_cnt().bits() > 0 {
        RECEIVED.put(line.fifo().read().rxfifo_rd_byte().bits());
    }
    line.int_clr().write(|bits| {
        bits.rxfifo_full().clear_bit_by_one();
        bits.rxfifo_tout().clear_bit_by_one()
    });
}
