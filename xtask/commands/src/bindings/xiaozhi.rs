//! The display for the voice assistant xiaozhi-esp32 on LVGL's test display: `bindings/xiaozhi/tests/display.cc`.

use std::fs::File;
use std::io::BufWriter;
use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::paths;
use pantin_images::image::Image;
use tempfile::TempDir;

use super::{SANITIZERS, lvgl, output};

/// From the folder of the widget.
const PROGRAM: &str = "../xiaozhi/tests/display.cc";
const PARTS: [&str; 3] = ["-I../xiaozhi/src", "-I../xiaozhi/tests/stubs", "../xiaozhi/src/pantin_display.cc"];

/// Finds accesses of several tasks without order, which the other sanitizers do not.
const THREADS: [&str; 3] = ["-O1", "-g", "-fsanitize=thread"];

/// Width and height of a picture, and the pictures of a row of the sheet: 21 emotions and listening.
const SIZE: usize = 240;
const COLUMNS: usize = 6;
const PICTURES: usize = 22;

/// Runs the test with the sanitizers of memory, then with that of threads, and writes its pictures as a sheet, `target/lvgl/xiaozhi.png`. The README's
/// commands copy all files that a firmware needs.
pub fn run(folder: &TempDir) -> Result<()> {
    let pictures = folder.path().join("xiaozhi.rgb565");
    for sanitizers in [&SANITIZERS[..], &THREADS] {
        let mut program = Command::new(lvgl::program(PROGRAM, &[sanitizers, &PARTS].concat())?);
        program.arg(&pictures);
        let printed = String::from_utf8(output(program)?.stdout)?;
        ensure!(printed.lines().count() == 3, "{printed}");
        printed.lines().for_each(|line| println!("   {line}"));
    }
    sheet(&std::fs::read(pictures)?)?;
    copied(folder)
}

/// Runs the README's commands that copy files, and links the test with those files alone.
fn copied(folder: &TempDir) -> Result<()> {
    let home = paths::root().join("bindings/xiaozhi");
    let readme = std::fs::read_to_string(home.join("README.md"))?;
    let commands =
        readme.split("```sh\n").nth(1).and_then(|rest| rest.split("```").next()).context("the README copies no files")?;
    let mut shell = Command::new("sh");
    shell.current_dir(folder).env("PANTIN", paths::root()).args(["-e", "-c", commands]);
    output(shell)?;
    let copies = folder.path().join("main/pantin");
    let files: Vec<PathBuf> = std::fs::read_dir(&copies)?.map(|entry| Ok(entry?.path())).collect::<Result<_>>()?;
    let sources = files.iter().filter(|path| path.extension().is_some_and(|extension| extension == "c" || extension == "cc"));
    let mut gcc = Command::new("gcc");
    gcc.current_dir(&home)
        .args(["-Wall", "-Wextra", "-Werror", "-DLV_CONF_INCLUDE_SIMPLE", "-DLV_PANTIN_WITHOUT_BODY", "-I"])
        .arg(&copies);
    gcc.args(["-Itests/stubs", "-I../lvgl/tests", "-isystem"]).arg(lvgl::sources()?).args(sources).arg("tests/display.cc");
    gcc.arg(lvgl::library(&lvgl::HERE)?).args(["-lm", "-lstdc++", "-o"]).arg(folder.path().join("copied"));
    output(gcc).map(drop)
}

/// Writes RGB565 pictures as a sheet.
fn sheet(pictures: &[u8]) -> Result<()> {
    let pixels = lvgl::colours(pictures);
    let pictures = pixels.chunks_exact(SIZE * SIZE);
    ensure!(pictures.len() == PICTURES, "{} pictures", pictures.len());
    let mut sheet = Image::new(COLUMNS * SIZE, PICTURES.div_ceil(COLUMNS) * SIZE, [0; 3]);
    for (index, picture) in pictures.enumerate() {
        sheet.put(index % COLUMNS * SIZE, index / COLUMNS * SIZE, &Image::of(SIZE, picture.to_vec()));
    }
    let path = paths::root().join("target/lvgl/xiaozhi.png");
    sheet.write_png(BufWriter::new(File::create(&path)?))?;
    println!("   {PICTURES} pictures in {}", path.display());
    Ok(())
}
