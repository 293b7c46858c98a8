//! Commands that look for faults for as long as one likes: `mutants-differential`, `soak`, `coverage`, `mutation`, `miri`.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use anyhow::{Context, Result, bail, ensure};
use clap::Args;
use harness::differential::{self, Decoder};
use harness::{paths, soak};
use pantin::Clip;
use pantin_line::sender::{LineSettings, Source};
use xtask::setup;
use xtask::steps::say;

/// Crates whose line coverage is measured.
const COVERED: [&str; 3] = ["pantin", "pantin-link", "pantin-store"];
/// Files of other crates, which the tests run through too.
const UNCOVERED: &str = "(host-tools|firmware/(app|face|figure)|tests/harness|tests/hostile)/";
/// Shards of the decoder's mutants: about ten minutes each.
const SHARDS: u32 = 32;
/// Survivors that are known, each with the reason why it cannot be killed.
const SURVIVORS: &str = "tests/mutation-survivors.txt";

/// Plays damaged clips in the Rust decoder and in the one written from FORMAT.md alone; needs Node.js
#[derive(Args)]
pub struct MutantsDifferential {
    /// Number of mutants
    #[arg(default_value_t = 100_000)]
    count: usize,
    /// Selects which mutants are made
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Damages banks instead of clips
    #[arg(long)]
    banks: bool,
}

impl MutantsDifferential {
    /// Runs it; an error if a mutant is read differently.
    pub fn run(self) -> Result<()> {
        let start = Instant::now();
        let progress = |counts: &differential::Counts| {
            let done = counts.agreed + counts.refused + counts.differing.len();
            xtask::steps::progress("mutants", done, self.count);
        };
        let counts = if self.banks {
            differential::run_banks(&Decoder::JavaScript, self.count, self.seed, progress)
        } else {
            differential::run(&Decoder::JavaScript, self.count, self.seed, progress)
        }?;
        println!(
            "{} mutants in {:.0} s: {} agreed, {} refused by both, {} differing",
            self.count,
            start.elapsed().as_secs_f64(),
            counts.agreed,
            counts.refused,
            counts.differing.len()
        );
        let folder = paths::root().join("target/mutants-differential");
        for (index, difference) in counts.differing.iter().enumerate() {
            fs::create_dir_all(&folder)?;
            let file = folder.join(format!("{}-{index}.ptn", self.seed));
            fs::write(&file, &difference.bytes)?;
            println!("{}:\n  Rust: {}\n  independent: {}", file.display(), difference.rust, difference.independent);
        }
        ensure!(counts.differing.is_empty(), "{} mutants are read differently", counts.differing.len());
        Ok(())
    }
}

