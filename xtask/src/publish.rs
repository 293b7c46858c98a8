//! `cargo xtask package`, `docs` and `msrv`: what a release and its users rely on, each by the tool that checks it.

use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail, ensure};
use xtask::packages::{self, Package};
use xtask::paths;
use xtask::steps::say;

/// Packs every published crate, all of one version, so that they resolve against each other.
///
/// With `--verify` cargo compiles each from its package too.
pub fn package(arguments: &[String]) -> Result<()> {
    let verify = match arguments {
        [] => false,
        [verify] if verify == "--verify" => true,
        _ => bail!("Usage: cargo xtask package [--verify]"),
    };
    let packages = packages::published()?;
    let mut cargo = cargo(&["package", "--allow-dirty"], &packages);
    if !verify {
        cargo.arg("--no-verify");
    }
    run(cargo, "cargo package")?;
    for Package { name, version, .. } in &packages {
        let file = format!("target/package/{name}-{version}.crate");
        let bytes = std::fs::metadata(paths::root().join(&file)).with_context(|| file.clone())?.len();
        let files = files_of(name)?;
        for needed in ["README.md", "LICENSE-MIT", "LICENSE-APACHE"] {
            ensure!(files.iter().any(|file| file == needed), "{name}: its package holds no {needed}");
        }
        say(&format!("{file}: {bytes} bytes, {} files", files.len()));
    }
    Ok(())
}

/// The files of a package.
fn files_of(name: &str) -> Result<Vec<String>> {
    let mut cargo = Command::new(program());
    cargo.args(["package", "--list", "--allow-dirty", "--package", name]).current_dir(paths::root()).stderr(Stdio::null());
    let output = cargo.output().context("cannot start cargo")?;
    ensure!(output.status.success(), "cargo package --list --package {name}");
    Ok(String::from_utf8_lossy(&output.stdout).lines().map(String::from).collect())
}

/// Builds the documentation of every published crate, with warnings as errors.
pub fn docs(arguments: &[String]) -> Result<()> {
    ensure!(arguments.is_empty(), "Usage: cargo xtask docs");
    let mut cargo = cargo(&["doc", "--no-deps", "--lib"], &packages::published()?);
    cargo.env("RUSTDOCFLAGS", "-D warnings");
    run(cargo, "cargo doc")
}

/// Checks every published crate with the toolchain that `rust-version` states.
pub fn msrv(arguments: &[String]) -> Result<()> {
    ensure!(arguments.is_empty(), "Usage: cargo xtask msrv");
    let packages = packages::published()?;
    let versions = || packages.iter().map(|package| package.rust_version.as_str());
    let version = versions().next().context("no package is published")?.to_owned();
    ensure!(versions().all(|other| other == version), "the published crates state several versions of Rust");
    let toolchain = format!("+{version}");
    let there = || {
        let rustc = Command::new("rustc").args([&toolchain, "--version"]).env_remove("RUSTUP_TOOLCHAIN").output();
        rustc.is_ok_and(|rustc| rustc.status.success())
    };
    if !there() && paths::program("rustup").is_some() {
        say(&format!("installing Rust {version}: rustup toolchain install {version} --profile minimal"));
        let mut rustup = Command::new("rustup");
        rustup.args(["toolchain", "install", &version, "--profile", "minimal", "--no-self-update"]).stdout(Stdio::null());
        let _ = rustup.status();
    }
    if !there() {
        say(&format!("SKIPPED: Rust {version} is not installed; rustup toolchain install {version} --profile minimal"));
        return Ok(());
    }
    // By the proxy of rustup, not by the cargo that runs this program.
    let mut cargo = Command::new("cargo");
    cargo.args([toolchain.as_str(), "check"]).args(named(&packages)).current_dir(paths::root());
    for variable in ["CARGO", "RUSTC", "RUSTDOC", "RUSTUP_TOOLCHAIN"] {
        cargo.env_remove(variable);
    }
    cargo.env("CARGO_TARGET_DIR", paths::root().join("target/msrv"));
    run(cargo, &format!("cargo +{version} check"))?;
    say(&format!("all {} published crates compile with Rust {version}", packages.len()));
    Ok(())
}

fn program() -> std::ffi::OsString {
    std::env::var_os("CARGO").unwrap_or("cargo".into())
}

fn named(packages: &[Package]) -> impl Iterator<Item = &str> {
    packages.iter().flat_map(|package| ["--package", package.name.as_str()])
}

fn cargo(arguments: &[&str], packages: &[Package]) -> Command {
    let mut cargo = Command::new(program());
    cargo.args(arguments).args(named(packages)).current_dir(paths::root());
    cargo
}

fn run(mut command: Command, what: &str) -> Result<()> {
    ensure!(command.status().with_context(|| format!("cannot start {what}"))?.success(), "{what} failed, see above");
    Ok(())
}
