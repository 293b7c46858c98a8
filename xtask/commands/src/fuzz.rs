//! `cargo xtask fuzz [TARGET]...`: looks for inputs that break what must hold.
//!
//! ```text
//! $ cargo xtask fuzz --hours 0.5 rig_open stream_play
//! == rig_open
//! ...
//! target              executions  per second   edges  inputs  findings
//! ```

use std::collections::BTreeSet;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail, ensure};
use clap::Args;
use clap::builder::PossibleValuesParser;
use flate2::{Compression, read::GzDecoder, write::GzEncoder};
use harness::{paths, vectors};
use hostile::{FUZZ_TARGETS, FuzzTarget, fix};
use pantin::codec::layout::{BANK_MAGIC, MAGIC, VERSION};
use xtask::setup;
use xtask::steps::say;

/// Most bytes of a target's kept corpus, packed: all of them together stay below 2 MB.
const KEPT_BYTES: usize = 100_000;
/// Longest input of a kept corpus: a long one seldom reaches what a short one does not.
const KEPT_INPUT: u64 = 8192;
/// Lines of a fuzzer's output that are printed after a finding.
const LAST_LINES: usize = 30;

/// Fuzzes the entry points for untrusted input in turn; needs a nightly Rust and cargo-fuzz
///
/// The corpus in `fuzz/corpus-kept` is unpacked into `fuzz/corpus` first. An input that breaks a target is left in `fuzz/artifacts`.
#[derive(Args)]
pub struct Fuzz {
    /// The targets [default: all]
    #[arg(value_parser = PossibleValuesParser::new(FUZZ_TARGETS.map(|target| target.name)))]
    targets: Vec<String>,
    /// Print the targets
    #[arg(long)]
    list: bool,
    /// Hours for all targets together, such as 0.5 [default: a minute for each target]
    #[arg(long)]
    hours: Option<f64>,
    /// End a target after this many executions, even if time is left
    #[arg(long)]
    executions: Option<u64>,
    /// The sanitizer: our crates forbid unsafe code, and without one they run faster
    #[arg(long, default_value = "none", value_parser = ["none", "address"])]
    sanitizer: String,
    /// Minimize the corpus of each target afterwards, and write it to `fuzz/corpus-kept`
    #[arg(long)]
    keep: bool,
}

/// What became of a target.
struct Outcome {
    executions: u64,
    per_second: u64,
    edges: u64,
    inputs: usize,
    findings: Vec<PathBuf>,
}

impl Fuzz {
    /// Runs them; an error if one broke.
    pub fn run(self) -> Result<()> {
        if self.list {
            FUZZ_TARGETS.iter().for_each(|target| println!("{}", target.name));
            return Ok(());
        }
        tools()?;
        let wanted = |target: &FuzzTarget| self.targets.is_empty() || self.targets.iter().any(|name| name == target.name);
        let targets: Vec<FuzzTarget> = FUZZ_TARGETS.into_iter().filter(wanted).collect();
        let seconds = self.hours.map_or(60.0, |hours| 3600.0 * hours / targets.len() as f64);
        ensure!(seconds >= 1.0, "--hours {}: less than a second for each target", self.hours.unwrap_or(0.0));
        let mut rows = vec![format!(
            "{:<18} {:>12} {:>11} {:>7} {:>7} {:>9}",
            "target", "executions", "per second", "edges", "inputs", "findings"
        )];
        let mut findings = vec![];
        for target in targets {
            say(&format!("== {}", target.name));
            let outcome = self.fuzz(target, seconds as u64).with_context(|| target.name)?;
            let Outcome { executions, per_second, edges, inputs, .. } = outcome;
            rows.push(format!(
                "{:<18} {executions:>12} {per_second:>11} {edges:>7} {inputs:>7} {:>9}",
                target.name,
                outcome.findings.len()
            ));
            say(&rows[rows.len() - 1]);
            findings.extend(outcome.findings);
            if self.keep {
                keep(target, &self.sanitizer).with_context(|| target.name)?;
            }
        }
        println!();
        rows.iter().for_each(|row| println!("{row}"));
        if findings.is_empty() {
            return Ok(());
        }
        findings.iter().for_each(|finding| println!("{}", finding.display()));
        bail!("{} findings; once an input above is mended, keep it in fuzz/corpus-seed/TARGET", findings.len())
    }

