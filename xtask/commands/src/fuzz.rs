//! `cargo xtask fuzz [TARGET] [--seconds N]`: looks for inputs that break what must hold.
//!
//! ```text
//! $ cargo xtask fuzz rig_open --seconds 600
//! == rig_open
//! ...
//! ```

use std::path::PathBuf;
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail, ensure};
use clap::Args;
use clap::builder::PossibleValuesParser;
use harness::{paths, vectors};
use hostile::{FUZZ_TARGETS, FuzzTarget};

use xtask::steps::Steps;

/// Fuzzes one target, or all in turn; needs a nightly Rust and cargo-fuzz
#[derive(Args)]
pub struct Fuzz {
    /// The target [default: all]
    #[arg(value_parser = PossibleValuesParser::new(FUZZ_TARGETS.map(|target| target.name)))]
    target: Option<String>,
    /// Seconds per target
    #[arg(long, default_value_t = 60)]
    seconds: u32,
}

impl Fuzz {
    /// Runs them; an error if one broke.
    pub fn run(self) -> Result<()> {
        tools()?;
        let steps = Steps::default();
        for target in FUZZ_TARGETS.into_iter().filter(|target| self.target.as_ref().is_none_or(|wanted| wanted == target.name)) {
            steps.run(target.name, || run(target, self.seconds));
        }
        steps.finish()
    }
}

fn tools() -> Result<()> {
    let there = |words: &[&str]| {
        let mut cargo = Command::new("cargo");
        // The cargo that runs this one has named its own toolchain.
        cargo.args(words).env_remove("RUSTUP_TOOLCHAIN").stdout(Stdio::null()).stderr(Stdio::null());
        cargo.status().is_ok_and(|status| status.success())
    };
    ensure!(there(&["+nightly", "--version"]), "a nightly Rust is missing; install it with: rustup toolchain install nightly");
    ensure!(there(&["fuzz", "--version"]), "cargo-fuzz is missing; install it with: cargo install cargo-fuzz --locked");
    Ok(())
}

/// First inputs: those of the repository, and golden vectors of the kinds that the target takes.
fn first_inputs(target: FuzzTarget) -> Result<PathBuf> {
    let folder = paths::root().join("fuzz/corpus").join(target.name);
    std::fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    for entry in std::fs::read_dir(vectors::folder()).context("tests/vectors")? {
        let path = entry?.path();
        if target.vectors.iter().any(|kind| path.extension().is_some_and(|extension| extension == *kind)) {
            std::fs::copy(&path, folder.join(path.file_name().unwrap_or_default()))?;
        }
    }
    Ok(folder)
}

fn run(target: FuzzTarget, seconds: u32) -> Result<()> {
    let found = first_inputs(target)?;
    let mut fuzz = Command::new("cargo");
    fuzz.args(["+nightly", "fuzz", "run", target.name]).arg(&found);
    let seeds = paths::root().join("fuzz/corpus-seed").join(target.name);
    if seeds.is_dir() {
        fuzz.arg(seeds);
    }
    fuzz.args(["--", "-timeout=10", "-rss_limit_mb=1024", "-print_final_stats=1"]);
    fuzz.arg(format!("-max_total_time={seconds}"));
    // An empty dictionary is an error to the fuzzer.
    if !target.words.is_empty() {
        let words = found.with_extension("dict");
        let quoted: String = target.words.iter().map(|word| format!("{word:?}\n")).collect();
        std::fs::write(&words, quoted).with_context(|| words.display().to_string())?;
        fuzz.arg(format!("-dict={}", words.display()));
    }
    let status = fuzz.env_remove("RUSTUP_TOOLCHAIN").current_dir(paths::root()).status().context("cannot start cargo")?;
    if !status.success() {
        bail!(
            "see above; an input that breaks it lies in fuzz/artifacts/{}: once mended, keep it in fuzz/corpus-seed/{0}",
            target.name
        );
    }
    Ok(())
}
