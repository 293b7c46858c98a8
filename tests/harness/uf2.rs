//! A linked image as a file that one drags onto the board's drive: UF2 (https://github.com/microsoft/uf2), for the RP2040 and the RP2350.

use std::collections::BTreeMap;

use anyhow::{Context, Result, ensure};
use pantin_line::update::uf2::{self, PAGE};

use crate::segments::{self, Segment};

/// The families; the second one is that of programs for the Arm cores.
const RP2040: u32 = 0xe48b_ff56;
const RP2350: u32 = 0xe48b_ff59;
const NRF52840: u32 = 0xada5_2840;
/// The words of the block that the RP2350's boot ROM looks for in the flash's first 4 KiB: its start, a program for the Arm cores, and its end
/// (RP2350 data sheet, 5.9.5.1).
const IMAGE_BLOCK: [u32; 5] = [0xffff_ded3, 0x1021_0142, 0x0000_01ff, 0, 0xab12_3579];
const SEARCHED: u32 = 4096;
/// Where boot loaders of boards with an nRF52840 start a program, behind a SoftDevice S140 of version 7, and up to where they take one.
const NRF52840_PROGRAM: std::ops::Range<u32> = 0x2_7000..0xa_d000;
/// The flash of the largest boards.
const FLASH: std::ops::Range<u32> = 0x1000_0000..0x1100_0000;
/// What the chip's first stage loads and checks: a second stage, and its CRC.
const SECOND_STAGE: usize = 252;

/// The blocks for the parts of an ELF file that lie in the flash.
pub fn of_elf(elf: &[u8]) -> Result<Vec<u8>> {
    let pages = pages(elf, &FLASH)?;
    let first = pages.get(&FLASH.start).context("the image has no second renderer of the boot at the start of the flash")?;
    ensure!(is_second_stage(first), "the image's second renderer of the boot has a wrong CRC: the chip would not start it");
    Ok(uf2::file(RP2040, &pages))
}

/// The same for the RP2350, which needs no second stage.
pub fn of_rp2350_elf(elf: &[u8]) -> Result<Vec<u8>> {
    let pages = pages(elf, &FLASH)?;
    let first: Vec<u8> = pages.range(FLASH.start..FLASH.start + SEARCHED).flat_map(|(_, page)| page).copied().collect();
    let block = IMAGE_BLOCK.map(u32::to_le_bytes);
    let block = block.as_flattened();
    ensure!(first.windows(block.len()).any(|bytes| bytes == block), "the flash's first 4 KiB do not say what the image is");
    Ok(uf2::file(RP2350, &pages))
}

/// Makes the UF2 file of an nRF52840 with a boot loader.
pub fn of_nrf52840_elf(elf: &[u8]) -> Result<Vec<u8>> {
    let pages = pages(elf, &NRF52840_PROGRAM)?;
    ensure!(
        pages.contains_key(&NRF52840_PROGRAM.start),
        "the boot loader would start no program: none begins at {:#x}",
        NRF52840_PROGRAM.start
    );
    Ok(uf2::file(NRF52840, &pages))
}

/// The same without a second stage: for an emulator, which needs none.
pub fn of_bare_elf(elf: &[u8]) -> Result<Vec<u8>> {
    Ok(uf2::file(RP2040, &pages(elf, &FLASH)?))
}

/// The pages that a file's segments touch, by address.
fn pages(elf: &[u8], flash: &std::ops::Range<u32>) -> Result<BTreeMap<u32, [u8; PAGE]>> {
    let mut pages = BTreeMap::new();
    for Segment { load: start, bytes: data, .. } in segments::of_elf(elf)? {
        if data.is_empty() {
            continue;
        }
        let end = u64::from(start) + data.len() as u64;
        ensure!(
            flash.contains(&start) && end <= u64::from(flash.end),
            "a segment is loaded to {start:#010x}, {} bytes: not into the flash, so that it would be lost when power goes",
            data.len()
        );
        for (address, &byte) in (start..).zip(data) {
            let page = pages.entry(address - address % PAGE as u32).or_insert([0; PAGE]);
            page[address as usize % PAGE] = byte;
        }
    }
    Ok(pages)
}

