//! The Arduino library that `cargo xtask arduino` writes: its examples, and what package managers read.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail, ensure};
use harness::vectors::own;
use harness::{build, paths};
use pantin_convert::export::source::{c_header, c_header_of_bank};
use serde_json::Value;
use tempfile::TempDir;

use super::{output, uno};
use crate::arduino;

/// Examples that fit the memory of an Arduino Uno with their libraries; the others are compiled for a Mega.
const UNO: [&str; 1] = ["Servos"];

/// Lines that the README's sketch prints before it is stopped.
const LINES: usize = 400;

/// The least frames that four servos show in a second of a clip of 120: when a clip starts again, one may be left out.
const FRAMES: u32 = 118;

/// Where Debian puts the Arduino core for AVR.
const CORE: &str = "/usr/share/arduino/hardware/arduino/avr";

/// The library's folder, which is written here for these tests.
fn home(folder: &TempDir) -> Result<PathBuf> {
    let home = folder.path().join("Pantin");
    if !home.exists() {
        arduino::write(&home)?;
    }
    Ok(home)
}

/// Compiles the examples and the README's sketches for AVR, with the Arduino core and declared display libraries.
pub fn examples(folder: &TempDir) -> Result<()> {
    if !Path::new(CORE).is_dir() {
        let mut install = Command::new("apt-get");
        install.args(["install", "-y", "--no-install-recommends", "arduino-core-avr"]);
        if output(install).is_err() {
            println!("   skipped: the Arduino core for AVR is not installed (Debian: arduino-core-avr)");
            return Ok(());
        }
    }
    let home = home(folder)?;
    let mut sketches = display_sketches(folder)?;
    sketches.push(readme_sketch(folder)?);
    for entry in std::fs::read_dir(home.join("examples"))? {
        let name = entry?.file_name();
        sketches.push(home.join("examples").join(&name).join(&name).with_extension("ino"));
    }
    for sketch in &sketches {
        let name = sketch.file_stem().unwrap_or_default().to_string_lossy();
        let uno = UNO.contains(&name.as_ref()) || name == "readme";
        let (mcu, variant) = if uno { ("atmega328p", "standard") } else { ("atmega2560", "mega") };
        let mut compiler = Command::new("avr-g++");
        compiler.args(["-std=gnu++11", "-Os", "-Wall", "-Werror", "-fno-exceptions", "-fno-threadsafe-statics"]);
        compiler.args(["-DF_CPU=16000000UL", "-DARDUINO=10819", "-DARDUINO_ARCH_AVR"]).arg(format!("-mmcu={mcu}"));
        for include in ["cores/arduino", &format!("variants/{variant}"), "libraries/Wire/src", "libraries/SPI/src"] {
            compiler.arg("-I").arg(Path::new(CORE).join(include));
        }
        compiler.arg("-I").arg(home.join("src")).arg("-I").arg(arduino::home().join("tests/include"));
        compiler.args(["-x", "c++", "-include", "Arduino.h", "-c"]).arg(sketch).arg("-o").arg(folder.path().join("sketch.o"));
        output(compiler).with_context(|| name.into_owned())?;
    }
    println!("   {} sketches", sketches.len());
    Ok(())
}

/// Runs `tests/library.cpp`: the classes on this machine, with sanitizers.
pub fn classes(folder: &TempDir) -> Result<()> {
    let place = folder.path();
    let clip = place.join("run.ptn");
    own::convert(&build::host_tool()?, &paths::root().join("motions/library/run.keys"), &clip, &[])?;
    let bytes = std::fs::read(&clip)?;
    std::fs::write(place.join("run.h"), c_header(&pantin::Clip::new_checked(&bytes)?, &bytes, "run")?)?;
    let hero = std::fs::read(paths::root().join("motions/character.ptb"))?;
    std::fs::write(place.join("hero.h"), c_header_of_bank(&pantin::Bank::new_checked(&hero)?, &hero, "hero")?)?;
    for (name, options) in [("classes", &[][..]), ("classes-esp8266", &["-DESP8266", "-Itests/flash"][..])] {
        let printed = classes_with(folder, name, options)?;
        ensure!(printed.lines().count() == 4, "{printed}");
        println!("   {name}");
        printed.lines().for_each(|line| println!("   {line}"));
    }
    Ok(())
}

