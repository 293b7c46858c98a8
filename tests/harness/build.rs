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
        Self::built(features, package, program, target, clips, Settings::default())
    }

    /// Builds a program that other people flash, whose pictures are turned by a number of degrees, or as the environment says. It has no log for debug probes, and holds no paths of this
    /// machine.
    pub fn released(features: &str, package: &str, program: &str, target: &str, clips: &[&Path], rotation: u16) -> Result<Self> {
        let turned = (rotation != 0).then(|| ("PANTIN_ROTATION".into(), rotation.to_string().into())).into_iter();
        let settings = Settings {
            environment: turned.collect(),
            arguments: ["--locked", "--no-default-features"].map(OsString::from).into(),
            flags: vec!["-Cstrip=debuginfo".into()],
            ..Settings::default()
        };
        Self::built(features, package, program, target, clips, settings)
    }

    /// Builds a board's program from a copy of the repository. Other people's crates are those of other builds.
    pub fn copied(root: &Path, package: &str, target: &str, clips: &[&Path]) -> Result<Self> {
        let environment = vec![("CARGO_TARGET_DIR".into(), target_folder().into())];
        let settings = Settings { workspace: Some(root.join("firmware")), environment, ..Settings::default() };
        Self::built("", package, package, target, clips, settings)
    }

    fn built(features: &str, package: &str, program: &str, target: &str, clips: &[&Path], settings: Settings) -> Result<Self> {
        // Builds of one program with different clips share cargo's output: nobody may build between build and copy.
        static TURN: Mutex<()> = Mutex::new(());
        let _turn = TURN.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        // Of another program that builds, too: builds with other features write the same file.
        let folder = target_folder();
        std::fs::create_dir_all(&folder)?;
        let turn = std::fs::File::create(folder.join("turn.lock"))?;
        turn.lock().context("cannot wait for other builds")?;
        setup::rust_target(target)?;
        let clips: Vec<PathBuf> = clips.iter().map(std::path::absolute).collect::<Result<_, _>>()?;
        let joined = std::env::join_paths(&clips).context("a clip's path holds what separates paths")?;
        let clip = (!clips.is_empty()).then(|| ("PANTIN_CLIP".into(), joined));
        let log = std::env::var_os("DEFMT_LOG").unwrap_or("info".into());
        let variables = [("DEFMT_LOG".into(), log), ("CARGO_ENCODED_RUSTFLAGS".into(), elsewhere()?)];
        let core = Core::of(target);
        let arguments =
            ["--release", "--package", package, "--bin", program, "--target", target, "--features", features].into_iter();
        let product = cargo(&Build {
            workspace: settings.workspace.unwrap_or_else(paths::firmware),
            arguments: arguments.map(OsString::from).chain(core.arguments).chain(settings.arguments).collect(),
            environment: clip.into_iter().chain(variables).chain(core.environment).chain(settings.environment).collect(),
            product: program.into(),
            flags: settings.flags,
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

fn target_folder() -> PathBuf {
    paths::firmware().join("target")
}

/// What one build of a program has besides the others.
#[derive(Default)]
struct Settings {
    /// The folder of another firmware workspace than the repository's.
    workspace: Option<PathBuf>,
    /// Arguments for cargo.
    arguments: Vec<OsString>,
    environment: Vec<(OsString, OsString)>,
    /// Flags of the compiler for the program alone.
    flags: Vec<OsString>,
}

/// Flags of the compiler, as cargo takes them, that replace this machine's paths. All builds have them: with others, each crate would be
/// compiled once more, and a program's size would depend on where the repository is.
fn elsewhere() -> Result<OsString> {
    let home = std::env::var_os("HOME").map(|home| PathBuf::from(home).join(".cargo"));
    let cargo = std::env::var_os("CARGO_HOME").map(PathBuf::from).or(home);
    let crates = cargo.map(|cargo| (cargo.join("registry/src"), "crates".into()));
    // Where Rust's own sources are installed, their paths are other ones than where they are not.
    let folders = crates.into_iter().chain([(paths::root(), "pantin".into()), rust_sources()?]);
    let flags: Vec<_> = folders.map(|(from, to)| format!("--remap-path-prefix={}={to}", from.display())).collect();
    Ok(flags.join("\x1f").into())
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
