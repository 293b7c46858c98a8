//! Files that one drags onto a board's drive: UF2 (<https://github.com/microsoft/uf2>).
//!
//! Written here, since the crates that do it (`elf2uf2-rs`) are programs, not libraries.

use std::collections::BTreeMap;

/// Bytes of a block, and those of the flash in it: a page.
pub const BLOCK: usize = 512;
#[allow(missing_docs)]
pub const PAGE: usize = 256;
/// What a block begins with, and ends with.
pub const MAGIC: [u32; 2] = [0x0a32_4655, 0x9e5d_5157];
#[allow(missing_docs)]
pub const END: u32 = 0x0ab1_6f30;
/// A family follows.
pub const FAMILY: u32 = 0x2000;

/// A file of pages of flash, by their addresses, for chips of a family.
pub fn file(family: u32, pages: &BTreeMap<u32, [u8; PAGE]>) -> Vec<u8> {
    let mut file = Vec::with_capacity(pages.len() * BLOCK);
    for (number, (&address, page)) in (0..).zip(pages) {
        let head = [MAGIC[0], MAGIC[1], FAMILY, address, PAGE as u32, number, pages.len() as u32, family];
        head.iter().for_each(|word| file.extend(word.to_le_bytes()));
        file.extend(page);
        file.resize((number as usize + 1) * BLOCK - 4, 0);
        file.extend(END.to_le_bytes());
    }
    file
}