/// Runs the classes as they are compiled with some options. As for an ESP8266, tables and clips are in program memory, as in `flash.rs`.
fn classes_with(folder: &TempDir, name: &str, options: &[&str]) -> Result<String> {
    let (place, program) = (folder.path(), folder.path().join(name));
    let mut objects = vec![];
    for source in super::SOURCES.into_iter().chain((!options.is_empty()).then_some("tests/flash/flash.c")) {
        let object = place.join(format!("{name}{}.o", objects.len()));
        let mut gcc = Command::new("gcc");
        gcc.arg("-std=c99").args(super::SANITIZERS).args(options);
        objects.push(super::compile(gcc, &[source], &object)?);
    }
    let mut compiler = Command::new("g++");
    compiler.current_dir(super::home()).args(["-std=c++11", "-Wall", "-Wextra", "-Werror"]).args(super::SANITIZERS).args(options);
    compiler.arg("-I").arg(place).arg("-Isrc").arg("-I").arg(arduino::home().join("src"));
    compiler.arg(arduino::home().join("tests/library.cpp")).args(objects).arg("-o").arg(&program);
    output(compiler)?;
    Ok(String::from_utf8(output(Command::new(&program))?.stdout)?)
}

/// Writes the README's sketch beside the header that it includes.
fn readme_sketch(folder: &TempDir) -> Result<PathBuf> {
    let home = home(folder)?;
    let readme = std::fs::read_to_string(home.join("README.md"))?;
    let sketch = readme.split("```cpp\n").nth(1).and_then(|rest| rest.split("```").next()).context("the README has a sketch")?;
    ensure!(readme.lines().take(10).any(|line| line == "```"), "the sketch ends within ten lines");
    let written = folder.path().join("readme.ino");
    std::fs::copy(home.join("examples/Servos/walk.h"), folder.path().join("walk.h"))?;
    std::fs::write(&written, sketch)?;
    Ok(written)
}

/// Writes the README's sketches of faces and characters, with the displays that they leave to the reader.
fn display_sketches(folder: &TempDir) -> Result<Vec<PathBuf>> {
    let home = home(folder)?;
    let readme = std::fs::read_to_string(home.join("README.md"))?;
    std::fs::copy(home.join("examples/SteerTFT/character.h"), folder.path().join("character.h"))?;
    let sketches = readme.split("```cpp\n").skip(2).filter_map(|rest| rest.split("```").next()).zip(1..);
    let write = |(sketch, number): (&str, usize)| {
        let written = folder.path().join(format!("readme-{number}.ino"));
        std::fs::write(&written, format!("#include <TFT_eSPI.h>\nTFT_eSPI display;\nTFT_eSprite sprite(&display);\n{sketch}"))?;
        Ok(written)
    };
    let written: Vec<PathBuf> = sketches.map(write).collect::<Result<_>>()?;
    ensure!(written.len() == 2, "the README has {} sketches for displays", written.len());
    Ok(written)
}

/// Sources of the Arduino core that a sketch with a serial port needs.
const CORE_SOURCES: [&str; 10] = [
    "main.cpp",
    "HardwareSerial.cpp",
    "HardwareSerial0.cpp",
    "Print.cpp",
    "Stream.cpp",
    "abi.cpp",
    "new.cpp",
    "wiring.c",
    "wiring_digital.c",
    "hooks.c",
];

/// Builds a sketch for an Arduino Uno, with the library, the core and further sources.
fn build(folder: &TempDir, sketch: &Path, further: &[PathBuf]) -> Result<PathBuf> {
    let (place, home) = (folder.path(), home(folder)?);
    let core = Path::new(CORE).join("cores/arduino");
    let sources = CORE_SOURCES.map(|name| core.join(name));
    let library = ["pantin.c", "pantin_turn.c", "pantin_figure.c"].map(|name| home.join("src").join(name));
    let mut objects = vec![];
    for source in sources.iter().chain(&library).chain(further).map(PathBuf::as_path).chain([sketch]) {
        let c = source.extension().is_some_and(|extension| extension == "c");
        let mut compiler = Command::new(if c { "avr-gcc" } else { "avr-g++" });
        compiler.args(["-Os", "-w", "-ffunction-sections", "-fdata-sections", "-mcall-prologues", "-mmcu=atmega328p"]);
        compiler.args(["-DF_CPU=16000000UL", "-DARDUINO=10819", "-DARDUINO_ARCH_AVR"]);
        for include in ["cores/arduino", "variants/standard", "libraries/Wire/src", "libraries/Wire/src/utility"] {
            compiler.arg("-I").arg(Path::new(CORE).join(include));
        }
        // A header of a clip that a test wrote hides the example's.
        compiler.arg("-I").arg(place).arg("-I").arg(home.join("src")).arg("-I").arg(arduino::home().join("tests/include"));
        if c {
            compiler.arg("-std=gnu11");
        } else {
            compiler.args(["-std=gnu++11", "-fno-exceptions", "-fno-threadsafe-statics", "-x", "c++", "-include", "Arduino.h"]);
        }
        let object = place.join(format!("uno{}.o", objects.len()));
        compiler.arg("-c").arg(source).arg("-o").arg(&object);
        output(compiler).with_context(|| source.display().to_string())?;
        objects.push(object);
    }
    let program = place.join("sketch.elf");
    let mut link = Command::new("avr-gcc");
    link.args(["-Os", "-mmcu=atmega328p", "-Wl,--gc-sections"]).args(&objects).arg("-lm").arg("-o").arg(&program);
    output(link)?;
    Ok(program)
}

