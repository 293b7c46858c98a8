//! `cargo run -p xtask-commands -- log ELF FILE`: what `cargo xtask demo` calls when a board fails.

use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::Args;
use harness::defmt_log;

/// Prints the lines of a board's defmt log
#[derive(Args)]
pub struct Log {
    /// The program that wrote it
    elf: PathBuf,
    /// Its bytes
    file: PathBuf,
}

impl Log {
    /// Decodes and prints.
    pub fn run(self) -> Result<()> {
        let bytes = std::fs::read(&self.file).with_context(|| format!("cannot read {}", self.file.display()))?;
        defmt_log::decode(&self.elf, &bytes)?.iter().for_each(|line| println!("   board: {line}"));
        Ok(())
    }
}
