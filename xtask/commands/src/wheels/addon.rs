//! The Blender add-on as a file to install: its source, the wheels of the Python package, and a manifest that lists them.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::paths;

use super::run;

/// The folder of the add-on's source.
pub fn home() -> PathBuf {
    paths::root().join("bindings/blender")
}

/// Packs the add-on with these wheels into the folder `output`.
pub fn pack(wheels: &[PathBuf], output: &Path) -> Result<PathBuf> {
    let staged = tempfile::tempdir()?;
    let inside = staged.path().join("wheels");
    std::fs::create_dir(&inside)?;
    let mut listed = vec![];
    for wheel in wheels {
        let name = wheel.file_name().context("a wheel has a name")?;
        std::fs::copy(wheel, inside.join(name))?;
        listed.push(format!("\"./wheels/{}\"", name.to_string_lossy()));
    }
    let mut names = vec!["wheels".to_owned()];
    for entry in std::fs::read_dir(home())? {
        let path = entry?.path();
        if path.is_file() {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            std::fs::copy(&path, staged.path().join(&name))?;
            names.push(name);
        }
    }
    names.sort();
    let manifest = staged.path().join("blender_manifest.toml");
    let text = std::fs::read_to_string(&manifest)?;
    let with_wheels = text.replace("\nwheels = []\n", &format!("\nwheels = [{}]\n", listed.join(", ")));
    ensure!(with_wheels != text, "the manifest has no empty list of wheels");
    std::fs::write(&manifest, with_wheels)?;
    let version = text.lines().find_map(|line| line.strip_prefix("version = ")).context("the manifest has no version")?;
    let packed = output.join(format!("pantin-blender-{}.zip", version.trim_matches('"')));
    let mut zip = Command::new("python3");
    zip.args(["-m", "zipfile", "-c"]).arg(&packed).args(&names).current_dir(staged.path());
    run(zip)?;
    Ok(packed)
}