/// Whether the chip's first stage would start it: CRC-32, the highest bit first, from all ones, not inverted (RP2040 data sheet, 2.8.1.3.1).
fn is_second_stage(page: &[u8; PAGE]) -> bool {
    let crc = page[..SECOND_STAGE].iter().fold(u32::MAX, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte) << 24, |crc, _| crc << 1 ^ if crc >> 31 == 1 { 0x04c1_1db7 } else { 0 })
    });
    page[SECOND_STAGE..] == crc.to_le_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;
    use object::elf::{self, FileHeader32, Ident, PT_LOAD, ProgramHeader32};
    use object::{LittleEndian as LE, U16, U32, pod::bytes_of};
    use pantin_line::update::uf2::{BLOCK, END, FAMILY, MAGIC};

    /// An ELF file of 32 bits with these segments, by address.
    fn elf(segments: &[(u32, &[u8])]) -> Vec<u8> {
        const HEADERS: usize = 52;
        const ONE: usize = 32;
        let mut at = (HEADERS + ONE * segments.len()) as u32;
        let ident = Ident {
            magic: elf::ELFMAG,
            class: elf::ELFCLASS32,
            data: elf::ELFDATA2LSB,
            version: elf::EV_CURRENT,
            os_abi: 0,
            abi_version: 0,
            padding: [0; 7],
        };
        let half = |value| U16::new(LE, value);
        let header = FileHeader32::<LE> {
            e_ident: ident,
            e_type: half(elf::ET_EXEC),
            e_machine: half(elf::EM_ARM),
            e_version: U32::new(LE, 1),
            e_entry: U32::new(LE, 0),
            e_phoff: U32::new(LE, HEADERS as u32),
            e_shoff: U32::new(LE, 0),
            e_flags: U32::new(LE, 0),
            e_ehsize: half(HEADERS as u16),
            e_phentsize: half(ONE as u16),
            e_phnum: half(segments.len() as u16),
            e_shentsize: half(0),
            e_shnum: half(0),
            e_shstrndx: half(0),
        };
        let mut file = bytes_of(&header).to_vec();
        for (address, data) in segments {
            let word = |value: u32| U32::new(LE, value);
            // Where it is loaded, not where it runs, counts.
            file.extend(bytes_of(&ProgramHeader32::<LE> {
                p_type: word(PT_LOAD),
                p_offset: word(at),
                p_vaddr: word(0x2000_0000),
                p_paddr: word(*address),
                p_filesz: word(data.len() as u32),
                p_memsz: word(data.len() as u32),
                p_flags: word(0),
                p_align: word(1),
            }));
            at += data.len() as u32;
        }
        segments.iter().for_each(|(_, data)| file.extend(*data));
        file
    }

    fn second_stage() -> [u8; PAGE] {
        let mut page = [0; PAGE];
        page[0] = 7;
        // The CRC of that byte and 251 zeros, computed with Python's zlib over bytes and result with their bits reversed.
        page[SECOND_STAGE..].copy_from_slice(&CRC.to_le_bytes());
        page
    }

    const CRC: u32 = 0xf6a1_0aff;

    #[test]
    fn parts_of_pages_become_blocks_with_their_addresses() {
        let boot = second_stage();
        let file = of_elf(&elf(&[(FLASH.start, &boot), (0x1000_01fe, &[1, 2, 3]), (0x1000_1000, &[9])])).unwrap();
        assert_eq!(file.len(), 4 * BLOCK);
        let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap());
        for (number, address) in [0x1000_0000, 0x1000_0100, 0x1000_0200, 0x1000_1000].into_iter().enumerate() {
            let at = number * BLOCK;
            let head: Vec<u32> = (0..8).map(|index| word(at + 4 * index)).collect();
            assert_eq!(head, [MAGIC[0], MAGIC[1], FAMILY, address, 256, number as u32, 4, RP2040]);
            assert_eq!(word(at + BLOCK - 4), END);
        }
        assert_eq!(file[32..32 + PAGE], boot);
        assert_eq!(file[BLOCK + 32 + 254..BLOCK + 32 + PAGE], [1, 2]);
        assert_eq!(file[2 * BLOCK + 32..2 * BLOCK + 34], [3, 0]);
        assert_eq!(file[3 * BLOCK + 32], 9);
    }

    #[test]
    fn an_image_of_the_rp2350_says_what_it_is() {
        let block = IMAGE_BLOCK.map(u32::to_le_bytes);
        let file = of_rp2350_elf(&elf(&[(FLASH.start + 0x110, block.as_flattened())])).unwrap();
        assert_eq!(file[28..32], RP2350.to_le_bytes());
        assert!(of_rp2350_elf(&elf(&[(FLASH.start + 0x1000, block.as_flattened())])).is_err());
    }

    #[test]
    fn what_would_not_start_or_not_stay_is_refused() {
        let mut boot = second_stage();
        let refused = |segments: &[(u32, &[u8])]| of_elf(&elf(segments)).unwrap_err().to_string();
        assert!(refused(&[(0x1000_0100, &[1])]).contains("no second renderer"));
        assert!(refused(&[(FLASH.start, &boot), (0x2000_0000, &[1])]).contains("0x20000000, 1 bytes"));
        let refused_2350 = of_rp2350_elf(&elf(&[(FLASH.start, &boot)])).unwrap_err().to_string();
        assert!(refused_2350.contains("do not say what the image is"));
        boot[100] ^= 1;
        assert!(refused(&[(FLASH.start, &boot)]).contains("wrong CRC"));
        assert!(of_elf(b"#!/bin/sh").is_err());
    }
}
