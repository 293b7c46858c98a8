//! Which addresses of an I2C bus answer.

use embedded_hal::i2c::I2c;

/// The addresses that devices may have: those below and above are reserved (UM10204, 3.1.12).
const ADDRESSES: core::ops::RangeInclusive<u8> = 0x08..=0x77;

/// Calls `found` with each address that answers a write of one byte, 0: some controllers cannot send less. A display takes it as the announcement of commands
/// that do not come, and other devices as the number of a register.
pub fn scan<B: I2c>(bus: &mut B, found: impl FnMut(u8)) {
    ADDRESSES.filter(|&address| bus.write(address, &[0]).is_ok()).for_each(found);
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_hal::i2c::{ErrorKind, ErrorType, NoAcknowledgeSource, Operation};

    struct Bus(Vec<u8>);

    impl ErrorType for Bus {
        type Error = ErrorKind;
    }

    impl I2c for Bus {
        fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
            assert!(matches!(operations, [Operation::Write(bytes)] if *bytes == [0]));
            if self.0.contains(&address) { Ok(()) } else { Err(ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address)) }
        }
    }

    #[test]
    fn the_addresses_that_answer_are_found() {
        for devices in [&[][..], &[0x3c], &[0x08, 0x3d, 0x68, 0x77], &[0x00, 0x07, 0x78]] {
            let mut found = vec![];
            scan(&mut Bus(devices.to_vec()), |address| found.push(address));
            let wanted: Vec<u8> = devices.iter().copied().filter(|address| ADDRESSES.contains(address)).collect();
            assert_eq!(found, wanted);
        }
    }
}
