//! An image's functions, their instructions, and the addresses that its data hold.

use std::collections::BTreeSet;

use anyhow::{Context, Result, bail, ensure};
use object::{Architecture, Object, ObjectSection, ObjectSymbol, SectionFlags, SectionKind, SymbolKind, elf};

use super::{arm, riscv, thumb};

/// What an instruction does that the stack depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Takes bytes of stack.
    Frame(u32),
    /// Calls the function at an address.
    Call(u32),
    /// Goes on at an address, which may lie in another function.
    Jump(u32),
    /// Calls, or goes on, where a register says.
    Indirect,
    /// Computes an address.
    Takes(u32),
}

/// A function, from its first byte to after its last.
pub struct Function {
    /// Its name, demangled.
    pub name: String,
    pub start: u32,
    pub end: u32,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Thumb,
    Arm,
    Riscv,
    Data,
}

/// A linked image.
pub struct Code {
    /// Its functions by address.
    pub functions: Vec<Function>,
    /// Those whose addresses lie in its data, vectors aside.
    pub pointed: BTreeSet<usize>,
    /// Where it begins.
    entry: u32,
    /// Bytes of its sections, by address.
    sections: Vec<(u32, Vec<u8>)>,
    /// Where the kind of what follows changes.
    marks: Vec<(u32, Kind)>,
}

impl Code {
    /// Reads an ELF file of Arm or RISC-V.
    pub fn read(bytes: &[u8]) -> Result<Self> {
        let file = object::File::parse(bytes).context("the image is no ELF file")?;
        let usual = match file.architecture() {
            Architecture::Arm => Kind::Arm,
            Architecture::Riscv32 => Kind::Riscv,
            other => bail!("stacks are read from code of Arm and 32-bit RISC-V, not of {other:?}"),
        };
        let mut code = Code {
            functions: vec![],
            pointed: BTreeSet::new(),
            entry: file.entry() as u32,
            sections: vec![],
            marks: marks(&file, usual),
        };
        let mut data = vec![];
        for section in file.sections().filter(is_loaded) {
            let (start, bytes) = (section.address() as u32, section.data().unwrap_or_default().to_vec());
            // Vectors are gone through by the processor alone.
            let vectors = section.name().unwrap_or_default().contains("vector");
            if !vectors && section.kind() == SectionKind::Text {
                code.functions.extend(functions(&file, &section));
            } else if !vectors {
                data.extend((0..bytes.len() as u32).step_by(4).map(|offset| start + offset));
            }
            code.sections.push((start, bytes));
        }
        ensure!(!code.functions.is_empty(), "the image names no functions: it was stripped");
        code.functions.sort_by_key(|function| function.start);
        code.functions.dedup_by_key(|function| function.start);
        for index in 0..code.functions.len() {
            let next = code.functions.get(index + 1).map_or(u32::MAX, |function| function.start);
            let function = &mut code.functions[index];
            function.end = function.end.min(next);
            let (start, end) = (function.start, function.end);
            let stretches = code.stretches(start, end).into_iter().filter(|(_, _, kind)| *kind == Kind::Data);
            data.extend(stretches.flat_map(|(from, to, _)| (from.next_multiple_of(4)..to).step_by(4)));
        }
        code.pointed = data.into_iter().filter_map(|address| code.starting(code.word(address)?)).collect();
        Ok(code)
    }

    /// The function that holds an address.
    pub fn containing(&self, address: u32) -> Option<usize> {
        let after = self.functions.partition_point(|function| function.start <= address);
        let index = after.checked_sub(1)?;
        (address < self.functions[index].end).then_some(index)
    }

    /// The function that a pointer's value stands for. Nobody calls the image's beginning: its address is some other number.
    pub fn starting(&self, pointer: u32) -> Option<usize> {
        let index = self.containing(pointer)?;
        let start = self.functions[index].start;
        let thumb = u32::from(self.kind(start) == Kind::Thumb);
        (pointer == start | thumb && pointer != self.entry).then_some(index)
    }

