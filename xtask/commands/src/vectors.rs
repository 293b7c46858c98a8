//! `cargo xtask vectors`: regenerates the golden vectors.
//!
//! Only while the format is experimental: afterwards a vector never changes, and a new one takes a new name.

use std::path::Path;

use anyhow::{Result, bail, ensure};
use clap::Args;
use harness::vectors::{self, Vector, bank, constants, coverage, own, record, synthetic};
use pantin::codec::layout::VERSION;
use pantin_tools::output::write_whole;

/// Versions from here on are experimental.
const EXPERIMENTAL: u8 = 0xe0;

/// Regenerates tests/vectors: clips, the CRC of each of their frames, the format's tables as JSON
#[derive(Args)]
pub struct Vectors {}

impl Vectors {
    /// Writes all files, and takes away those of vectors that are no more.
    pub fn run(self) -> Result<()> {
        if VERSION < EXPERIMENTAL {
            bail!("version {VERSION:#04x} of the format is frozen: its vectors stay as they are");
        }
        let made = synthetic::all();
        let missing = coverage::left_out(&made)?;
        ensure!(missing.is_empty(), "the vectors leave out: {}", missing.join(", "));
        let mut all = own::vectors()?;
        for made in &made {
            all.push(made.vector()?);
        }
        let folder = vectors::folder();
        std::fs::create_dir_all(&folder)?;
        for entry in std::fs::read_dir(&folder)? {
            let path = entry?.path();
            if path.extension().is_some_and(|extension| ["ptn", "ptb", "rig", "json"].iter().any(|ours| extension == *ours)) {
                std::fs::remove_file(path)?;
            }
        }
        let mut total = 0;
        for vector in &all {
            total += write(&folder, vector)?;
        }
        let bank = bank::bytes()?;
        let record = bank::record(&bank)?;
        write_whole(&folder.join(bank::NAME).with_extension("ptb"), &bank)?;
        write_whole(&folder.join(bank::NAME).with_extension("json"), record.as_bytes())?;
        total += bank.len() + record.len();
        let tables = constants::text();
        write_whole(&folder.join("tables.json"), tables.as_bytes())?;
        println!("{} vectors, {} bytes with tables.json", all.len(), total + tables.len());
        Ok(())
    }
}

fn write(folder: &Path, vector: &Vector) -> Result<usize> {
    let clip = vector.open()?;
    let record = record::of(&clip)?;
    println!(
        "{:<20} {:>5} bytes {:>5} frames {:>4} channels {:>4} moving",
        vector.name,
        vector.clip.len(),
        clip.frames(),
        clip.rig().channels(),
        clip.moving()
    );
    let path = |extension: &str| folder.join(format!("{}.{extension}", vector.name));
    write_whole(&path("ptn"), &vector.clip)?;
    write_whole(&path("json"), record.as_bytes())?;
    if let Some(rig) = &vector.rig {
        write_whole(&path("rig"), rig)?;
    }
    Ok(vector.clip.len() + record.len() + vector.rig.as_ref().map_or(0, Vec::len))
}
