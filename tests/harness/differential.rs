//! Damaged clips in the Rust decoder and in one that was written from FORMAT.md alone, in JavaScript or in C: both must refuse them, or
//! read the same.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use hostile::mutants::{BANK_VALUES, EVENTS, FRAMES, REFUSED, VALUES, bank_mutant, key_mutant, mutant, read, read_bank};
use hostile::noise::Noise;

use crate::{paths, setup, vectors};

/// Mutants that one run of Node.js reads.
const BATCH: usize = 2000;

/// A decoder that reads mutants and prints a line for each.
#[derive(Clone, Debug)]
pub enum Decoder {
    /// The one in JavaScript, in Node.js.
    JavaScript,
    /// A program: `mutants.c` of the C decoder.
    Program(PathBuf),
}

/// What became of the mutants.
#[derive(Clone, Debug, Default)]
pub struct Counts {
    /// Mutants that both decoders play with equal poses.
    pub agreed: usize,
    /// Mutants that both decoders refuse.
    pub refused: usize,
    /// Mutants that the decoders read differently.
    pub differing: Vec<Difference>,
}

/// A mutant that two decoders read differently.
#[derive(Clone, Debug)]
pub struct Difference {
    /// The clip.
    pub bytes: Vec<u8>,
    /// What the Rust decoder reads.
    pub rust: String,
    /// What the independent decoder reads.
    pub independent: String,
}

impl Counts {
    /// Adds the comparison of more mutants with the decoder in JavaScript.
    pub fn add(&mut self, mutants: Vec<Vec<u8>>) -> Result<()> {
        self.add_read_by(&Decoder::JavaScript, mutants)
    }

    /// Adds the comparison of more mutants with another decoder.
    pub fn add_read_by(&mut self, decoder: &Decoder, mutants: Vec<Vec<u8>>) -> Result<()> {
        self.compare(decoder, File::Clip, mutants)
    }

    fn compare(&mut self, decoder: &Decoder, of: File, mutants: Vec<Vec<u8>>) -> Result<()> {
        let independent = independent(decoder, of, &mutants)?;
        for (bytes, independent) in mutants.into_iter().zip(independent) {
            let rust = if of == File::Bank { read_bank(&bytes) } else { read(&bytes) };
            match (rust == independent, rust == REFUSED) {
                (true, true) => self.refused += 1,
                (true, false) => self.agreed += 1,
                (false, _) => self.differing.push(Difference { bytes, rust, independent }),
            }
        }
        Ok(())
    }
}

/// Compares `count` mutants of the golden vectors; `seed` selects which. `after_batch` receives the counts so far.
pub fn run(decoder: &Decoder, count: usize, seed: u64, after_batch: impl FnMut(&Counts)) -> Result<Counts> {
    compare(decoder, (File::Clip, clips(&vectors::folder())?, mutant), count, seed, after_batch)
}

/// Compares `count` mutants of the vectors of key clips; otherwise like [`run`].
pub fn run_keys(decoder: &Decoder, count: usize, seed: u64, after_batch: impl FnMut(&Counts)) -> Result<Counts> {
    compare(decoder, (File::Clip, clips(&vectors::keyed::folder())?, key_mutant), count, seed, after_batch)
}

/// Compares `count` mutants of the vectors' bank and of our character's; otherwise like [`run`].
pub fn run_banks(decoder: &Decoder, count: usize, seed: u64, after_batch: impl FnMut(&Counts)) -> Result<Counts> {
    let small = fs::read(vectors::folder().join("bank.ptb"))?;
    let large = fs::read(paths::root().join("motions/character.ptb"))?;
    // The small one is read in less time.
    let banks = vec![small.clone(), small.clone(), small, large];
    compare(decoder, (File::Bank, banks, bank_mutant), count, seed, after_batch)
}

/// What is damaged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum File {
    Clip,
    Bank,
}

/// Files, and how one is damaged.
type Source = (File, Vec<Vec<u8>>, fn(&mut Noise, &[Vec<u8>]) -> Vec<u8>);

/// The clips of a folder of vectors.
fn clips(folder: &Path) -> Result<Vec<Vec<u8>>> {
    Ok(vectors::load(folder)?.into_iter().map(|vector| vector.clip).collect())
}

fn compare(
    decoder: &Decoder,
    (of, files, damaged): Source,
    count: usize,
    seed: u64,
    mut after_batch: impl FnMut(&Counts),
) -> Result<Counts> {
    let mut noise = Noise::new(seed);
    let (mut counts, mut left) = (Counts::default(), count);
    while left > 0 {
        let batch = left.min(BATCH);
        counts.compare(decoder, of, (0..batch).map(|_| damaged(&mut noise, &files)).collect())?;
        left -= batch;
        after_batch(&counts);
    }
    Ok(counts)
}

/// What another decoder reads of each clip or bank.
fn independent(decoder: &Decoder, of: File, clips: &[Vec<u8>]) -> Result<Vec<String>> {
    let mut all = vec![];
    for clip in clips {
        all.extend_from_slice(&(clip.len() as u32).to_le_bytes());
        all.extend_from_slice(clip);
    }
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("mutants");
    fs::write(&file, all)?;
    let mut command = command(decoder, &file)?;
    let values = if of == File::Bank { BANK_VALUES } else { VALUES };
    command.args([values, FRAMES, EVENTS].map(|limit| limit.to_string()));
    if of == File::Bank {
        command.arg("banks");
    }
    let output = command.output().context("cannot start the decoder")?;
    ensure!(output.status.success(), "the independent decoder fails: {}", String::from_utf8_lossy(&output.stderr));
    let lines: Vec<String> = String::from_utf8(output.stdout)?.lines().map(str::to_owned).collect();
    ensure!(lines.len() == clips.len(), "{} lines for {} clips", lines.len(), clips.len());
    Ok(lines)
}

/// The decoder's program with its files.
fn command(decoder: &Decoder, mutants: &Path) -> Result<Command> {
    let vectors = vectors::folder();
    Ok(match decoder {
        Decoder::JavaScript => {
            let mut node = Command::new(setup::emulator("node")?);
            node.arg(paths::root().join("tests/independent/mutants.mjs")).arg(vectors).arg(mutants);
            node
        }
        Decoder::Program(program) => {
            let mut command = Command::new(program);
            command.arg(vectors.join("rig-apart.rig")).arg(mutants);
            command
        }
    })
}
