//! What a linked image holds: bytes of code and constants, and the names of its symbols.

use std::path::Path;

use anyhow::{Context, Result};
use object::{Object, ObjectSection, ObjectSegment, ObjectSymbol, SectionFlags, SymbolKind, elf};

use crate::build::Firmware;
use crate::qemu::MICROBIT;

/// What no decoder's image may hold: parts of symbols' names.
const UNWANTED: [&str; 9] =
    ["panic", "begin_unwind", "core::fmt", "__aeabi_f", "__aeabi_d", "compiler_builtins::float", "div", "__aeabi_i2", "alloc::"];

/// A linked image.
pub struct Image {
    /// Bytes of functions.
    pub code: u64,
    /// Bytes of constants.
    pub tables: u64,
    /// Names and bytes of functions and tables, the largest first.
    pub symbols: Vec<(String, u64)>,
}

/// Bytes that an image takes of the flash: all that is loaded from it.
pub fn loaded(elf: &Path) -> Result<u64> {
    let bytes = std::fs::read(elf).with_context(|| elf.display().to_string())?;
    let file = object::File::parse(&*bytes).context("the image is no ELF file")?;
    Ok(file.segments().map(|segment| segment.file_range().1).sum())
}

/// Bytes of RAM that an image's statics take; its stack comes beside them.
pub fn statics(elf: &Path) -> Result<u64> {
    let bytes = std::fs::read(elf).with_context(|| elf.display().to_string())?;
    let file = object::File::parse(&*bytes).context("the image is no ELF file")?;
    let writable = u64::from(elf::SHF_ALLOC | elf::SHF_WRITE);
    let of_ram = |flags| matches!(flags, SectionFlags::Elf { sh_flags } if sh_flags & writable == writable);
    Ok(file.sections().filter(|section| of_ram(section.flags())).map(|section| section.size()).sum())
}

impl Image {
    /// Builds and reads a program of `firmware/testsuite` for the smallest processor.
    pub fn read(program: &str) -> Result<Self> {
        let firmware = Firmware::build("testsuite", program, MICROBIT.target, &[])?;
        let bytes = std::fs::read(firmware.elf())?;
        let elf = object::File::parse(&*bytes).context("the image is no ELF file")?;
        let size = |name| elf.section_by_name(name).map_or(0, |section| section.size());
        let named = elf.symbols().filter(|symbol| matches!(symbol.kind(), SymbolKind::Text | SymbolKind::Data));
        let sized = named.filter(|symbol| symbol.size() > 0);
        let mut symbols: Vec<_> = sized
            .map(|symbol| (format!("{:#}", rustc_demangle::demangle(symbol.name().unwrap_or_default())), symbol.size()))
            .collect();
        symbols.sort_by_key(|(_, size)| std::cmp::Reverse(*size));
        Ok(Self { code: size(".text"), tables: size(".rodata"), symbols })
    }

    /// Symbols of panic, formatting, float, divide or heap.
    pub fn unwanted(&self) -> Vec<&str> {
        let bad = |name: &&str| UNWANTED.iter().any(|part| name.contains(part));
        self.symbols.iter().map(|(name, _)| name.as_str()).filter(bad).collect()
    }
}