/// Plays hours of a clip over a simulated line with damage, restarts and clock drift, and checks every frame
#[derive(Args)]
pub struct Soak {
    /// The clip
    #[arg(default_value = "motions/greet.ptn")]
    clip: PathBuf,
    /// Hours of clip time
    #[arg(long, default_value_t = 24.0)]
    hours: f64,
    /// Bits per second of the line, 10 for each byte
    #[arg(long, default_value_t = 38_400)]
    baud: u32,
    /// Packets have parity
    #[arg(long)]
    fec: bool,
    /// Selects the disturbances
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

impl Soak {
    /// Runs it; an error if a frame is wrong.
    pub fn run(self) -> Result<()> {
        let path = paths::root().join(&self.clip);
        let bytes = fs::read(&path).with_context(|| path.display().to_string())?;
        let source = Source::new(&Clip::new_checked(&bytes)?)?;
        let wanted =
            LineSettings { rate: f64::from(self.baud) / 10.0, ahead: 48, share: 1.0, cycle: 12, parity: self.fec, key: None };
        let line = wanted.fitted(&source).with_context(|| format!("{} baud do not carry the clip", self.baud))?;
        let (start, total) = (Instant::now(), (60.0 * self.hours) as usize);
        let mut minutes = 0;
        let seen = soak::run(&source, line, self.hours, self.seed, |_| {
            minutes += 1;
            xtask::steps::progress("minutes", minutes.min(total), total);
        })?;
        println!(
            "{} hours of clip time in {:.0} s: {} frames, {:.2} % of them with all {} channels exact; {} of {} packets damaged or lost; \
             {} restarts of the receiver, {} of the sender, {} stalls",
            self.hours,
            start.elapsed().as_secs_f64(),
            seen.frames,
            100.0 * seen.exact as f64 / seen.frames.max(1) as f64,
            source.moving_channels(),
            seen.harmed,
            seen.packets,
            seen.receiver_restarts,
            seen.sender_restarts,
            seen.stalls
        );
        println!("{} frames wrongly reported as exact, {} frames not exact long after a disturbance", seen.wrong, seen.late);
        ensure!(seen.wrong == 0 && seen.late == 0, "{} frames are wrong", seen.wrong + seen.late);
        Ok(())
    }
}

/// Prints the line coverage of decoder, link and store by their own tests and by the sender's; needs cargo-llvm-cov
#[derive(Args)]
pub struct Coverage {
    /// Write a page for each source file into target/llvm-cov/html
    #[arg(long)]
    html: bool,
}

impl Coverage {
    /// Runs it.
    pub fn run(self) -> Result<()> {
        setup::cargo_program(&["llvm-cov", "--version"], "cargo-llvm-cov", "cargo install cargo-llvm-cov --locked")?;
        // Counts of an earlier run would be added.
        cargo(&["llvm-cov", "clean", "--workspace", "--profraw-only"], &[])?;
        let mut words = vec!["llvm-cov", "--no-report"];
        COVERED.iter().for_each(|package| words.extend(["--package", package]));
        cargo(&words, &[])?;
        // The link's receiver is tested by what the sender sends.
        cargo(&["llvm-cov", "--no-report", "--package", "pantin-line", "--lib", "--", "sender::"], &[])?;
        let form = if self.html { "--html" } else { "--summary-only" };
        cargo(&["llvm-cov", "report", form, "--ignore-filename-regex", UNCOVERED], &[])
    }
}

/// Mutates the decoder and reports the mutants that its fast tests do not kill; needs cargo-mutants
///
/// Results are in target/mutation. A shard that is complete is not run again, unless its results are deleted.
#[derive(Args)]
pub struct Mutation {
    /// The first shard, counted from 0
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(u32).range(..i64::from(SHARDS)))]
    from: u32,
    /// Number of shards [default: all that follow]
    #[arg(long)]
    shards: Option<u32>,
}

impl Mutation {
    /// Runs the shards that are not complete; an error if a mutant survives that the list of survivors lacks.
    pub fn run(self) -> Result<()> {
        setup::cargo_program(&["mutants", "--version"], "cargo-mutants", "cargo install cargo-mutants --locked")?;
        let known = survivors(&fs::read_to_string(paths::root().join(SURVIVORS)).context(SURVIVORS)?)?;
        let to = self.from.saturating_add(self.shards.unwrap_or(SHARDS)).min(SHARDS);
        let (mut killed, mut listed, mut new) = (0, 0, vec![]);
        for shard in self.from..to {
            let folder = paths::root().join(format!("target/mutation/{shard}"));
            let complete = folder.join("complete");
            if !complete.is_file() {
                say(&format!("== shard {shard} of {SHARDS}"));
                mutate(shard, &folder)?;
                fs::write(&complete, "")?;
            }
            let list = |name: &str| fs::read_to_string(folder.join("mutants.out").join(name)).context(name.to_owned());
            killed += list("caught.txt")?.lines().count() + list("timeout.txt")?.lines().count();
            for mutant in list("missed.txt")?.lines().map(without_place) {
                if known.contains_key(&mutant) { listed += 1 } else { new.push(mutant) }
            }
        }
        println!(
            "shards {} to {} of {SHARDS}: {killed} mutants killed, {listed} listed as equivalent, {} survive",
            self.from,
            to - 1,
            new.len()
        );
        new.iter().for_each(|mutant| println!("{mutant}"));
        ensure!(
            new.is_empty(),
            "{} mutants survive: kill them with a test, or list them in {SURVIVORS} with the reason",
            new.len()
        );
        Ok(())
    }
}

