//! The widget for LVGL on LVGL's test display: `bindings/lvgl/tests/widget.c` and `body.c`.

mod speech;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::{Context, Result, ensure};
use harness::{build, paths};
use pantin_images::palette::Rgb;
use serde_json::Value;
pub use speech::speech;
use tempfile::TempDir;

use super::{SANITIZERS, SOURCES, output};

/// How LVGL's sources and programs for it are compiled.
pub struct Build<'a> {
    /// Names the folder of the objects.
    pub name: &'static str,
    /// The compilers for C and, where the sources in C++ are wanted, for C++.
    pub compilers: [Option<&'static str>; 2],
    /// Their options.
    pub options: &'static [&'static str],
    /// The folder of `lv_conf.h`, from `bindings/lvgl`.
    pub settings: &'a str,
}

/// For this machine.
pub(super) const HERE: Build = Build { name: "here", compilers: [Some("gcc"), None], options: &["-O1"], settings: "tests" };

/// Builds LVGL and the widget, and runs the tests.
pub fn run(folder: &TempDir) -> Result<()> {
    let convert = |motions: &[&str], name: &str| -> Result<PathBuf> {
        let made = folder.path().join(name);
        let mut tool = Command::new(build::host_tool()?);
        tool.current_dir(paths::root().join("motions")).arg("convert").args(motions).args(["--segments", "-o"]).arg(&made);
        output(tool)?;
        Ok(made)
    };
    let bank = convert(&["walk.keys", "run.keys"], "clips.ptb")?;
    let once = convert(&["library/bow.keys"], "once.ptn")?;
    let motions = paths::root().join("motions");
    let feet = motions.join("character.ptb");
    let files = [motions.join("walk.ptn"), bank, without_feet(folder, &feet)?, feet, once];
    for (name, lines, files) in [("widget", 4, &[][..]), ("body", 3, &files)] {
        let mut program = Command::new(program(&format!("tests/{name}.c"), &SANITIZERS)?);
        program.args(files);
        let printed = String::from_utf8(output(program)?.stdout)?;
        ensure!(printed.lines().count() == lines, "{printed}");
        printed.lines().for_each(|line| println!("   {line}"));
    }
    // Without bodies.
    let mut alone = Command::new("gcc");
    alone.args(["-std=gnu99", "-Wall", "-Wextra", "-Werror", "-DLV_CONF_INCLUDE_SIMPLE", "-DLV_PANTIN_WITHOUT_BODY", "-c"]);
    alone.current_dir(home()).args(["-Itests", "-Isrc", "-I../c/src", "-isystem"]).arg(sources()?);
    alone.args(["src/lv_pantin.c", "-o"]).arg(folder.path().join("alone.o"));
    output(alone).map(drop)
}

/// Our character without the table of feet.
fn without_feet(folder: &TempDir, character: &Path) -> Result<PathBuf> {
    let [text, bank] = ["sliding.toml", "sliding.ptb"].map(|name| folder.path().join(name));
    let own = std::fs::read_to_string(character.with_extension("toml"))?;
    let without =
        |line: &str| match line.split_once("sync = \"feet\"").map(|(before, after)| (before, after.split_once("frames"))) {
            Some((before, Some((_, frames)))) => format!("{before}start = \"in-step\", frames{frames}\n"),
            _ => format!("{line}\n"),
        };
    let sliding: String = own.lines().filter(|line| *line != "[feet]").map(without).collect();
    std::fs::write(&text, sliding)?;
    let mut machine = Command::new(build::host_tool()?);
    machine.arg("machine").arg(&text).arg("--bank").arg(character).arg("-o").arg(&bank);
    output(machine)?;
    Ok(bank)
}

/// Builds a test or an example in C, `tests/NAME.c`, or in C++, `NAME.cc`, with the widget, LVGL and all our sources for this machine. Paths begin in the
/// folder of the widget.
pub(super) fn program(source: &str, options: &[&str]) -> Result<PathBuf> {
    let (lvgl, library) = (sources()?, library(&HERE)?);
    let program = folder(&HERE)?.join(Path::new(source).file_stem().context("a source has a name")?);
    // No option can choose the standard of both languages. By default gcc compiles C++17, and C17.
    let (standard, libraries) =
        if source.ends_with(".cc") { (&[][..], &["-lm", "-lstdc++"][..]) } else { (&["-std=gnu99"][..], &["-lm"][..]) };
    let mut gcc = Command::new("gcc");
    gcc.current_dir(home()).args(standard).args(["-Wall", "-Wextra", "-Werror", "-DLV_CONF_INCLUDE_SIMPLE"]).args(options);
    gcc.args(["-Itests", "-Isrc", "-I../c/src", "-isystem"]).arg(&lvgl).arg(source);
    gcc.args(["src/lv_pantin.c", "src/lv_pantin_body.c"]).args(SOURCES.map(|source| Path::new("../c").join(source)));
    gcc.arg(&library).args(libraries).arg("-o").arg(&program);
    output(gcc)?;
    Ok(program)
}

