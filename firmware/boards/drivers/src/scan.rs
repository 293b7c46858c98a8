//! Which addresses of an I2C bus answer.

use embedded_hal::i2c::{Error, ErrorKind, I2c};

/// The addresses that devices may have: those below and above are reserved (UM10204, 3.1.12).
const ADDRESSES: core::ops::RangeInclusive<u8> = 0x08..=0x77;

/// Calls `found` with each address that answers a write of one byte, 0: some controllers cannot send less. A display takes it as the announcement of commands
/// that do not come, and other devices as the number of a register.
///
/// # Errors
/// The bus fails, as when a wire is held low: no further address is tried, since each may take as long as the bus' time limit. [`ErrorKind::Other`] does not
/// end the search: some controllers report so that nothing answers.
pub fn scan<B: I2c>(bus: &mut B, mut found: impl FnMut(u8)) -> Result<(), ErrorKind> {
    for address in ADDRESSES {
        match bus.write(address, &[0]).map_err(|error| error.kind()) {
            Ok(()) => found(address),
            Err(ErrorKind::NoAcknowledge(_) | ErrorKind::Other) => {}
            Err(kind) => return Err(kind),
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_hal::i2c::{ErrorKind, ErrorType, NoAcknowledgeSource, Operation};

    /// Devices at addresses; a wire is held low from the second on.
    struct Bus(Vec<u8>, Option<u8>);

    impl ErrorType for Bus {
        type Error = ErrorKind;
    }

    impl I2c for Bus {
        fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
            assert!(matches!(operations, [Operation::Write(bytes)] if *bytes == [0]));
            if let Some(held) = self.1 {
                assert!(address <= held, "nothing is tried on a bus that fails");
                if address == held {
                    return Err(ErrorKind::Bus);
                }
            }
            if self.0.contains(&address) { Ok(()) } else { Err(ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address)) }
        }
    }

    #[test]
    fn the_addresses_that_answer_are_found() {
        for devices in [&[][..], &[0x3c], &[0x08, 0x3d, 0x68, 0x77], &[0x00, 0x07, 0x78]] {
            let mut found = vec![];
            scan(&mut Bus(devices.to_vec(), None), |address| found.push(address)).unwrap();
            let wanted: Vec<u8> = devices.iter().copied().filter(|address| ADDRESSES.contains(address)).collect();
            assert_eq!(found, wanted);
        }
    }
    #[test]
    fn a_bus_that_fails_ends_the_search() {
        let mut found = vec![];
        assert_eq!(scan(&mut Bus(vec![0x3c, 0x3d], Some(0x3d)), |address| found.push(address)), Err(ErrorKind::Bus));
        assert_eq!(found, [0x3c]);
    }
}
