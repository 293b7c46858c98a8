//! The Blender add-on (`bindings/blender`): packed, unpacked, and tested in Blender without a window.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::{build, paths};
use tempfile::TempDir;

use super::output;
use crate::wheels::{self, System, Tools, addon};

/// Packs the add-on with the wheel for Linux, and runs its tests with each Python that has Blender's module `bpy`.
pub fn run(folder: &TempDir, pythons: &[String]) -> Result<()> {
    let usual = ["python3".to_owned()];
    let asked = !pythons.is_empty();
    let mut tried = 0;
    for python in if asked { pythons } else { &usual } {
        let Some(libraries) = libraries(python) else {
            ensure!(!asked, "{python} has no bpy");
            println!("   {python} skipped: it has no bpy; pip install bpy numpy pytest, and --bpy names the Python");
            continue;
        };
        tried += 1;
        one(folder, python, &libraries, tried)?;
    }
    Ok(())
}

/// The folder of the libraries that come with a Python's `bpy`, which does not find all of them by itself.
fn libraries(python: &str) -> Option<PathBuf> {
    let find = "import importlib.util; print(importlib.util.find_spec('bpy').submodule_search_locations[0])";
    let found = Command::new(python).args(["-c", find]).output().ok().filter(|output| output.status.success())?;
    Some(Path::new(String::from_utf8_lossy(&found.stdout).trim()).join("lib"))
}

fn one(folder: &TempDir, python: &str, libraries: &Path, number: usize) -> Result<()> {
    let place = folder.path().join(format!("blender{number}"));
    let wheel = Tools::install()?.wheel(System::Linux, &place)?;
    let packed = addon::pack(&[wheel], &place)?;
    let (unpacked, tests) = (place.join("pantin_addon"), place.join("tests"));
    let mut unzip = Command::new(python);
    unzip.args(["-m", "zipfile", "-e"]).arg(&packed).arg(&unpacked);
    output(unzip)?;
    let mut copy = Command::new("cp");
    copy.arg("-r").arg(addon::home().join("tests")).arg(&tests);
    output(copy)?;
    // The wheel that the add-on brings, beside the tests: the environment stays as it is.
    let wheel = std::fs::read_dir(unpacked.join("wheels"))?.next().context("the add-on has no wheel")??.path();
    let mut pip = Command::new(python);
    pip.args(["-m", "pip", "install", "-q", "--disable-pip-version-check", "--no-deps", "--target"]).arg(&place).arg(wheel);
    wheels::run(pip)?;
    let mut pytest = Command::new(python);
    pytest.args(["-m", "pytest", "-q", "-p", "no:cacheprovider"]).arg(&tests).current_dir(&place);
    pytest
        .env("PYTHONPATH", &place)
        .env("LD_LIBRARY_PATH", libraries)
        .env("PANTIN_ROOT", paths::root())
        .env("PANTIN_TOOL", build::host_tool()?);
    let printed = output(pytest).with_context(|| python.to_owned())?.stdout;
    println!("   {}", String::from_utf8_lossy(&printed).trim_end().lines().last().unwrap_or_default());
    Ok(())
}