/// Bytes of flash, and of RAM before the stack. An error if they do not fit an Uno.
fn sizes(program: &Path) -> Result<(u32, u32)> {
    let mut size = Command::new("avr-size");
    size.arg(program);
    let sizes = String::from_utf8(output(size)?.stdout)?;
    let sizes: Vec<u32> =
        sizes.lines().nth(1).unwrap_or_default().split_whitespace().filter_map(|number| number.parse().ok()).collect();
    let [text, data, bss, ..] = sizes[..] else { bail!("avr-size prints {sizes:?}") };
    ensure!(text + data < 32_256 && data + bss < 1_600, "flash and RAM: {sizes:?}");
    Ok((text + data, data + bss))
}

/// Runs the README's sketch on an emulated Arduino Uno: the angles that it prints are those of the clip's frames.
pub fn uno(folder: &TempDir) -> Result<()> {
    if !Path::new(CORE).is_dir() {
        println!("   skipped: the Arduino core for AVR is not installed");
        return Ok(());
    }
    let sketch = readme_sketch(folder)?;
    let program = build(folder, &sketch, &[])?;
    let (flash, ram) = sizes(&program)?;
    let angles = angles()?;
    let printed = uno::first_lines(LINES, &program)?;
    let lines: Vec<&String> = printed.iter().filter(|line| line.parse::<f64>().is_ok()).collect();
    ensure!(lines.len() > LINES / 2, "the sketch prints {printed:?}");
    for line in &lines {
        ensure!(angles.contains(line), "{line} is no angle of the clip");
    }
    println!("   {flash} bytes of flash, {ram} of RAM before the stack, {} angles", lines.len());
    Ok(())
}

/// Asks for joints and scalars that a clip lacks on an emulated Arduino Uno: each is an error, and nothing is changed.
pub fn missing(folder: &TempDir) -> Result<()> {
    if !Path::new(CORE).is_dir() {
        println!("   skipped: the Arduino core for AVR is not installed");
        return Ok(());
    }
    std::fs::copy(home(folder)?.join("examples/Face/hello.h"), folder.path().join("hello.h"))?;
    let printed = uno::all_lines(&build(folder, &arduino::home().join("tests/missing.ino"), &[])?)?;
    ensure!(printed.iter().any(|line| line == "done"), "{printed:?}");
    ensure!(!printed.iter().any(|line| line.starts_with("wrong")), "{printed:?}");
    Ok(())
}