fn mutate(shard: u32, folder: &Path) -> Result<()> {
    fs::create_dir_all(folder)?;
    let (part, output) = (format!("{shard}/{SHARDS}"), folder.display().to_string());
    let words = [
        "mutants",
        "--package",
        "pantin",
        "--shard",
        &part,
        "--output",
        &output,
        "--baseline",
        "skip",
        "--timeout",
        "20",
        "--no-shuffle",
        "--colors",
        "never",
        "--",
        "--lib",
        "--tests",
    ];
    let mut cargo = Command::new("cargo");
    cargo.args(words).current_dir(paths::root()).env_remove("RUSTUP_TOOLCHAIN");
    // Without debug information and with few optimizations a mutant is built in a quarter of the time.
    cargo.env("CARGO_PROFILE_DEV_DEBUG", "false").env("CARGO_PROFILE_DEV_OPT_LEVEL", "1");
    let status = cargo.env("CARGO_INCREMENTAL", "1").status().context("cannot start cargo")?;
    // 0: all killed; 2: some survive; 3: some time out, which kills them.
    ensure!(matches!(status.code(), Some(0 | 2 | 3)), "cargo mutants failed");
    Ok(())
}

/// The mutant without its line and column, which change when something before it does.
fn without_place(mutant: &str) -> String {
    let mut parts = mutant.splitn(4, ':');
    match (parts.next(), parts.next(), parts.next(), parts.next()) {
        (Some(file), Some(_), Some(_), Some(what)) => format!("{file}:{what}"),
        _ => mutant.to_owned(),
    }
}

/// The list of survivors: a mutant and, in the lines after it, which are indented, the reason.
fn survivors(text: &str) -> Result<BTreeMap<String, String>> {
    let mut list: BTreeMap<String, String> = BTreeMap::new();
    let mut last = None;
    for line in text.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('#')) {
        match (line.strip_prefix("  "), &last) {
            (Some(reason), Some(mutant)) => *list.entry(String::clone(mutant)).or_default() += reason,
            (Some(_), None) => bail!("{SURVIVORS}: a reason without a mutant: {line}"),
            (None, _) => {
                list.insert(line.to_owned(), String::new());
                last = Some(line.to_owned());
            }
        }
    }
    for (mutant, reason) in &list {
        ensure!(!reason.is_empty(), "{SURVIVORS}: no reason for {mutant}");
    }
    Ok(list)
}

/// Runs the decoder's tests in Miri; needs a nightly Rust with its component miri
#[derive(Args)]
pub struct Miri {
    /// Passed to the test program: names of tests
    tests: Vec<String>,
}

impl Miri {
    /// Runs it.
    pub fn run(self) -> Result<()> {
        setup::cargo_program(&["+nightly", "miri", "--version"], "Miri", "rustup toolchain install nightly --component miri")?;
        let mut words = vec!["+nightly", "miri", "test", "--package", "pantin", "--lib", "--tests", "--"];
        words.extend(self.tests.iter().map(String::as_str));
        // The golden vectors are files.
        cargo(&words, &[("MIRIFLAGS", "-Zmiri-disable-isolation")])
    }
}

fn cargo(words: &[&str], variables: &[(&str, &str)]) -> Result<()> {
    let mut cargo = Command::new("cargo");
    cargo.args(words).envs(variables.iter().copied()).current_dir(paths::root()).env_remove("RUSTUP_TOOLCHAIN");
    let status = cargo.status().context("cannot start cargo")?;
    ensure!(status.success(), "cargo {} failed", words.join(" "));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn survivors_have_reasons() {
        let list = survivors("# A comment.\na: b\n  one\n  two\n\nc\n  three\n").unwrap();
        assert_eq!(list.len(), 2);
        assert!(survivors("a: b\nc\n  three\n").unwrap_err().to_string().contains("no reason for a: b"));
        assert!(survivors("  three\n").is_err());
        survivors(&fs::read_to_string(paths::root().join(SURVIVORS)).unwrap()).unwrap();
    }

    #[test]
    fn mutants_are_known_without_line_and_column() {
        assert_eq!(
            without_place("decoder/src/a.rs:12:5: replace f -> u32 with 0 in A::b"),
            "decoder/src/a.rs: replace f -> u32 with 0 in A::b"
        );
    }
}
