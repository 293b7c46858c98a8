//! The memory of the chips of boards that one can buy: an image that lies outside of it would fault, or not be flashed.
#![allow(clippy::single_range_in_vec_init, reason = "a memory may be one range")]

use std::ops::Range;

use anyhow::{Context, Result, ensure};
use object::{Object, ObjectSymbol};

use crate::segments::{self, Segment};

/// A chip.
#[derive(Debug)]
pub struct Chip {
    /// The package of the board.
    pub board: &'static str,
    /// Its name for `probe-rs run --chip`; none where another tool flashes it.
    pub probe: Option<&'static str>,
    /// Where bytes of an image may be loaded to.
    flash: &'static [Range<u64>],
    /// Where variables and stack may lie.
    ram: &'static [Range<u64>],
}

/// Addresses by the chips' data sheets.
pub const CHIPS: &[Chip] = &[
    // 2 MB of flash are on the board; the six banks of RAM are one range.
    Chip { board: "pico", probe: Some("RP2040"), flash: &[0x1000_0000..0x1020_0000], ram: &[0x2000_0000..0x2004_2000] },
    Chip {
        board: "blackpill",
        probe: Some("STM32F411CEUx"),
        flash: &[0x0800_0000..0x0808_0000],
        ram: &[0x2000_0000..0x2002_0000],
    },
    Chip { board: "microbit-v2", probe: Some("nRF52833_xxAA"), flash: &[0..0x8_0000], ram: &[0x2000_0000..0x2002_0000] },
    // 4 MB of flash are on the board.
    Chip { board: "pico2", probe: Some("RP235x"), flash: &[0x1000_0000..0x1040_0000], ram: &[0x2000_0000..0x2008_2000] },
    Chip {
        board: "nucleo-f411re",
        probe: Some("STM32F411RETx"),
        flash: &[0x0800_0000..0x0808_0000],
        ram: &[0x2000_0000..0x2002_0000],
    },
    Chip { board: "nrf52840-dk", probe: Some("nRF52840_xxAA"), flash: &[0..0x10_0000], ram: &[0x2000_0000..0x2004_0000] },
    // As below; constants and code have the same addresses.
    Chip {
        board: "esp32-c6",
        probe: None,
        flash: &[0x4200_0000..0x4300_0000],
        ram: &[0x4080_0000..0x4088_0000, 0x5000_0000..0x5000_4000],
    },
    // The flash as the processor reads it, as constants and as code; the RAM as data, as code, and what keeps its bytes during deep sleep.
    Chip {
        board: "esp32-c3",
        probe: None,
        flash: &[0x3c00_0000..0x3c80_0000, 0x4200_0000..0x4280_0000],
        ram: &[0x3fc8_0000..0x3fce_0000, 0x4037_c000..0x403e_0000, 0x5000_0000..0x5000_2000],
    },
];

/// What an image takes.
#[derive(Debug, Default)]
struct Taken {
    /// Where bytes are loaded to.
    loaded: Vec<Range<u64>>,
    /// Where these, and variables, lie while the program runs.
    used: Vec<Range<u64>>,
    /// The stack, which begins at its end.
    stack: Option<Range<u64>>,
}

/// The chip of a board, if its addresses stand here.
pub fn of(board: &str) -> Option<&'static Chip> {
    CHIPS.iter().find(|chip| chip.board == board)
}

/// Checks that an image of a board lies in its chip's flash and RAM, with its stack. Boards of other chips are not checked.
///
/// # Errors
/// Something lies outside: `memory.x` is wrong.
pub fn check(board: &str, elf: &[u8]) -> Result<()> {
    let Some(chip) = of(board) else { return Ok(()) };
    chip.holds(&taken(elf)?).with_context(|| format!("{board}: the memory map is not that of the chip"))
}

fn taken(elf: &[u8]) -> Result<Taken> {
    let file = object::File::parse(elf).context("the image is no ELF file")?;
    let mut taken = Taken::default();
    for Segment { load, bytes, run } in segments::of_elf(elf)? {
        let load = u64::from(load);
        if !bytes.is_empty() {
            taken.loaded.push(load..load + bytes.len() as u64);
        }
        if !run.is_empty() {
            taken.used.push(run);
        }
    }
    let symbol = |name| file.symbols().find(|symbol| symbol.name() == Ok(name)).map(|symbol| symbol.address());
    taken.stack = symbol("_stack_end").zip(symbol("_stack_start")).map(|(end, start)| end..start);
    Ok(taken)
}

impl Chip {
    fn holds(&self, taken: &Taken) -> Result<()> {
        let within = |what: &str, range: &Range<u64>, memories: &[&[Range<u64>]]| {
            let mut memories = memories.iter().copied().flatten();
            let fits = memories.any(|memory| memory.start <= range.start && range.end <= memory.end);
            ensure!(fits, "{what} {:#010x} to {:#010x} lies outside of the memory", range.start, range.end);
            Ok(())
        };
        // Without a probe, the second stage of the boot loads the RAM too.
        let loaded: &[&[Range<u64>]] = if self.probe.is_some() { &[self.flash] } else { &[self.flash, self.ram] };
        taken.loaded.iter().try_for_each(|range| within("a segment that is loaded to", range, loaded))?;
        taken.used.iter().try_for_each(|range| within("a segment from", range, &[self.flash, self.ram]))?;
        let stack = taken.stack.as_ref().context("the image has no _stack_start and _stack_end")?;
        ensure!(stack.start < stack.end, "the stack is empty: _stack_start is {:#010x}", stack.end);
        within("the stack from", stack, &[self.ram])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use xtask::packages;

    #[test]
    fn each_boards_runner_names_its_chip() {
        let packages = packages::firmware().unwrap();
        for chip in CHIPS {
            let board = packages.iter().find(|package| package.name == chip.board).unwrap();
            let runner = board.runner().unwrap();
            match chip.probe {
                Some(name) => assert_eq!(runner, format!("probe-rs run --chip {name}")),
                None => assert!(runner.starts_with("espflash flash"), "{runner}"),
            }
        }
        // Whoever flashes with a probe has a chip here.
        for board in packages.iter().filter(|board| board.runner().is_some_and(|runner| runner.starts_with("probe-rs"))) {
            assert!(board.name == "board-template" || of(&board.name).is_some(), "{}", board.name);
        }
    }

    #[test]
    fn a_memory_map_of_another_chip_is_refused() {
        let chip = &CHIPS[1];
        let right = || Taken {
            loaded: vec![0x0800_0000..0x0800_8000],
            used: vec![0x0800_0000..0x0800_8000, 0x2001_f000..0x2001_f400],
            stack: Some(0x2000_0000..0x2001_f000),
        };
        chip.holds(&right()).unwrap();
        type Change = fn(&mut Taken);
        let cases: [(Change, &str); 5] = [
            (|taken| taken.loaded[0].end = 0x0808_0001, "a segment that is loaded to"),
            (|taken| taken.used[1] = 0x2001_f000..0x2002_0004, "a segment from"),
            (|taken| taken.stack = Some(0x2000_0000..0x2003_0000), "the stack from"),
            (|taken| taken.stack = Some(0x2000_0000..0x2000_0000), "the stack is empty"),
            (|taken| taken.stack = None, "no _stack_start"),
        ];
        for (change, words) in cases {
            let mut taken = right();
            change(&mut taken);
            let error = chip.holds(&taken).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
    }
}
