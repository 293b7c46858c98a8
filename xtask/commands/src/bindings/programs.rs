//! The programs that the page offers for a clip (`web/page/programs.js`), as written.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::{build, paths};
use serde_json::Value;
use tempfile::TempDir;
use xtask::setup;

use super::{home, micropython, output};

/// Prints the programs for walk.ptn as JSON: the header's path is the first argument.
const PROGRAMS: &str = r#"
    import { readFileSync } from "node:fs";
    const { programs } = await import(process.argv[1]);
    console.log(JSON.stringify(programs("walk", readFileSync(process.argv[2], "utf8"))));
"#;
/// What a browser's page finds at an address.
const FETCH: &str = r#"
    import { readFileSync } from "node:fs";
    globalThis.fetch = async (file) => new Response(readFileSync(file));
    await import(process.argv[1]);
"#;

/// Compiles and runs those in C, Rust, JavaScript and MicroPython for our walk: each prints a line or more for each frame.
pub fn run(folder: &TempDir) -> Result<()> {
    let place = folder.path().join("programs");
    std::fs::create_dir_all(place.join("src"))?;
    let clip = paths::root().join("motions/walk.ptn");
    std::fs::copy(&clip, place.join("walk.ptn"))?;
    std::fs::copy(&clip, place.join("src/walk.ptn"))?;
    let mut expand = Command::new(build::host_tool()?);
    expand.arg("expand").arg(&clip).arg("-o").arg(place.join("walk.h"));
    output(expand)?;
    let mut node = Command::new(setup::emulator("node")?);
    node.args(["--input-type=module", "--eval", PROGRAMS])
        .arg(paths::root().join("web/page/programs.js"))
        .arg(place.join("walk.h"));
    let programs: Vec<Value> = serde_json::from_slice(&output(node)?.stdout)?;
    let text = |language: &str| -> Result<&str> {
        let program = programs.iter().find(|program| program["language"] == language).context("no such program")?;
        program["text"].as_str().context("a program without a text")
    };
    let frames = pantin::Clip::new_checked(&std::fs::read(&clip)?)?.frames() as usize;
    let mut ran = vec![("C", c(&place, text("C")?)?), ("Rust", rust(&place, text("Rust")?)?)];
    ran.push(("JavaScript", javascript(&place, text("JavaScript")?)?));
    ran.extend(micropython::program(folder, &place, text("MicroPython")?)?.map(|printed| ("MicroPython", printed)));
    for (language, printed) in &ran {
        let lines = printed.lines().filter(|line| line.starts_with(|letter: char| letter.is_ascii_alphanumeric())).count();
        ensure!(lines >= frames, "{language}: {lines} lines for {frames} frames\n{printed}");
    }
    let names: Vec<_> = ran.iter().map(|(language, _)| *language).collect();
    println!("   {} frames each in {}", frames, names.join(", "));
    Ok(())
}

fn c(place: &Path, program: &str) -> Result<String> {
    std::fs::write(place.join("play.c"), program)?;
    let mut gcc = Command::new("gcc");
    gcc.current_dir(place).args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-I."]).arg("-I").arg(home().join("src"));
    output({
        gcc.arg("play.c").arg(home().join("src/pantin.c")).args(["-o", "play"]);
        gcc
    })?;
    printed(Command::new(place.join("play")))
}

fn rust(place: &Path, program: &str) -> Result<String> {
    let decoder = paths::root().join("decoder");
    let manifest = format!(
        "[package]\nname = \"play\"\nversion = \"0.0.0\"\nedition = \"2024\"\n[dependencies]\npantin = {{ path = {decoder:?} }}\n[workspace]\n"
    );
    std::fs::write(place.join("Cargo.toml"), manifest)?;
    std::fs::write(place.join("src/main.rs"), program)?;
    let mut cargo = Command::new("cargo");
    cargo.current_dir(place).args(["run", "--quiet", "--offline", "--target-dir", "target"]);
    printed(cargo)
}

fn javascript(place: &Path, program: &str) -> Result<String> {
    let packages = place.join("node_modules/@pantin");
    std::fs::create_dir_all(&packages)?;
    let mut copy = Command::new("cp");
    copy.arg("-r").arg(paths::root().join("web/packages/decoder")).arg(&packages);
    output(copy)?;
    std::fs::write(place.join("play.mjs"), program)?;
    let mut node = Command::new(setup::emulator("node")?);
    node.current_dir(place).args(["--input-type=module", "--eval", FETCH]).arg(place.join("play.mjs"));
    printed(node)
}

fn printed(command: Command) -> Result<String> {
    Ok(String::from_utf8_lossy(&output(command)?.stdout).into_owned())
}
