//! The widget for LVGL on LVGL's test display: `bindings/lvgl/tests/widget.c`.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::{Context, Result, ensure};
use harness::paths;
use serde_json::Value;

use super::{SANITIZERS, SOURCES, output};

/// Builds LVGL and the widget, and runs the test.
pub fn run() -> Result<()> {
    let lvgl = sources()?;
    let folder = paths::root().join("target/lvgl");
    std::fs::create_dir_all(&folder)?;
    let library = library(&lvgl, &folder)?;
    let home = home();
    let program = folder.join("widget");
    let mut gcc = Command::new("gcc");
    gcc.current_dir(&home).args(["-std=gnu99", "-Wall", "-Wextra", "-Werror", "-DLV_CONF_INCLUDE_SIMPLE"]).args(SANITIZERS);
    gcc.args(["-Itests", "-Isrc", "-I../c/src", "-isystem"]).arg(&lvgl).args(["tests/widget.c", "src/lv_pantin.c"]);
    gcc.args(SOURCES.map(|source| Path::new("../c").join(source))).arg(&library).arg("-lm").arg("-o").arg(&program);
    output(gcc)?;
    let printed = String::from_utf8(output(Command::new(&program))?.stdout)?;
    ensure!(printed.lines().count() == 4, "{printed}");
    printed.lines().for_each(|line| println!("   {line}"));
    Ok(())
}

fn home() -> PathBuf {
    paths::root().join("bindings/lvgl")
}

/// The folder of LVGL's sources, which cargo fetches with the crate that has them.
fn sources() -> Result<PathBuf> {
    let mut cargo = Command::new("cargo");
    cargo.current_dir(home().join("tests")).args(["metadata", "--locked", "--format-version", "1"]);
    let metadata: Value = serde_json::from_slice(&output(cargo)?.stdout)?;
    let packages = metadata["packages"].as_array().context("packages")?;
    let lvgl = packages.iter().find(|package| package["name"] == "lightvgl-sys").context("lightvgl-sys is a dependency")?;
    let manifest = Path::new(lvgl["manifest_path"].as_str().context("a manifest has a path")?);
    Ok(manifest.with_file_name("vendor").join("lvgl"))
}

/// Compiles LVGL to a library, unless this was done with the same settings.
fn library(lvgl: &Path, folder: &Path) -> Result<PathBuf> {
    let (library, settings) = (folder.join("liblvgl.a"), folder.join("settings"));
    let wanted = format!("{}\n{}", lvgl.display(), std::fs::read_to_string(home().join("tests/lv_conf.h"))?);
    if library.exists() && std::fs::read_to_string(&settings).is_ok_and(|built| built == wanted) {
        return Ok(library);
    }
    let mut files = vec![];
    c_files(&lvgl.join("src"), &mut files)?;
    ensure!(files.len() > 300, "LVGL has {} sources", files.len());
    println!("   compiling {} sources of LVGL", files.len());
    let (next, failed) = (AtomicUsize::new(0), Mutex::new(None));
    let objects: Vec<PathBuf> = (0..files.len()).map(|index| folder.join(format!("{index}.o"))).collect();
    let work = || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let (Some(file), Some(object)) = (files.get(index), objects.get(index)) else { return };
            let mut gcc = Command::new("gcc");
            gcc.args(["-O1", "-w", "-DLV_CONF_INCLUDE_SIMPLE", "-I"]).arg(home().join("tests")).arg("-I").arg(lvgl);
            gcc.arg("-c").arg(file).arg("-o").arg(object);
            if let Err(error) = output(gcc) {
                *failed.lock().unwrap_or_else(|poisoned| poisoned.into_inner()) = Some(error);
                next.store(files.len(), Ordering::Relaxed);
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(work);
        }
    });
    if let Some(error) = failed.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner()) {
        return Err(error);
    }
    let mut ar = Command::new("ar");
    ar.arg("rcs").arg(&library).args(&objects);
    output(ar)?;
    std::fs::write(settings, wanted)?;
    Ok(library)
}

fn c_files(folder: &Path, files: &mut Vec<PathBuf>) -> Result<()> {
    let mut entries: Vec<PathBuf> = std::fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<Result<_>>()?;
    entries.sort();
    for path in entries {
        if path.is_dir() {
            c_files(&path, files)?;
        } else if path.extension().is_some_and(|extension| extension == "c") {
            files.push(path);
        }
    }
    Ok(())
}