    fn fuzz(&self, target: FuzzTarget, seconds: u64) -> Result<Outcome> {
        let folder = corpus(target)?;
        let before = artifacts(target);
        let mut arguments: Vec<String> = vec![folder.display().to_string()];
        let seeds = paths::root().join("fuzz/corpus-seed").join(target.name);
        if seeds.is_dir() {
            arguments.push(seeds.display().to_string());
        }
        arguments.extend(["--", "-timeout=10", "-rss_limit_mb=2048", "-print_final_stats=1"].map(str::to_owned));
        arguments.push(format!("-max_total_time={seconds}"));
        if let Some(executions) = self.executions {
            arguments.push(format!("-runs={executions}"));
        }
        // An empty dictionary is an error to the fuzzer.
        if !target.words.is_empty() {
            let words = folder.with_extension("dict");
            let quoted = |word: &&str| word.bytes().map(|byte| format!("\\x{byte:02X}")).collect::<String>();
            let lines: String = target.words.iter().map(|word| format!("\"{}\"\n", quoted(word))).collect();
            fs::write(&words, lines).with_context(|| words.display().to_string())?;
            arguments.push(format!("-dict={}", words.display()));
        }
        let output = cargo_fuzz(&["run", "--sanitizer", &self.sanitizer, target.name], &arguments)?;
        let number = |name: &str| {
            let line = output.lines.iter().rev().find_map(|line| line.split_once(name));
            line.and_then(|(_, rest)| rest.split_whitespace().next()?.parse().ok()).unwrap_or(0)
        };
        let findings: Vec<PathBuf> = artifacts(target).difference(&before).cloned().collect();
        if !output.success && findings.is_empty() || number("stat::number_of_executed_units:") == 0 && findings.is_empty() {
            bail!("the fuzzer failed");
        }
        Ok(Outcome {
            executions: number("stat::number_of_executed_units:"),
            per_second: number("stat::average_exec_per_sec:"),
            edges: number(" cov: "),
            inputs: fs::read_dir(&folder)?.count(),
            findings,
        })
    }
}

/// An error that says what to install, unless all is there.
fn tools() -> Result<()> {
    setup::cargo_program(&["+nightly", "--version"], "a nightly Rust", "rustup toolchain install nightly")?;
    setup::cargo_program(&["fuzz", "--version"], "cargo-fuzz", "cargo install cargo-fuzz --locked")
}

/// The last lines that a program printed, and whether it succeeded.
struct Output {
    lines: Vec<String>,
    success: bool,
}

/// Runs cargo-fuzz. Its last lines are printed if it fails.
fn cargo_fuzz(words: &[&str], arguments: &[String]) -> Result<Output> {
    let mut fuzz = Command::new("cargo");
    fuzz.args(["+nightly", "fuzz"]).args(words).args(arguments).current_dir(paths::root());
    // The cargo that runs this one has named its own toolchain. Backtraces make importers' errors slow.
    fuzz.env_remove("RUSTUP_TOOLCHAIN").env("RUST_BACKTRACE", "0").env("RUST_LIB_BACKTRACE", "0");
    // Importers read files: those of a file system in memory, if there is one.
    if Path::new("/dev/shm").is_dir() {
        fuzz.env("TMPDIR", "/dev/shm");
    }
    let mut child =
        fuzz.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().context("cannot start cargo")?;
    let mut lines = vec![];
    for line in BufReader::new(child.stderr.take().context("no standard error")?).split(b'\n') {
        lines.push(String::from_utf8_lossy(&line?).into_owned());
        if lines.len() > 1000 {
            lines.drain(..500);
        }
    }
    let success = child.wait()?.success();
    if !success {
        lines[lines.len().saturating_sub(LAST_LINES)..].iter().for_each(|line| eprintln!("{line}"));
    }
    Ok(Output { lines, success })
}

fn artifacts(target: FuzzTarget) -> BTreeSet<PathBuf> {
    let folder = paths::root().join("fuzz/artifacts").join(target.name);
    fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect()
}

/// The working corpus: what earlier runs found here, the kept corpus, the golden vectors of the kinds that the target takes, and inputs that are made.
fn corpus(target: FuzzTarget) -> Result<PathBuf> {
    let folder = paths::root().join("fuzz/corpus").join(target.name);
    fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    for entry in fs::read_dir(vectors::folder()).context("tests/vectors")? {
        let path = entry?.path();
        if target.vectors.iter().any(|kind| path.extension().is_some_and(|extension| extension == *kind)) {
            fs::copy(&path, folder.join(path.file_name().unwrap_or_default()))?;
        }
    }
    for (index, input) in (target.made)().into_iter().enumerate() {
        fs::write(folder.join(format!("made-{index}")), input)?;
    }
    let kept = kept(target);
    if kept.is_file() {
        let packed = fs::File::open(&kept).with_context(|| kept.display().to_string())?;
        for (index, input) in unpack(packed).with_context(|| kept.display().to_string())?.into_iter().enumerate() {
            fs::write(folder.join(format!("kept-{index}")), of_this_version(input))?;
        }
    }
    Ok(folder)
}

