//! The segments of a linked program that are loaded.

use std::ops::Range;

use anyhow::{Context, Result};
use object::Endianness;
use object::elf::{FileHeader32, PT_LOAD};
use object::read::elf::{ElfFile, ProgramHeader};

/// A segment.
#[derive(Debug)]
pub struct Segment<'d> {
    /// Where its bytes are loaded to.
    pub load: u32,
    /// Its bytes; none of what lies in RAM alone.
    pub bytes: &'d [u8],
    /// Where it lies while the program runs.
    pub run: Range<u64>,
}

/// The segments of a program, an ELF file of 32 bits, in the file's order.
///
/// # Errors
/// It is no such file, or a segment lies beyond it.
pub fn of_elf(elf: &[u8]) -> Result<Vec<Segment<'_>>> {
    let file = ElfFile::<FileHeader32<Endianness>>::parse(elf).context("the program is no ELF file of 32 bits")?;
    let endian = file.endian();
    let loaded = file.elf_program_headers().iter().filter(|segment| segment.p_type(endian) == PT_LOAD);
    let segment = |segment: &<FileHeader32<Endianness> as object::read::elf::FileHeader>::ProgramHeader| {
        let bytes = segment.data(endian, elf).ok().context("a segment lies beyond the file")?;
        let start = u64::from(segment.p_vaddr(endian));
        Ok(Segment { load: segment.p_paddr(endian), bytes, run: start..start + u64::from(segment.p_memsz(endian)) })
    };
    loaded.map(segment).collect()
}
