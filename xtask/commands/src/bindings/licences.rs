//! Licences in every folder that is copied, and in what is packed.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::paths;
use tempfile::TempDir;

use super::output;
use crate::wheels::addon;
use crate::{arduino, esp_idf, esphome, micropython};

/// The files.
pub const NAMES: [&str; 2] = ["LICENSE-MIT", "LICENSE-APACHE"];

/// The folders of `bindings` that are copied or packed.
pub const FOLDERS: [&str; 9] = ["c", "arduino", "esp-idf", "lvgl", "xiaozhi", "esphome", "micropython", "python", "blender"];

/// Looks into the folders, the Arduino library, the ESPHome component and the Blender add-on; the step of the wheel looks into that.
pub fn run(folder: &TempDir) -> Result<()> {
    for name in FOLDERS {
        check(&paths::root().join("bindings").join(name))?;
    }
    let library = folder.path().join("licences");
    arduino::write(&library)?;
    check(&library)?;
    for (name, write) in
        [("esphome", esphome::write as fn(&Path) -> Result<usize>), ("esp-idf", esp_idf::write), ("mp", micropython::write)]
    {
        let packed = folder.path().join(format!("licences-{name}"));
        write(&packed)?;
        check(&packed)?;
    }
    // What a wheel has inside makes no difference here.
    let wheel = folder.path().join("any.whl");
    std::fs::write(&wheel, "")?;
    contains(&addon::pack(&[wheel], folder.path())?, &NAMES)
}

/// An error unless the folder has the licences of the project.
pub fn check(folder: &Path) -> Result<()> {
    for name in NAMES {
        let here = std::fs::read(folder.join(name)).with_context(|| format!("{} has no {name}", folder.display()))?;
        ensure!(here == std::fs::read(paths::root().join(name))?, "{} in {} is another one", name, folder.display());
    }
    Ok(())
}

/// An error unless an archive has files with these names.
pub fn contains(archive: &Path, names: &[&str]) -> Result<()> {
    let mut python = Command::new("python3");
    let module = if archive.extension().is_some_and(|extension| extension == "gz") { "tarfile" } else { "zipfile" };
    python.args(["-m", module, "-l"]).arg(archive);
    let listed = String::from_utf8_lossy(&output(python)?.stdout).into_owned();
    let files: Vec<&str> = listed.lines().filter_map(|line| line.split_whitespace().next()).collect();
    for name in names {
        let found = files.iter().any(|file| file.rsplit('/').next() == Some(*name));
        ensure!(found, "{} has no {name}: {listed}", archive.display());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_that_are_copied_or_packed_have_the_licences() {
        for name in FOLDERS {
            check(&paths::root().join("bindings").join(name)).unwrap();
        }
    }
}
