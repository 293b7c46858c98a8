//! The firmware's log: `defmt` frames from semihosting, read with the table in the program's ELF file.

use std::path::Path;

use anyhow::{Context, Result, bail};
use defmt_decoder::{DecodeError, Table};

/// Decodes everything that a program logged, one line a message: level, then text.
pub fn decode(elf: &Path, bytes: &[u8]) -> Result<Vec<String>> {
    let program = std::fs::read(elf).with_context(|| format!("cannot read {}", elf.display()))?;
    let table = Table::parse(&program).with_context(|| format!("{}: its log table", elf.display()))?;
    let table = table.with_context(|| format!("{} has no log table (is it linked with defmt.x?)", elf.display()))?;
    let mut decoder = table.new_stream_decoder();
    decoder.received(bytes);
    let mut lines = vec![];
    loop {
        match decoder.decode() {
            Ok(frame) => {
                let level = frame.level().map_or("PRINT", |level| level.as_str());
                lines.push(format!("{} {}", level.to_uppercase(), frame.display_message()));
            }
            Err(DecodeError::UnexpectedEof) => return Ok(lines),
            Err(DecodeError::Malformed) => {
                bail!("the log is damaged after {} messages: something else wrote to stdout, or the ELF is another", lines.len())
            }
        }
    }
}
