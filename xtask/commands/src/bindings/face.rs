//! Faces in C: pixels of the crate pantin-face, as `bindings/c/tests/face.c` draws them.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::paths;
use harness::vectors::{self, faces};
use pantin_face::EMOTES;
use tempfile::TempDir;

use super::{KEYS, compile, host_program, host_program_with, output};

/// Bytes of code that faces may take, without the decoder.
pub const MOST_CODE: u64 = 20 * 1024;

/// Bytes of RAM that the cartoon and the wireframe face may take on a 32-bit processor, player included.
const MOST_RAM: [u64; 2] = [3 * 1024, 5 * 1024];

/// Pictures of each model with weights that no clip contains, and damaged models.
const PICTURES: u32 = 100;
const MUTANTS: u32 = 2000;

/// The models of the crate.
const MODELS: [&str; 5] = ["cartoon", "eyes", "minimal", "small", "face"];

fn model(name: &str) -> PathBuf {
    paths::root().join("firmware/face").join(name).with_extension("model")
}

/// Compares the pictures of all emotes at every frame with those of the crate and with the committed checksums, then those of strange weights and of
/// damaged models.
pub fn pictures(folder: &TempDir) -> Result<()> {
    let mut expected = String::new();
    for shot in faces::SHOTS {
        let ([width, height], [orbit, tilt]) = (shot.1, shot.2);
        expected += &format!("{} {width}x{height} {orbit} {tilt}\n", shot.0);
        for (name, clip) in EMOTES {
            expected += &format!("{name}\n");
            faces::frames(shot, clip)?.iter().for_each(|frame| expected += &format!("{frame:08x}\n"));
        }
    }
    let golden = std::fs::read_to_string(vectors::folder().join(faces::NAME))?;
    for compiler in ["gcc", "clang"] {
        let program = host_program(folder, compiler, "face")?;
        let run = |arguments: &[&str], models: &[PathBuf], rest: &[String]| {
            let mut command = Command::new(&program);
            command.args(arguments).args(models).args(rest);
            Ok::<_, anyhow::Error>(String::from_utf8(output(command)?.stdout)?)
        };
        let both = [model("face"), model("small")];
        same("every frame", &expected, &run(&["frames"], &both, &[])?)?;
        same(faces::NAME, &golden, &run(&["emotes"], &both, &[])?)?;
        for name in MODELS {
            let (path, bytes) = (model(name), std::fs::read(model(name))?);
            for ([width, height], [orbit, tilt]) in [([128, 64], [0, 0]), ([240, 240], [0, 0]), ([171, 113], [30, -20])] {
                let numbers = [width, height].map(|x: u16| x.to_string()).into_iter();
                let numbers: Vec<String> =
                    numbers.chain([orbit, tilt].map(|x: i16| x.to_string())).chain([PICTURES.to_string()]).collect();
                let rust = faces::chaos(&bytes, [width, height], [orbit, tilt], PICTURES)?;
                same(name, &rust, &run(&["chaos"], std::slice::from_ref(&path), &numbers)?)?;
            }
            let rust = faces::mutants(&bytes, MUTANTS)?;
            same("damaged models", &rust, &run(&["mutants"], &[path], &[MUTANTS.to_string()])?)?;
        }
    }
    println!(
        "   {} frames, {} damaged models",
        expected.lines().filter(|line| line.len() == 8).count(),
        MODELS.len() as u32 * MUTANTS
    );
    Ok(())
}

/// An error that names the first line that differs.
pub fn same(what: &str, rust: &str, c: &str) -> Result<()> {
    let differs = rust.lines().zip(c.lines()).position(|(rust, c)| rust != c);
    if let Some(at) = differs {
        let [rust, c] = [rust, c].map(|text| text.lines().nth(at).unwrap_or_default());
        anyhow::bail!("{what}: line {at} is \"{rust}\" in Rust and \"{c}\" in C");
    }
    ensure!(rust.len() == c.len(), "{what}: {} bytes in Rust, {} in C", rust.len(), c.len());
    Ok(())
}

/// Runs the program that tests errors, transitions, eyes and divisions into rows.
pub fn rules(folder: &TempDir) -> Result<()> {
    for compiler in ["gcc", "clang"] {
        let mut command = Command::new(host_program_with(folder, compiler, "face_rules", &[KEYS])?);
        command.arg(model("face")).arg(vectors::keyed::folder().join("emotes-loving.ptn"));
        output(command)?;
    }
    Ok(())
}

/// Bytes of the structure and of the memory for each model and our emotes, on a Cortex-M0.
pub fn memory(folder: &TempDir) -> Result<()> {
    let mut command = Command::new("arm-none-eabi-gcc");
    command.args(["-std=c99", "-mcpu=cortex-m0", "-mthumb"]);
    let object = compile(command, &["tests/face_memory.c"], &folder.path().join("memory.o"))?;
    let sizes = MOST_RAM.iter().zip(["cartoon", "wireframe"]);
    for (most, name) in sizes {
        let bytes = size_of(&object, "face")? + size_of(&object, name)?;
        println!("   {bytes} bytes of RAM for the {name} face");
        ensure!((1000..=*most).contains(&bytes), "{name}: at most {most} bytes are allowed");
    }
    Ok(())
}

/// The size of a variable.
fn size_of(object: &Path, name: &str) -> Result<u64> {
    let mut nm = Command::new("arm-none-eabi-nm");
    nm.arg("-S").arg(object);
    let text = String::from_utf8(output(nm)?.stdout)?;
    let line = text.lines().find(|line| line.ends_with(&format!(" {name}"))).with_context(|| format!("no variable {name}"))?;
    let size = line.split_whitespace().nth(1).context("a variable has a size")?;
    Ok(u64::from_str_radix(size, 16)?)
}
