//! The serial line's receive interrupt.

use board_common::uart_rx;
use esp_hal::Blocking;
use esp_hal::peripherals::UART0;
use esp_hal::uart::{Uart, UartInterrupt};

/// Enables the interrupt: when the port's buffer of 128 bytes is nearly full, or nothing was received for the time of ten bytes.
pub fn listen(mut serial: Uart<'static, Blocking>) -> Uart<'static, Blocking> {
    serial.set_interrupt_handler(on_receive);
    serial.listen(UartInterrupt::RxFifoFull | UartInterrupt::RxTimeout);
    serial
}

#[esp_hal::handler]
fn on_receive() {
    // Nothing else reads the port.
    let uart = UART0::regs();
    while uart.status().read().rxfifo_cnt().bits() > 0 {
        uart_rx::push(uart.fifo().read().rxfifo_rd_byte().bits());
    }
    uart.int_clr().write(|bits| {
        bits.rxfifo_full().clear_bit_by_one();
        bits.rxfifo_tout().clear_bit_by_one()
    });
}
