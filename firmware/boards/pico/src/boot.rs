//! The second stage of the boot, which maps the flash into memory. The chip's boot ROM loads it and checks its CRC.
#![allow(unsafe_code)]

// Safety: the linker script places this section where the boot ROM looks for it.
#[unsafe(link_section = ".boot2")]
#[used]
pub static BOOT2: [u8; 256] = rp2040_boot2::BOOT_LOADER_W25Q080;
