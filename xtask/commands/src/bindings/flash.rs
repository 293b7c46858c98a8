//! Tables in program memory, as on an ESP8266: what the decoder does if they can be read by the functions for program memory alone, and what they take.

use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::{paths, vectors};
use tempfile::TempDir;

use super::{KEYS, SECTIONS, SOURCES, compare_records, compile, face, files, host_program, host_program_with, output};

/// Options of a program whose tables are taken away from where they are declared.
const MOVED: [&str; 4] = ["-DESP8266", "-Itests/flash", "tests/flash/flash.c", KEYS];

/// Most bytes of constants that stay in RAM on an ESP8266, texts included: 1 KB for all that the sources have.
const MOST_IN_RAM: u64 = 1024;

/// Plays the test vectors, and draws figures and faces.
pub fn moved(folder: &TempDir) -> Result<()> {
    compare_records(&host_program_with(folder, "gcc", "frames", &MOVED)?, &files()?)?;
    let walk = paths::root().join("motions/walk.ptn");
    let models = ["face", "small"].map(|name| paths::root().join("firmware/face").join(name).with_extension("model"));
    let quaternions = vectors::folder().join("own-quaternion.ptn");
    let cases: [(&str, Vec<PathBuf>); 5] = [
        ("figure", vec![walk.clone()]),
        ("figure", vec![quaternions.clone()]),
        ("solid", vec![walk, "-".into()]),
        ("solid", vec![quaternions, "-".into()]),
        ("face", [PathBuf::from("emotes")].into_iter().chain(models).collect()),
    ];
    for (name, arguments) in &cases {
        let printed = |program: PathBuf| {
            let mut command = Command::new(program);
            command.args(arguments);
            Ok::<_, anyhow::Error>(String::from_utf8(output(command)?.stdout)?)
        };
        let expected = printed(host_program(folder, "gcc", name)?)?;
        ensure!(expected.lines().count() > 20, "{name} prints little");
        face::same(name, &expected, &printed(host_program_with(folder, "gcc", name, &MOVED)?)?)?;
    }
    Ok(())
}

/// Builds the sources with the compiler of the ESP8266, and measures where their constants are.
pub fn sizes(folder: &TempDir) -> Result<()> {
    let mut compiler = Command::new("xtensa-lx106-elf-gcc");
    compiler.args(SECTIONS).args([
        "-std=c99",
        "-ffreestanding",
        "-DESP8266",
        "-isystem",
        "tests/include",
        "-isystem",
        "tests/flash",
    ]);
    compiler.args(["-r", "-nostdlib"]);
    let object = compile(compiler, &SOURCES, &folder.path().join("esp8266.elf"))?;
    let mut size = Command::new("xtensa-lx106-elf-size");
    size.arg("-A").arg(&object);
    let text = String::from_utf8(output(size)?.stdout)?;
    let of = |begins: &str| -> Result<u64> {
        let rows = text.lines().filter(|line| line.starts_with(begins));
        rows.map(|line| Ok(line.split_whitespace().nth(1).context("a size")?.parse::<u64>()?)).sum()
    };
    let (flash, ram) = (of(".irom")?, of(".rodata")? + of(".data")? + of(".bss")?);
    println!("   {flash} bytes of tables in program memory, {ram} bytes of other constants in RAM");
    ensure!(flash > 5000, "the tables are in program memory");
    ensure!(ram <= MOST_IN_RAM, "at most {MOST_IN_RAM} bytes of constants may be in RAM");
    Ok(())
}
