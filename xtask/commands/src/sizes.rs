//! `cargo xtask sizes [BOARD...] [--update]`: flash, RAM and stack of every image, against those that `tests/sizes.txt` keeps, which documents say too.
//!
//! ```text
//! $ cargo xtask sizes
//! # image          flash       RAM     stack
//! lm3s6965evb      45604        28      9544
//! ...
//! ```

use std::collections::HashSet;
use std::path::PathBuf;

use anyhow::{Context, Result, bail, ensure};
use clap::Args;
use harness::size_tables::{DOCUMENTS, filled};
use harness::sizes::{FREE, Sizes};
use harness::{chip, paths, stack};
use pantin_tools::output::write_whole;

use crate::images;
use xtask::packages::Package;
use xtask::steps::say;

/// Measures flash, RAM and stack of every board's images; fails if one grew by more than 2 % over tests/sizes.txt
///
/// Flash is all bytes that are loaded, RAM the statics. Stack is the largest sum of stack frames along a path of calls, read from the
/// machine code: a call through a pointer counts as a call of every function whose address the image contains, and functions that call
/// each other recursively count once. This is an upper limit of what a run uses, except that recursion and interrupts are not included.
#[derive(Args)]
pub struct Sizing {
    /// Only these boards, by their packages' names; default: all
    boards: Vec<String>,
    /// Writes tests/sizes.txt and the documents' tables; commit them with the change that made the images grow
    #[arg(long)]
    update: bool,
    /// Prints the calls that make each stack
    #[arg(long)]
    calls: bool,
}

impl Sizing {
    /// Measures, and compares or writes.
    pub fn run(self) -> Result<()> {
        let these = images::boards(&self.boards)?;
        let others = images::boards(&[])?.into_iter().filter(|board| these.iter().all(|one| one.name != board.name));
        let mut sizes = measured(&these, self.calls)?;
        say(&sizes.table());
        // What the file says of the other boards stays.
        let others: HashSet<String> = others.flat_map(|board| images::of(&board)).map(|image| image.name).collect();
        let kept = kept()?;
        let stay = kept.images.iter().filter(|(name, _)| others.contains(*name));
        sizes.images.extend(stay.map(|(name, size)| (name.clone(), *size)));
        if !self.update {
            return compare(&sizes, &kept);
        }
        write_whole(&file(), sizes.text().as_bytes())?;
        say("written to tests/sizes.txt");
        for (document, text) in stale(&sizes)? {
            write_whole(&paths::root().join(document), text.as_bytes())?;
            say(&format!("written to {document}"));
        }
        Ok(())
    }
}

fn file() -> PathBuf {
    paths::root().join("tests/sizes.txt")
}

fn kept() -> Result<Sizes> {
    let text = std::fs::read_to_string(file()).context("cannot read tests/sizes.txt")?;
    Sizes::parse(&text).context("tests/sizes.txt")
}

fn compare(sizes: &Sizes, kept: &Sizes) -> Result<()> {
    let mut complaints = sizes.against(kept);
    complaints.extend(stale(kept)?.into_iter().map(|(document, _)| format!("{document}: its table says otherwise")));
    if complaints.is_empty() {
        say(&format!("no number grew by more than {FREE} % over tests/sizes.txt"));
        return Ok(());
    }
    let list = complaints.join("\n  ");
    bail!("tests/sizes.txt disagrees:\n  {list}\nIf that is meant, run `cargo xtask sizes --update` and commit the files.")
}

/// The documents whose tables say otherwise, and what they are to hold.
fn stale(sizes: &Sizes) -> Result<Vec<(&'static str, String)>> {
    let mut stale = vec![];
    for document in DOCUMENTS {
        let before = std::fs::read_to_string(paths::root().join(document)).context(document)?;
        let after = filled(&before, sizes).context(document)?;
        if after != before {
            stale.push((document, after));
        }
    }
    Ok(stale)
}

/// Builds every image of these boards with its own clips.
fn measured(boards: &[Package], calls: bool) -> Result<Sizes> {
    for name in ["PANTIN_CLIP", "DEFMT_LOG"] {
        ensure!(std::env::var_os(name).is_none(), "{name} is set, which makes other images than the sizes are kept of: unset it");
    }
    let mut sizes = Sizes { compiler: compiler()?, ..Sizes::default() };
    for board in boards {
        for image in images::of(board) {
            let firmware = image.build(&[])?;
            let elf = std::fs::read(firmware.elf()).context("the image cannot be read")?;
            chip::check(&image.package, &elf)?;
            let [flash, ram] = images::flash_and_ram(&firmware)?;
            let stack = stack::worst(firmware.elf()).with_context(|| image.name.clone())?;
            if calls {
                say(&format!(
                    "{}: {} calls through pointers, {} functions in circles",
                    image.name, stack.indirect, stack.circular
                ));
                stack.way.iter().for_each(|(function, frame)| say(&format!("{frame:>9} {function}")));
            }
            sizes.images.insert(image.name, [flash, ram, stack.bytes.into()]);
        }
    }
    Ok(sizes)
}

fn compiler() -> Result<String> {
    let rustc = std::env::var_os("RUSTC").unwrap_or("rustc".into());
    let output = std::process::Command::new(rustc).arg("--version").output().context("cannot start rustc")?;
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