/// A kept input as this version of the format reads it: a clip or a bank of another version would be refused by its third byte.
fn of_this_version(mut input: Vec<u8>) -> Vec<u8> {
    if input.get(2).is_some_and(|&version| version != VERSION) {
        if input.starts_with(&MAGIC) {
            fix::clip(&mut input);
        } else if input.starts_with(&BANK_MAGIC) {
            fix::bank(&mut input);
        }
    }
    input
}

fn kept(target: FuzzTarget) -> PathBuf {
    paths::root().join("fuzz/corpus-kept").join(target.name).with_extension("gz")
}

/// Minimizes the working corpus, and packs it.
fn keep(target: FuzzTarget, sanitizer: &str) -> Result<()> {
    let folder = paths::root().join("fuzz/corpus").join(target.name);
    let output = cargo_fuzz(&["cmin", "--sanitizer", sanitizer, target.name], &[folder.display().to_string()])?;
    ensure!(output.success, "cargo fuzz cmin failed");
    let mut inputs = vec![];
    for entry in fs::read_dir(&folder)? {
        let entry = entry?;
        if entry.metadata()?.len() <= KEPT_INPUT {
            inputs.push(fs::read(entry.path())?);
        }
    }
    inputs.sort_by(|a, b| a.len().cmp(&b.len()).then_with(|| a.cmp(b)));
    let mut packed = pack(&inputs)?;
    while packed.len() > KEPT_BYTES {
        // The shortest stay.
        inputs.truncate((inputs.len() * KEPT_BYTES / packed.len()).min(inputs.len() - 1));
        packed = pack(&inputs)?;
    }
    let file = kept(target);
    fs::create_dir_all(file.parent().context("a folder")?)?;
    fs::write(&file, &packed).with_context(|| file.display().to_string())?;
    say(&format!("   {} inputs kept in {} bytes", inputs.len(), packed.len()));
    Ok(())
}

/// Inputs, each behind its length as a u32, compressed.
fn pack(inputs: &[Vec<u8>]) -> Result<Vec<u8>> {
    let mut encoder = GzEncoder::new(vec![], Compression::best());
    for input in inputs {
        encoder.write_all(&(input.len() as u32).to_le_bytes())?;
        encoder.write_all(input)?;
    }
    Ok(encoder.finish()?)
}

fn unpack(packed: impl Read) -> Result<Vec<Vec<u8>>> {
    let mut all = vec![];
    GzDecoder::new(packed).read_to_end(&mut all)?;
    let (mut rest, mut inputs) = (&all[..], vec![]);
    while let Some((len, after)) = rest.split_first_chunk() {
        let (input, after) = after.split_at_checked(u32::from_le_bytes(*len) as usize).context("the file is truncated")?;
        inputs.push(input.to_vec());
        rest = after;
    }
    Ok(inputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_packed_is_unpacked() {
        let inputs = [vec![], vec![0], vec![7; 70_000]];
        assert_eq!(unpack(&pack(&inputs).unwrap()[..]).unwrap(), inputs);
        assert!(unpack(&pack(&inputs).unwrap()[..20]).is_err());
    }

    #[test]
    fn clips_of_another_version_are_kept_as_clips_of_this_one() {
        let walk = fs::read(paths::root().join("motions/walk.ptn")).unwrap();
        let mut other = walk.clone();
        other[2] ^= 1;
        assert!(pantin::Clip::new_checked(&other).is_err());
        assert!(of_this_version(other) == walk);
        assert!(of_this_version(walk.clone()) == walk);
        // What is no clip stays as it is.
        assert_eq!(of_this_version(b"HIERARCHY".to_vec()), b"HIERARCHY");
    }

    #[test]
    fn the_kept_corpus_is_small_and_of_targets_that_are_there() {
        let Ok(entries) = fs::read_dir(paths::root().join("fuzz/corpus-kept")) else { return };
        let mut bytes = 0;
        for entry in entries {
            let path = entry.unwrap().path();
            let name = path.file_stem().unwrap().to_string_lossy();
            assert!(hostile::fuzz_target(&name).is_some(), "{name} is no target");
            assert!(!unpack(fs::File::open(&path).unwrap()).unwrap().is_empty(), "{name} is empty");
            bytes += fs::metadata(&path).unwrap().len();
        }
        assert!(bytes < 2_000_000, "{bytes} bytes");
    }
}