/// The colours of pixels of RGB565, low byte first.
pub(super) fn colours(bytes: &[u8]) -> Vec<Rgb> {
    let colour = |pixel: &[u8]| {
        let raw = u16::from_le_bytes([pixel[0], pixel[1]]);
        let wide = |shift: u16, bits: u16| {
            let value = u32::from(raw >> shift & ((1 << bits) - 1));
            (value * 255 / ((1 << bits) - 1)) as u8
        };
        [wide(11, 5), wide(5, 6), wide(0, 5)]
    };
    bytes.chunks_exact(2).map(colour).collect()
}

/// The folder of the widget.
pub fn home() -> PathBuf {
    paths::root().join("bindings/lvgl")
}

/// Where objects of a build go.
pub fn folder(build: &Build) -> Result<PathBuf> {
    let folder = paths::root().join("target/lvgl").join(build.name);
    std::fs::create_dir_all(&folder)?;
    Ok(folder)
}

/// The folder of LVGL's sources, which cargo fetches with the crate that has them.
pub fn sources() -> Result<PathBuf> {
    let mut cargo = Command::new("cargo");
    cargo.current_dir(home().join("tests")).args(["metadata", "--locked", "--format-version", "1"]);
    let metadata: Value = serde_json::from_slice(&output(cargo)?.stdout)?;
    let packages = metadata["packages"].as_array().context("packages")?;
    let lvgl = packages.iter().find(|package| package["name"] == "lightvgl-sys").context("lightvgl-sys is a dependency")?;
    let manifest = Path::new(lvgl["manifest_path"].as_str().context("a manifest has a path")?);
    Ok(manifest.with_file_name("vendor").join("lvgl"))
}

/// Compiles LVGL to a library, unless this was done with the same settings.
pub fn library(build: &Build) -> Result<PathBuf> {
    let (lvgl, folder) = (sources()?, folder(build)?);
    let (library, settings) = (folder.join("liblvgl.a"), folder.join("settings"));
    let conf = home().join(build.settings).join("lv_conf.h");
    let wanted = format!("{}\n{:?}\n{}", lvgl.display(), build.options, std::fs::read_to_string(&conf)?);
    if library.exists() && std::fs::read_to_string(&settings).is_ok_and(|built| built == wanted) {
        return Ok(library);
    }
    let mut files = vec![];
    for (compiler, extension) in build.compilers.into_iter().zip(["c", "cpp"]) {
        files_of(&lvgl.join("src"), extension, compiler, &mut files)?;
    }
    ensure!(files.len() > 300, "LVGL has {} sources", files.len());
    println!("   compiling {} sources of LVGL", files.len());
    let objects: Vec<PathBuf> = (0..files.len()).map(|index| folder.join(format!("{index}.o"))).collect();
    each(&files, |index, (compiler, file)| {
        let mut command = Command::new(compiler);
        command
            .args(build.options)
            .args(["-w", "-DLV_CONF_INCLUDE_SIMPLE", "-I"])
            .arg(conf.with_file_name(""))
            .arg("-I")
            .arg(&lvgl);
        command.arg("-c").arg(file).arg("-o").arg(folder.join(format!("{index}.o")));
        output(command).map(drop)
    })?;
    let mut ar = Command::new("ar");
    ar.arg("rcs").arg(&library).args(&objects);
    let _ = std::fs::remove_file(&library);
    output(ar)?;
    std::fs::write(settings, wanted)?;
    Ok(library)
}

/// Runs a function for each of some things, on all processors. The first error ends it.
pub fn each<T: Sync>(things: &[T], run: impl Fn(usize, &T) -> Result<()> + Sync) -> Result<()> {
    let (next, failed) = (AtomicUsize::new(0), Mutex::new(None));
    let work = || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(thing) = things.get(index) else { return };
            if let Err(error) = run(index, thing) {
                *failed.lock().unwrap_or_else(|poisoned| poisoned.into_inner()) = Some(error);
                next.store(things.len(), Ordering::Relaxed);
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(work);
        }
    });
    failed.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner()).map_or(Ok(()), Err)
}

/// Lists the files with an extension below a folder, for a compiler.
pub fn files_of(
    folder: &Path,
    extension: &str,
    compiler: Option<&'static str>,
    files: &mut Vec<(&'static str, PathBuf)>,
) -> Result<()> {
    let Some(compiler) = compiler else { return Ok(()) };
    let mut entries: Vec<PathBuf> = std::fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<Result<_>>()?;
    entries.sort();
    for path in entries {
        if path.is_dir() {
            files_of(&path, extension, Some(compiler), files)?;
        } else if path.extension().is_some_and(|own| own == extension) {
            files.push((compiler, path));
        }
    }
    Ok(())
}
