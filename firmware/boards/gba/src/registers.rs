//! The registers and memory that the program uses, at their addresses (GBATEK).
#![allow(unsafe_code)]

use board_common::Register;
use core::ptr::{self, with_exposed_provenance_mut};

/// Names a register by its address.
const fn at<T: Copy>(address: usize) -> Register<T> {
    // Safety: every address below is a register of the machine that this program is linked for, of the width that it is named with,
    // aligned to it.
    unsafe { Register::at(address) }
}

/// The display.
pub mod lcd {
    use super::{Register, at};
    pub const CONTROL: Register<u16> = at(0x0400_0000);
    pub const STATUS: Register<u16> = at(0x0400_0004);
    /// The palette's first colour; the others follow, then those of the sprites.
    pub const PALETTE: usize = 0x0500_0000;
    /// The two pages.
    pub const PAGES: [usize; 2] = [0x0600_0000, 0x0600_a000];
}

/// The sprites' memory.
pub mod sprites {
    /// The tiles that the pages leave.
    pub const TILES: usize = 0x0601_4000;
    /// Four halves for each of 128 sprites.
    pub const ATTRIBUTES: usize = 0x0700_0000;
}

/// DMA channel 3.
pub mod dma3 {
    use super::{Register, at};
    pub const SOURCE: Register<usize> = at(0x0400_00d4);
    pub const DESTINATION: Register<usize> = at(0x0400_00d8);
    /// Units in the lower half, control in the upper one.
    pub const CONTROL: Register<u32> = at(0x0400_00dc);
}

/// The ten buttons, each 0 while it is held.
pub const KEYS: Register<u16> = at(0x0400_0130);

/// Interrupts.
pub mod interrupts {
    use super::{Register, at};
    pub const ENABLED: Register<u16> = at(0x0400_0200);
    pub const MASTER: Register<u16> = at(0x0400_0208);
}

/// Wait states of the cartridge.
pub const WAIT_STATES: Register<u16> = at(0x0400_0204);

/// Sets a colour of a palette.
pub fn set_colour(palette: usize, index: u8, rgb: [u8; 3]) {
    let [red, green, blue] = rgb.map(|part| u16::from(part >> 3));
    let entry = with_exposed_provenance_mut::<u16>(palette + 2 * usize::from(index));
    // Safety: the palettes are memory of 256 colours each.
    unsafe { ptr::write_volatile(entry, blue << 10 | green << 5 | red) };
}
