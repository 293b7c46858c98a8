//! Builds programs with cargo: firmware for a target, the host tool, the plugin.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;

use anyhow::{Context, Result};
use tempfile::TempDir;

pub use xtask::build::{Build, cargo, host_tool};
use xtask::core_library::Core;

use crate::{paths, setup};

/// A firmware program, as a copy of its ELF file that a later build of the same program does not change.
pub struct Firmware {
    _directory: TempDir,
    elf: PathBuf,
}

impl Firmware {
    /// Builds a program of the firmware workspace for a Rust target with these clips embedded, or with its own clips if `clips` is empty.
    pub fn build(package: &str, program: &str, target: &str, clips: &[&Path]) -> Result<Self> {
        Self::featuring("", package, program, target, clips)
    }

    /// Builds a program with features of its package, separated by commas.
    pub fn featuring(features: &str, package: &str, program: &str, target: &str, clips: &[&Path]) -> Result<Self> {
        Self::built(features, package, program, target, clips, Default::default())
    }

    /// Builds a board's program with this bank as the character that buttons steer.
    pub fn steering(bank: &Path, package: &str, target: &str) -> Result<Self> {
        let variable = ("PANTIN_CHARACTER".into(), std::path::absolute(bank)?.into_os_string());
        Self::built("steer", package, package, target, &[], (vec![], vec![variable]))
    }

    /// Builds a program that other people flash. It has no log for debug probes and holds no paths of this machine.
    pub fn released(features: &str, package: &str, program: &str, target: &str, clips: &[&Path]) -> Result<Self> {
        // As a flag, not as a setting of the profile: macros and build scripts are those of other builds then.
        let mut flags = vec!["-Cstrip=debuginfo".to_owned()];
        let home = std::env::var_os("HOME").map(|home| PathBuf::from(home).join(".cargo"));
        let cargo = std::env::var_os("CARGO_HOME").map(PathBuf::from).or(home);
        let sources = cargo.map(|cargo| (cargo.join("registry/src"), "crates".into()));
        // Where Rust's own sources are installed, their paths are other ones than where they are not.
        for (from, to) in sources.into_iter().chain([(paths::root(), "pantin".into()), rust_sources()?]) {
            flags.push(format!("--remap-path-prefix={}={to}", from.display()));
        }
        let arguments = ["--locked", "--no-default-features"];
        let environment = [("CARGO_ENCODED_RUSTFLAGS", flags.join("\x1f").into())];
        let settings = (arguments.map(OsString::from).into(), environment.map(|(name, value)| (name.into(), value)).into());
        Self::built(features, package, program, target, clips, settings)
    }

    /// `settings` are further arguments for cargo, and variables.
    fn built(
        features: &str,
        package: &str,
        program: &str,
        target: &str,
        clips: &[&Path],
        settings: (Vec<OsString>, Vec<(OsString, OsString)>),
    ) -> Result<Self> {
        // Builds of one program with different clips share cargo's output: nobody may build between build and copy.
        static TURN: Mutex<()> = Mutex::new(());
        let _turn = TURN.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        // Of another program that builds, too: builds with other features write the same file.
        let folder = paths::firmware().join("target");
        std::fs::create_dir_all(&folder)?;
        let turn = std::fs::File::create(folder.join("turn.lock"))?;
        turn.lock().context("cannot wait for other builds")?;
        setup::rust_target(target)?;
        let clips: Vec<PathBuf> = clips.iter().map(std::path::absolute).collect::<Result<_, _>>()?;
        let joined = std::env::join_paths(&clips).context("a clip's path holds what separates paths")?;
        let clip = (!clips.is_empty()).then(|| ("PANTIN_CLIP".into(), joined));
        let log = std::env::var_os("DEFMT_LOG").unwrap_or("info".into());
        let core = Core::of(target);
        let arguments =
            ["--release", "--package", package, "--bin", program, "--target", target, "--features", features].into_iter();
        let product = cargo(&Build {
            workspace: paths::firmware(),
            arguments: arguments.map(OsString::from).chain(core.arguments).chain(settings.0).collect(),
            environment: clip.into_iter().chain([("DEFMT_LOG".into(), log)]).chain(core.environment).chain(settings.1).collect(),
            product: program.into(),
        })?;
        let directory = tempfile::Builder::new().prefix("pantin-elf-").tempdir().context("cannot make a temporary folder")?;
        let elf = directory.path().join(program);
        std::fs::copy(&product, &elf).with_context(|| format!("cannot copy {}", product.display()))?;
        Ok(Self { _directory: directory, elf })
    }

    /// Returns the ELF file's path. The file is deleted with this value.
    pub fn elf(&self) -> &Path {
        &self.elf
    }
}

/// The folder of Rust's own sources, and its name in programs on machines that have none.
fn rust_sources() -> Result<(PathBuf, String)> {
    let rustc = std::env::var_os("RUSTC").unwrap_or("rustc".into());
    let printed = |words: &[&str]| {
        let output = Command::new(&rustc).args(words).current_dir(paths::root()).output().context("cannot start rustc")?;
        anyhow::Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    };
    let version = printed(&["-vV"])?;
    let commit = version.lines().find_map(|line| line.strip_prefix("commit-hash: ")).context("rustc does not name its commit")?;
    let folder = Path::new(printed(&["--print", "sysroot"])?.trim()).join("lib/rustlib/src/rust");
    Ok((folder, format!("/rustc/{commit}")))
}
