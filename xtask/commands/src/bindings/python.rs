//! The Python package (`bindings/python`): its wheel in a clean environment.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::{build, paths};
use tempfile::TempDir;

use super::{licences, output, turns};
use crate::wheels::{self, System, Tools, home};

/// Versions of Python in which the README's program runs too, if they are installed.
const OTHERS: [&str; 5] = ["python3.9", "python3.10", "python3.12", "python3.13", "python3.14"];

/// What the test of `pantin.ray_convert` needs beside `pantin[ray]`: an S3 server and its client.
const CLUSTER: [&str; 5] = ["s3fs", "moto[s3]", "flask", "flask-cors", "psutil"];

/// Builds the wheel for Linux, installs it in a clean environment, and there runs its tests and the README's program as written.
pub fn run(folder: &TempDir) -> Result<()> {
    let place = folder.path().join("wheel");
    let wheel = Tools::install()?.wheel(System::Linux, &place)?;
    println!("   {} bytes: {}", std::fs::metadata(&wheel)?.len(), wheel.file_name().unwrap_or_default().display());
    licences::contains(&wheel, &licences::NAMES)?;
    licences::contains(&sdist(folder)?, &licences::NAMES)?;
    let environment = folder.path().join("clean");
    wheels::environment("python3", &environment)?;
    wheels::pip(&environment, &[&wheel.to_string_lossy()])?;
    readme(folder.path(), &environment)?;
    // Not before the README, which needs no more than the package.
    wheels::pip(&environment, &["pytest", "mypy"])?;
    // Where the package's source is not beside the tests.
    let tests = folder.path().join("tests-of-python");
    let mut copy = Command::new("cp");
    copy.arg("-r").arg(home().join("tests")).arg(&tests);
    output(copy)?;
    pytest(&environment, &tests, &[], turns::captured(folder)?.as_deref())?;
    let mut mypy = Command::new(environment.join("bin/python"));
    mypy.args(["-m", "mypy", "--strict", "-p", "pantin"]).current_dir(folder.path());
    output(mypy).context("types")?;
    cluster(&environment, &wheel, &tests)?;
    for python in OTHERS {
        other(python, &wheel, folder)?;
    }
    Ok(())
}

/// The package's source as an archive.
fn sdist(folder: &TempDir) -> Result<PathBuf> {
    let place = folder.path().join("sdist");
    Tools::install()?.sdist(&place)?;
    let archive = std::fs::read_dir(&place)?.next().context("maturin has packed nothing")??;
    Ok(archive.path())
}

/// Runs tests in an environment, and prints how many passed.
fn pytest(environment: &Path, tests: &Path, arguments: &[&str], captures: Option<&Path>) -> Result<()> {
    let mut pytest = Command::new(environment.join("bin/python"));
    pytest.args(["-m", "pytest", "-q", "-p", "no:cacheprovider"]).args(arguments).current_dir(tests);
    pytest.env("PANTIN_ROOT", paths::root()).env("PANTIN_TOOL", build::host_tool()?);
    pytest.envs(captures.map(|folder| ("PANTIN_TURNS", folder)));
    let printed = output(pytest)?.stdout;
    println!("   {}", String::from_utf8_lossy(&printed).trim_end().lines().last().unwrap_or_default());
    Ok(())
}

/// Runs the tests of `pantin.ray_convert` on a cluster of two nodes, if Ray has a package for this Python.
fn cluster(environment: &Path, wheel: &Path, tests: &Path) -> Result<()> {
    let package = format!("{}[ray]", wheel.display());
    let packages: Vec<&str> = std::iter::once(package.as_str()).chain(CLUSTER).collect();
    match wheels::pip(environment, &packages) {
        Ok(()) => pytest(environment, tests, &["test_cluster.py"], None).context("a cluster"),
        Err(error) => {
            println!("   cluster skipped: Ray cannot be installed: {error}");
            Ok(())
        }
    }
}

/// Runs the README's program.
fn readme(folder: &Path, environment: &Path) -> Result<()> {
    let readme = std::fs::read_to_string(home().join("README.md"))?;
    let code =
        readme.split("```python\n").nth(1).and_then(|rest| rest.split("```").next()).context("the README has a program")?;
    ensure!(readme.lines().take(14).any(|line| line == "```"), "the README's program is at its top");
    let place = folder.join("readme-of-python");
    std::fs::create_dir(&place)?;
    std::fs::write(place.join("readme.py"), code)?;
    let mut expand = Command::new(build::host_tool()?);
    expand.arg("expand").arg(paths::root().join("motions/walk.ptn")).arg("-o").arg(place.join("walk.bvh")).arg("-q");
    output(expand)?;
    let mut python = Command::new(environment.join("bin/python"));
    python.arg("readme.py").current_dir(&place);
    let printed = output(python)?.stdout;
    ensure!(printed.starts_with(b"<pantin.Clip: 160 frames"), "the README's program prints {}", printed.escape_ascii());
    Ok(())
}

/// Opens and converts with another version of Python, if it is installed.
fn other(python: &str, wheel: &Path, folder: &TempDir) -> Result<()> {
    let works = Command::new(python).arg("--version").output().is_ok_and(|output| output.status.success());
    if !works {
        println!("   {python} skipped: it is not installed");
        return Ok(());
    }
    let environment = folder.path().join(python);
    wheels::environment(python, &environment)?;
    wheels::pip(&environment, &[&wheel.to_string_lossy()])?;
    readme(&environment, &environment).context(python.to_owned())?;
    println!("   {python}: the README's program");
    Ok(())
}