/// Runs the example `Servos` on an emulated Arduino Uno, with a driver that takes as long as one by I2C at 400 kHz: with our walk, whose joints have Euler
/// angles, and with our dance, whose four joints have exponential maps.
pub fn servos(folder: &TempDir) -> Result<()> {
    if !Path::new(CORE).is_dir() {
        println!("   skipped: the Arduino core for AVR is not installed");
        return Ok(());
    }
    let place = folder.path();
    let dance = place.join("dance.ptn");
    // As many joints as fit the RAM.
    let drop = "neck,head,*shoulder,*forearm,*hand,*shin,*foot,*toes";
    let options =
        [&["--rotations", "exponential", "--max-joint-error", "1", "--fps", "120", "--to", "127"], &["--drop", drop][..]];
    let motions = paths::root().join("motions");
    own::convert(&build::host_tool()?, &motions.join("library/dance.keys"), &dance, &options.concat())?;
    let wire = Path::new(CORE).join("libraries/Wire/src");
    let further = [arduino::home().join("tests/servos.cpp"), wire.join("Wire.cpp"), wire.join("utility/twi.c")];
    for clip in [motions.join("walk.ptn"), dance] {
        let bytes = std::fs::read(&clip)?;
        // Beside the sketch the example's own header would be found first.
        let sketch = place.join("servos.ino");
        std::fs::copy(home(folder)?.join("examples/Servos/Servos.ino"), &sketch)?;
        std::fs::write(place.join("walk.h"), c_header(&pantin::Clip::new_checked(&bytes)?, &bytes, "walk")?)?;
        let program = self::build(folder, &sketch, &further)?;
        sizes(&program)?;
        let printed = uno::all_lines(&program)?;
        let frames: Vec<u32> = printed.iter().filter_map(|line| line.parse().ok()).collect();
        println!("   {}: {frames:?} frames in the seconds", clip.file_stem().unwrap_or_default().display());
        ensure!(frames.len() >= 4 && frames.iter().all(|&frames| frames >= FRAMES), "at least {FRAMES}: {printed:?}");
    }
    Ok(())
}

/// The angles of the joint that the sketch prints, at all frames, with two decimals.
fn angles() -> Result<Vec<String>> {
    let bytes = std::fs::read(paths::root().join("motions/walk.ptn"))?;
    let clip = pantin::Clip::new_checked(&bytes)?;
    let thigh = clip.find("left-thigh").context("the joint")?;
    let mut memory = pantin::Room::<64, 64>::new();
    let mut player = memory.player(clip)?;
    let mut angles = vec![];
    for frame in 0..player.clip().frames() {
        player.seek(frame);
        let [x, _, _] = player.turn(&thigh)?.euler(pantin::EulerOrder::XYZ);
        angles.push(format!("{:.2}", f64::from(x.centidegrees()) / 100.0));
    }
    Ok(angles)
}

/// What the Arduino IDE and PlatformIO read: the fields that they demand, and paths that exist.
pub fn metadata(folder: &TempDir) -> Result<()> {
    let home = home(folder)?;
    let read = |name: &str| std::fs::read_to_string(home.join(name)).with_context(|| name.to_owned());
    let properties = read("library.properties")?;
    let property = |key: &str| properties.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix('='));
    for key in
        ["name", "version", "author", "maintainer", "sentence", "paragraph", "category", "url", "architectures", "includes"]
    {
        ensure!(property(key).is_some_and(|value| !value.is_empty()), "library.properties lacks {key}");
    }
    ensure!(home.join("src").join(property("includes").unwrap_or_default()).is_file(), "the header of library.properties");
    ensure!(read("keywords.txt")?.lines().all(|line| line.split('\t').count() == 2), "keywords.txt has two columns");
    let library: Value = serde_json::from_str(&read("library.json")?)?;
    for key in ["name", "version"] {
        ensure!(library[key].as_str() == property(key), "{key} of library.json");
    }
    ensure!(home.join("src").join(library["headers"].as_str().unwrap_or_default()).is_file(), "the header of library.json");
    let Some(pio) = xtask::paths::program("pio") else {
        println!("   `pio pkg pack` skipped: PlatformIO is not installed (pip install platformio)");
        return Ok(());
    };
    // PlatformIO downloads the list of licences that it checks the field against: the copy has none.
    let (copy, packed, place) = (folder.path().join("copy"), folder.path().join("Pantin.tar.gz"), folder.path().join("Pantin"));
    let mut cp = Command::new("cp");
    cp.arg("-r").arg(&home).arg(&copy);
    output(cp)?;
    let mut library = library.as_object().context("library.json is an object")?.clone();
    library.remove("license");
    std::fs::write(copy.join("library.json"), serde_json::to_vec(&library)?)?;
    let mut pack = Command::new(pio);
    pack.args(["pkg", "pack"]).arg(&copy).arg("-o").arg(&packed);
    output(pack)?;
    std::fs::create_dir(&place)?;
    let mut tar = Command::new("tar");
    tar.arg("xzf").arg(packed).arg("-C").arg(&place);
    output(tar)?;
    for entry in std::fs::read_dir(home.join("src"))? {
        let name = entry?.file_name();
        let same = std::fs::read(place.join("src").join(&name))? == std::fs::read(home.join("src").join(&name))?;
        ensure!(same, "{} in the package", name.display());
    }
    ensure!(!place.join("tests").exists(), "tests are not in the package");
    Ok(())
}