    /// What a function's instructions do.
    pub fn effects(&self, function: &Function) -> Result<Vec<Effect>> {
        let mut effects = vec![];
        for (start, end, kind) in self.stretches(function.start, function.end) {
            let bytes = self.bytes(start, end).with_context(|| format!("{} lies outside the image", function.name))?;
            let stretch = match kind {
                Kind::Thumb => thumb::effects(bytes, start, |address| self.word(address)),
                Kind::Arm => arm::effects(bytes, start),
                Kind::Riscv => riscv::effects(bytes, start),
                Kind::Data => Ok(vec![]),
            };
            effects.extend(stretch.with_context(|| format!("the frame of {} cannot be told", function.name))?);
        }
        Ok(effects)
    }

    fn kind(&self, address: u32) -> Kind {
        let after = self.marks.partition_point(|(mark, _)| *mark <= address);
        self.marks[after.max(1) - 1].1
    }

    /// The parts of a range that are of one kind each.
    fn stretches(&self, start: u32, end: u32) -> Vec<(u32, u32, Kind)> {
        let inner = self.marks.iter().map(|(mark, _)| *mark).filter(|mark| (start + 1..end).contains(mark));
        let edges: Vec<u32> = [start].into_iter().chain(inner).chain([end]).collect();
        edges.windows(2).filter(|pair| pair[0] < pair[1]).map(|pair| (pair[0], pair[1], self.kind(pair[0]))).collect()
    }

    fn bytes(&self, start: u32, end: u32) -> Option<&[u8]> {
        self.sections.iter().find_map(|(first, bytes)| bytes.get(start.checked_sub(*first)? as usize..(end - first) as usize))
    }

    fn word(&self, address: u32) -> Option<u32> {
        let bytes = self.bytes(address, address.checked_add(4)?)?;
        Some(u32::from_le_bytes(bytes.try_into().ok()?))
    }
}

fn is_loaded(section: &object::Section) -> bool {
    let SectionFlags::Elf { sh_flags } = section.flags() else { return false };
    sh_flags & u64::from(elf::SHF_ALLOC) != 0 && section.kind() != SectionKind::UninitializedData
}

/// What mapping symbols (ELF for the Arm architecture, 5.5.5) say of the bytes after them.
fn marks(file: &object::File, usual: Kind) -> Vec<(u32, Kind)> {
    let mut marks = vec![(0, usual)];
    for symbol in file.symbols() {
        let kind = match symbol.name().unwrap_or_default().as_bytes() {
            [b'$', b't', ..] => Kind::Thumb,
            [b'$', b'a', ..] => Kind::Arm,
            [b'$', b'x', ..] => Kind::Riscv,
            [b'$', b'd', ..] => Kind::Data,
            _ => continue,
        };
        marks.push((symbol.address() as u32, kind));
    }
    marks.sort_by_key(|(address, _)| *address);
    marks
}

/// A section's functions, and labels of assembler between them, which have no size and end at the next.
fn functions(file: &object::File, section: &object::Section) -> Vec<Function> {
    let end = (section.address() + section.size()) as u32;
    let here = file.symbols().filter(|symbol| symbol.section_index() == Some(section.index()));
    let named = here.filter(|symbol| match symbol.kind() {
        SymbolKind::Text => true,
        _ => symbol.is_global() && symbol.size() == 0,
    });
    let functions = named.map(|symbol| {
        let name = format!("{:#}", rustc_demangle::demangle(symbol.name().unwrap_or_default()));
        let thumb = u32::from(file.architecture() == Architecture::Arm && symbol.kind() == SymbolKind::Text);
        let start = symbol.address() as u32 & !thumb;
        let size = symbol.size() as u32;
        Function { name, start, end: if size == 0 { end } else { start + size } }
    });
    functions.filter(|function| function.start < end).collect()
}
