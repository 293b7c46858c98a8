//! The debug port of the nRF52833 and the nRF52840. Since build B of the first and build F of the second it is closed after each reset unless the firmware opens it (nRF52833 Product Specification,
//! 4.8.3; nRF52840, 4.8.2). Then the next program can be flashed only after erasing the whole chip.

/// Registers of 32 bits, at their addresses.
pub trait Registers {
    /// Reads a register.
    fn read(&mut self, address: usize) -> u32;
    /// Writes a register.
    fn write(&mut self, address: usize, value: u32);
}

/// FICR.INFO.VARIANT: four letters, of which the second lowest byte is the build.
const VARIANT: usize = 0x1000_0104;
/// UICR.APPROTECT, which the chip reads at a reset, and the value of its lowest byte after the chip was erased.
const STORED: usize = 0x1000_1208;
const ERASED: u32 = 0xff;
/// APPROTECT.DISABLE, which the firmware writes after each reset.
const DISABLE: usize = 0x4000_0558;
/// The value of both that opens the port.
const OPEN: u32 = 0x5a;
/// The flash controller: ready, and its modes of reading and writing.
const READY: usize = 0x4001_e400;
const CONFIG: usize = 0x4001_e504;
const READ: u32 = 0;
const WRITE: u32 = 1;

/// Opens the debug port of a chip of build `first` or later, now and, once, in the configuration that the chip reads at the next reset. Older chips
/// have an open port.
pub fn open_debug_port(chip: &mut impl Registers, first: u8) {
    let [_, build, ..] = chip.read(VARIANT).to_le_bytes();
    if !(first..=b'Z').contains(&build) {
        return;
    }
    // Only an erased byte: another value is somebody's choice.
    if chip.read(STORED) & ERASED == ERASED {
        chip.write(CONFIG, WRITE);
        chip.write(STORED, !ERASED | OPEN);
        while chip.read(READY) & 1 == 0 {}
        chip.write(CONFIG, READ);
    }
    chip.write(DISABLE, OPEN);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chip whose flash controller is busy for some reads.
    struct Chip {
        variant: u32,
        stored: u32,
        writable: bool,
        busy: u32,
        open: bool,
        stored_writes: usize,
    }

    impl Registers for Chip {
        fn read(&mut self, address: usize) -> u32 {
            match address {
                VARIANT => self.variant,
                STORED => self.stored,
                READY => {
                    self.busy = self.busy.saturating_sub(1);
                    u32::from(self.busy == 0)
                }
                _ => panic!("0x{address:x} is read"),
            }
        }

        fn write(&mut self, address: usize, value: u32) {
            assert_eq!(self.busy, 0, "nothing is written while the controller is busy");
            match (address, value) {
                (CONFIG, WRITE | READ) => self.writable = value == WRITE,
                (STORED, _) if self.writable => {
                    // Written bits only become 0.
                    self.stored &= value;
                    (self.busy, self.stored_writes) = (5, self.stored_writes + 1);
                }
                (DISABLE, OPEN) => self.open = true,
                _ => panic!("0x{value:x} is written to 0x{address:x}"),
            }
        }
    }

    fn chip(variant: &[u8; 4], stored: u32) -> Chip {
        Chip { variant: u32::from_be_bytes(*variant), stored, writable: false, busy: 0, open: false, stored_writes: 0 }
    }

    #[test]
    fn a_new_chip_is_opened_now_and_once_for_the_next_reset() {
        for variant in [b"AAB0", b"AAC0"] {
            let mut chip = chip(variant, u32::MAX);
            for _ in 0..3 {
                chip.open = false;
                open_debug_port(&mut chip, b'B');
                assert!(chip.open && !chip.writable);
                assert_eq!((chip.stored, chip.stored_writes), (0xffff_ff5a, 1));
            }
        }
    }

    #[test]
    fn an_old_chip_and_a_closed_port_stay_as_they_are() {
        for variant in [b"AAA0", b"\xff\xff\xff\xff"] {
            let mut chip = chip(variant, u32::MAX);
            open_debug_port(&mut chip, b'B');
            assert_eq!((chip.open, chip.stored), (false, u32::MAX));
        }
        let mut chip = chip(b"AAB0", 0xffff_ff00);
        open_debug_port(&mut chip, b'B');
        assert_eq!((chip.stored, chip.stored_writes), (0xffff_ff00, 0));
    }
}
