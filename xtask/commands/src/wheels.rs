//! `cargo xtask wheels [SYSTEM...]`: the Python package and the program `pantin` for Linux, Windows and macOS, in `target/wheels`.
//!
//! What links for other systems comes from packages: zig (`ziglang` on PyPI) for an old glibc and for macOS, and mingw for Windows. The tools are
//! installed in an environment in `target/python`.

pub mod addon;

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use clap::{Args, ValueEnum};
use harness::paths;
use xtask::setup;

/// Tools that build wheels, from PyPI.
const TOOLS: [&str; 3] = ["maturin>=1.9,<2", "ziglang", "cargo-zigbuild"];

/// Builds the Python package and the program pantin for Linux, Windows and macOS
#[derive(Args)]
pub struct Wheels {
    /// Systems to build for [default: all]
    systems: Vec<System>,
    /// Leaves the program out
    #[arg(long)]
    no_program: bool,
    /// Packs the Blender add-on, with the wheels that were built
    #[arg(long)]
    blender: bool,
    /// Where the files go
    #[arg(short, long, default_value = "target/wheels")]
    output: PathBuf,
}

/// What wheels are built for, on x86-64; for macOS also on Arm.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum System {
    /// glibc 2.17 or later (manylinux2014)
    Linux,
    /// Windows 10 or later
    Windows,
    /// macOS 11 or later on Apple's processors
    MacosArm,
    /// macOS 10.12 or later on Intel's processors
    MacosIntel,
}

impl Wheels {
    /// Builds all that was asked for, and prints the size of each file.
    pub fn run(self) -> Result<()> {
        let systems = if self.systems.is_empty() { System::value_variants() } else { &self.systems };
        let output = paths::root().join(&self.output);
        let tools = Tools::install()?;
        let mut wheels = vec![];
        for system in systems {
            let wheel = tools.wheel(*system, &output)?;
            said(&wheel)?;
            wheels.push(wheel);
            if !self.no_program {
                said(&tools.program(*system, &output)?)?;
            }
        }
        if self.blender { said(&addon::pack(&wheels, &output)?) } else { Ok(()) }
    }
}

fn said(file: &Path) -> Result<()> {
    println!("{:>9} bytes  {}", std::fs::metadata(file)?.len(), file.display());
    Ok(())
}

impl System {
    fn target(self) -> &'static str {
        match self {
            System::Linux => "x86_64-unknown-linux-gnu",
            System::Windows => "x86_64-pc-windows-gnu",
            System::MacosArm => "aarch64-apple-darwin",
            System::MacosIntel => "x86_64-apple-darwin",
        }
    }

    /// Whether zig links; mingw's own linker does for Windows.
    fn is_zig(self) -> bool {
        self != System::Windows
    }
}

/// The environment with the tools.
pub struct Tools(PathBuf);

impl Tools {
    /// Installs them where they are missing.
    pub fn install() -> Result<Tools> {
        let folder = target().join("tools");
        if !folder.join("bin/cargo-zigbuild").is_file() {
            environment("python3", &folder)?;
            pip(&folder, &TOOLS)?;
        }
        Ok(Tools(folder))
    }

    /// Builds the wheel into the folder `output`.
    pub fn wheel(&self, system: System, output: &Path) -> Result<PathBuf> {
        prepare(system)?;
        // A folder of its own, in which there is only one wheel.
        let built = target().join("wheel");
        if built.exists() {
            std::fs::remove_dir_all(&built)?;
        }
        let mut maturin = self.command("maturin");
        maturin.args(["build", "--release", "--locked", "--target", system.target(), "--target-dir"]).arg(target());
        maturin.arg("-o").arg(&built).arg("-m").arg(home().join("Cargo.toml"));
        if system.is_zig() {
            maturin.arg("--zig");
        }
        if system == System::Linux {
            maturin.args(["--compatibility", "manylinux2014"]);
        }
        run(maturin)?;
        let wheel = std::fs::read_dir(&built)?.next().context("maturin has built no wheel")??;
        std::fs::create_dir_all(output)?;
        let copy = output.join(wheel.file_name());
        std::fs::copy(wheel.path(), &copy)?;
        Ok(copy)
    }

    /// Packs the source into the folder `output`.
    pub fn sdist(&self, output: &Path) -> Result<()> {
        let mut maturin = self.command("maturin");
        maturin.args(["sdist", "-o"]).arg(output).arg("-m").arg(home().join("Cargo.toml"));
        run(maturin)
    }

    /// Builds the program `pantin` and copies it to the folder `output`, under a name with its system.
    fn program(&self, system: System, output: &Path) -> Result<PathBuf> {
        let target_name = system.target();
        let mut cargo = if system.is_zig() { self.command("cargo-zigbuild") } else { self.command("cargo") };
        // The oldest glibc of manylinux2014.
        let glibc = if system == System::Linux { ".2.17" } else { "" };
        cargo.arg(if system.is_zig() { "zigbuild" } else { "build" });
        cargo.args(["--release", "--locked", "-p", "pantin-tools", "--bin", "pantin", "--target"]);
        cargo.arg(format!("{target_name}{glibc}")).arg("--target-dir").arg(target()).current_dir(paths::root());
        run(cargo)?;
        let extension = if system == System::Windows { ".exe" } else { "" };
        let built = target().join(target_name).join("release").join(format!("pantin{extension}"));
        let copy = output.join(format!("pantin-{target_name}{extension}"));
        std::fs::copy(&built, &copy).with_context(|| built.display().to_string())?;
        Ok(copy)
    }

    fn command(&self, program: &str) -> Command {
        let bin = self.0.join("bin");
        let own = bin.join(program);
        let mut command = Command::new(if own.is_file() { own } else { program.into() });
        let path = std::env::var_os("PATH").unwrap_or_default();
        let all = [bin].into_iter().chain(std::env::split_paths(&path));
        command.env("PATH", std::env::join_paths(all).unwrap_or(path)).env("VIRTUAL_ENV", &self.0);
        command
    }
}

/// The folder of the package's source.
pub fn home() -> PathBuf {
    paths::root().join("bindings/python")
}

fn target() -> PathBuf {
    paths::root().join("target/python")
}

/// Adds what compiles and links for a system.
fn prepare(system: System) -> Result<()> {
    setup::rust_target(system.target())?;
    if system == System::Windows {
        setup::install_emulator("x86_64-w64-mingw32-gcc")?;
    }
    Ok(())
}

/// Makes a clean Python environment.
pub fn environment(python: &str, folder: &Path) -> Result<()> {
    let mut venv = Command::new(python);
    venv.args(["-m", "venv", "--clear"]).arg(folder);
    run(venv)
}

/// Installs packages in an environment.
pub fn pip(folder: &Path, packages: &[&str]) -> Result<()> {
    let mut pip = Command::new(folder.join("bin/python"));
    pip.args(["-m", "pip", "install", "-q", "--disable-pip-version-check"]).args(packages);
    run(pip)
}

/// Runs a program, with its messages on stderr.
pub fn run(mut command: Command) -> Result<()> {
    let name = command.get_program().to_string_lossy().into_owned();
    let status = command.status().with_context(|| format!("cannot start {name}"))?;
    ensure!(status.success(), "{name} failed");
    Ok(())
}
