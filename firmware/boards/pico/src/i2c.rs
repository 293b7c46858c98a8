//! The I2C bus: the HAL sets it up, and this module sends.
//!
//! rp2040-hal 0.12 does not report a display that does not answer: `write` reads the reason of the abort twice, and the first read clears it;
//! writes of at most 16 bytes do not read it. Then the abort remains, every further byte is dropped (RP2040 data sheet, 4.3.9), and the next write
//! waits forever.
#![allow(unsafe_code)]

use crate::pins::I2cPort;
use crate::rp_hal::pac::i2c0::RegisterBlock;
use embedded_hal::i2c::{ErrorKind, ErrorType, I2c, NoAcknowledgeSource, Operation};

/// How often a register is read until the bus counts as stuck. A byte takes 2,800 clocks of the processor at 400 kHz; a read takes at least 5.
const MAX_POLLS: u32 = 10_000;

/// The bus of the pins. `B` is the HAL's, which keeps the pins.
pub struct Bus<B> {
    registers: &'static RegisterBlock,
    _set_up: B,
}

impl<B> Bus<B> {
    /// Takes the bus that the HAL has set up.
    pub fn new(set_up: B) -> Self {
        // Safety: the HAL's bus, which owns these registers, is held and not used.
        Bus { registers: unsafe { &*I2cPort::PTR }, _set_up: set_up }
    }

    /// Sends bytes to the display that has been addressed, the last one with a stop. Bytes after an abort are not sent.
    fn send(&mut self, operations: &[Operation<'_>]) -> Result<(), ErrorKind> {
        let mut bytes = 0;
        for operation in operations {
            match operation {
                Operation::Write(part) => bytes += part.len(),
                Operation::Read(_) => return Err(ErrorKind::Other),
            }
        }
        let parts =
            operations.iter().filter_map(|operation| if let Operation::Write(part) = operation { Some(*part) } else { None });
        for byte in parts.flatten() {
            bytes -= 1;
            self.poll(|registers| registers.ic_status().read().tfnf().bit_is_set())?;
            if self.is_aborted() {
                break;
            }
            // Safety: any byte is a valid value of this field.
            self.registers.ic_data_cmd().write(|w| unsafe { w.dat().bits(*byte).stop().bit(bytes == 0) });
        }
        // The controller sends a stop after an abort too.
        self.poll(|registers| registers.ic_raw_intr_stat().read().stop_det().bit_is_set())
    }

    fn is_aborted(&self) -> bool {
        self.registers.ic_raw_intr_stat().read().tx_abrt().bit_is_set()
    }

    /// Reads registers until they are as wanted.
    ///
    /// # Errors
    /// They never are: a wire holds the bus low.
    fn poll(&self, mut ready: impl FnMut(&RegisterBlock) -> bool) -> Result<(), ErrorKind> {
        if (0..MAX_POLLS).any(|_| ready(self.registers)) { Ok(()) } else { Err(ErrorKind::Bus) }
    }

    /// Reading these registers ends an abort, and forgets a stop.
    fn clear(&mut self) {
        self.registers.ic_clr_tx_abrt().read();
        self.registers.ic_clr_stop_det().read();
    }
}

impl<B> ErrorType for Bus<B> {
    type Error = ErrorKind;
}

impl<B> I2c for Bus<B> {
    /// Sends the bytes of all operations in one transfer. A read is an error: no display is read.
    fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        // The address can be set only while the controller is off.
        self.registers.ic_enable().write(|w| w.enable().disabled());
        // Safety: 7 bits fit in this field of 10 bits.
        self.registers.ic_tar().write(|w| unsafe { w.ic_tar().bits(address.into()) });
        self.registers.ic_enable().write(|w| w.enable().enabled());
        self.clear();
        let sent = self.send(operations);
        let aborted = self.is_aborted();
        self.clear();
        if aborted { Err(ErrorKind::NoAcknowledge(NoAcknowledgeSource::Unknown)) } else { sent }
    }
}
