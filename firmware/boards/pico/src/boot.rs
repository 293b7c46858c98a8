//! The second stage of the boot: it has the flash mapped into memory. The chip's own first stage loads it, and checks its CRC.
#![allow(unsafe_code)]

// Safety: the linker's section of that name is where it belongs.
#[unsafe(link_section = ".boot2")]
#[used]
pub static BOOT2: [u8; 256] = rp2040_boot2::BOOT_LOADER_W25Q080;
