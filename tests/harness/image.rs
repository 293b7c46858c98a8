//! What a linked image holds: bytes of code and constants, and the names of its symbols.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use object::{Object, ObjectSection, ObjectSegment, ObjectSymbol, SectionFlags, SymbolKind, elf};

use crate::build::Firmware;
use crate::qemu::MICROBIT;

/// What no decoder's image may hold: parts of symbols' names.
const UNWANTED: [&str; 9] =
    ["panic", "begin_unwind", "core::fmt", "__aeabi_f", "__aeabi_d", "compiler_builtins::float", "div", "__aeabi_i2", "alloc::"];

/// The images of `firmware/testsuite` with more and more of the decoder, and what each has beside what the one before has.
pub const DECODERS: [(&str, &str); 4] = [
    ("image-step", "open a clip, and step"),
    ("image-seek", "and seek"),
    ("image-back", "and step back, with snapshots"),
    ("image-decoder", "and play bytes as they arrive"),
];

/// What the compiler calls to copy, clear and compare memory: parts of symbols' names. Programs have it for their own sake too.
const MEMORY: [&str; 5] = ["__aeabi_mem", "compiler_builtins::mem", "memcpy", "memmove", "memset"];

/// A linked image.
pub struct Image {
    /// Bytes of functions, without those that copy and clear memory.
    pub code: u64,
    /// Bytes of the compiler's functions that copy and clear memory.
    pub memory: u64,
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

/// The address of a function, by a part of its name as in Rust (`Flash>::start`).
pub fn function(elf: &Path, name: &str) -> Result<u64> {
    let bytes = std::fs::read(elf).with_context(|| elf.display().to_string())?;
    let file = object::File::parse(&*bytes).context("the image is no ELF file")?;
    let named = |symbol: &object::Symbol| symbol.name().is_ok_and(|own| rustc_demangle::demangle(own).to_string().contains(name));
    let mut found = file.symbols().filter(|symbol| symbol.kind() == SymbolKind::Text && named(symbol));
    let address = found.next().with_context(|| format!("no function {name}"))?.address();
    ensure!(found.next().is_none(), "more than one function {name}");
    Ok(address)
}

/// Bytes of RAM that an image's statics take, and code that runs there; its stack comes beside them.
pub fn statics(elf: &Path) -> Result<u64> {
    let bytes = std::fs::read(elf).with_context(|| elf.display().to_string())?;
    let file = object::File::parse(&*bytes).context("the image is no ELF file")?;
    Ok(file
        .sections()
        .filter(|section| is_static(section.name().unwrap_or_default(), section.flags()))
        .map(|section| section.size())
        .sum())
}

/// esp-hal's linker scripts keep code for the RAM in `.rwtext`, have a section for all that is left to the stack, and "dummies" where the
/// same bytes have a second address.
fn is_static(name: &str, flags: SectionFlags) -> bool {
    let SectionFlags::Elf { sh_flags } = flags else { return false };
    let has = |flag: u32| sh_flags & u64::from(flag) != 0;
    let reserves = name == ".stack" || name.contains("dummy");
    has(elf::SHF_ALLOC) && !reserves && (has(elf::SHF_WRITE) || name.starts_with(".rwtext"))
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
        let is_memory = |name: &str| MEMORY.iter().any(|part| name.contains(part));
        let memory = symbols.iter().filter(|(name, _)| is_memory(name)).map(|(_, size)| size).sum();
        Ok(Self { code: size(".text") - memory, memory, tables: size(".rodata"), symbols })
    }

    /// Bytes of all of it.
    pub fn size(&self) -> u64 {
        self.code + self.memory + self.tables
    }

    /// Symbols of panic, formatting, float, divide or heap.
    pub fn unwanted(&self) -> Vec<&str> {
        let bad = |name: &&str| UNWANTED.iter().any(|part| name.contains(part));
        self.symbols.iter().map(|(name, _)| name.as_str()).filter(bad).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_in_the_ram_is_counted_and_what_is_left_of_it_not() {
        let flags = |flags: u32| SectionFlags::Elf { sh_flags: flags.into() };
        let (variable, constant) = (flags(elf::SHF_ALLOC | elf::SHF_WRITE), flags(elf::SHF_ALLOC));
        for (name, flags) in [(".data", variable), (".bss", variable), (".lcd", variable), (".rwtext", constant)] {
            assert!(is_static(name, flags), "{name}");
        }
        for (name, flags) in [(".rodata", constant), (".stack", variable), (".rwdata_dummy", variable), (".debug", flags(0))] {
            assert!(!is_static(name, flags), "{name}");
        }
    }
}
