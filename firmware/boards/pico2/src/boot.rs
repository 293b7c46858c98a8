//! What the chip's boot ROM reads of the image: a program for its Arm cores (RP2350 data sheet, 5.9.5.1).
#![allow(unsafe_code)]

use rp235x_hal::block::ImageDef;

// Safety: the linker script places this section where the boot ROM looks for it.
#[unsafe(link_section = ".start_block")]
#[used]
pub static IMAGE: ImageDef = ImageDef::secure_exe();
