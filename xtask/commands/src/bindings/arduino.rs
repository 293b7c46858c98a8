//! The Arduino library (`bindings/arduino`): copies, examples, and what package managers read.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::paths;
use pantin_convert::export::source::c_header;
use serde_json::Value;
use tempfile::TempDir;

use super::output;

/// Files of the decoder in C that the library contains.
const COPIES: [&str; 8] = [
    "pantin.c",
    "pantin.h",
    "pantin_tables.h",
    "pantin_turn.c",
    "pantin_turn.h",
    "pantin_figure.c",
    "pantin_figure.h",
    "pantin_figure_tables.h",
];

/// Our motions, and the examples that contain their headers.
const HEADERS: [(&str, &[&str]); 2] =
    [("walk.ptn", &["OledAdafruit", "OledU8g2", "TftESPI", "Servos"]), ("face/hello.ptn", &["Face"])];

/// Examples that fit the memory of an Arduino Uno with their libraries; the others are compiled for a Mega.
const UNO: [&str; 1] = ["Servos"];

/// Where Debian puts the Arduino core for AVR.
const CORE: &str = "/usr/share/arduino/hardware/arduino/avr";

/// The folder of the library.
fn home() -> PathBuf {
    paths::root().join("bindings/arduino")
}

/// Compares a file with what it should contain, or writes it if PANTIN_UPDATE is set.
fn equals(path: &Path, expected: &[u8]) -> Result<()> {
    if std::env::var_os("PANTIN_UPDATE").is_some() {
        std::fs::write(path, expected)?;
    }
    let committed = std::fs::read(path).with_context(|| path.display().to_string())?;
    ensure!(committed == expected, "{} differs from its source: PANTIN_UPDATE=1 writes it", path.display());
    Ok(())
}

/// Sources are those of `bindings/c`, headers of clips those that `pantin expand` writes.
pub fn copies() -> Result<()> {
    for name in COPIES {
        equals(&home().join("src").join(name), &std::fs::read(super::home().join("src").join(name))?)?;
    }
    for (motion, examples) in HEADERS {
        let path = paths::root().join("motions").join(motion);
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let bytes = std::fs::read(&path)?;
        let header = c_header(&pantin::Clip::new_checked(&bytes)?, &bytes, &stem)?;
        for example in examples {
            equals(&home().join("examples").join(example).join(format!("{stem}.h")), header.as_bytes())?;
        }
    }
    Ok(())
}

/// Compiles the examples and the README's sketch for AVR, with the Arduino core and declared display libraries.
pub fn examples(folder: &TempDir) -> Result<()> {
    if !Path::new(CORE).is_dir() {
        let mut install = Command::new("apt-get");
        install.args(["install", "-y", "--no-install-recommends", "arduino-core-avr"]);
        if output(install).is_err() {
            println!("   skipped: the Arduino core for AVR is not installed (Debian: arduino-core-avr)");
            return Ok(());
        }
    }
    let readme = std::fs::read_to_string(home().join("README.md"))?;
    let sketch = readme.split("```cpp\n").nth(1).and_then(|rest| rest.split("```").next()).context("the README has a sketch")?;
    ensure!(readme.lines().take(10).any(|line| line == "```"), "the sketch ends within ten lines");
    std::fs::copy(home().join("examples/Servos/walk.h"), folder.path().join("walk.h"))?;
    let written = folder.path().join("readme.ino");
    std::fs::write(&written, sketch)?;
    let mut sketches = vec![written];
    for entry in std::fs::read_dir(home().join("examples"))? {
        let name = entry?.file_name();
        sketches.push(home().join("examples").join(&name).join(&name).with_extension("ino"));
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
        compiler.arg("-I").arg(home().join("src")).arg("-I").arg(home().join("tests/include"));
        compiler.args(["-x", "c++", "-include", "Arduino.h", "-c"]).arg(sketch).arg("-o").arg(folder.path().join("sketch.o"));
        output(compiler).with_context(|| name.into_owned())?;
    }
    println!("   {} sketches", sketches.len());
    Ok(())
}

/// Sources of the Arduino core that a sketch with a serial port needs.
const CORE_SOURCES: [&str; 9] = [
    "main.cpp",
    "HardwareSerial.cpp",
    "HardwareSerial0.cpp",
    "Print.cpp",
    "Stream.cpp",
    "abi.cpp",
    "new.cpp",
    "wiring.c",
    "hooks.c",
];

/// Runs the README's sketch on an emulated Arduino Uno: the angles that it prints are those of the clip's frames.
pub fn uno(folder: &TempDir) -> Result<()> {
    let place = folder.path();
    if !Path::new(CORE).is_dir() || !place.join("readme.ino").is_file() {
        println!("   skipped: the README's sketch was not compiled");
        return Ok(());
    }
    let core = Path::new(CORE).join("cores/arduino");
    let sources = CORE_SOURCES.map(|name| core.join(name));
    let library = ["pantin.c", "pantin_turn.c", "pantin_figure.c"].map(|name| home().join("src").join(name));
    let mut objects = vec![];
    for source in sources.into_iter().chain(library).chain([place.join("readme.ino")]) {
        let c = source.extension().is_some_and(|extension| extension == "c");
        let mut compiler = Command::new(if c { "avr-gcc" } else { "avr-g++" });
        compiler.args(["-Os", "-w", "-ffunction-sections", "-fdata-sections", "-mcall-prologues", "-mmcu=atmega328p"]);
        compiler.args(["-DF_CPU=16000000UL", "-DARDUINO=10819", "-DARDUINO_ARCH_AVR"]);
        compiler.arg("-I").arg(&core).arg("-I").arg(Path::new(CORE).join("variants/standard")).arg("-I").arg(home().join("src"));
        if c {
            compiler.arg("-std=gnu11");
        } else {
            compiler.args(["-std=gnu++11", "-fno-exceptions", "-fno-threadsafe-statics", "-x", "c++", "-include", "Arduino.h"]);
        }
        let object = place.join(format!("uno{}.o", objects.len()));
        compiler.arg("-c").arg(&source).arg("-o").arg(&object);
        output(compiler).with_context(|| source.display().to_string())?;
        objects.push(object);
    }
    let program = place.join("sketch.elf");
    let mut link = Command::new("avr-gcc");
    link.args(["-Os", "-mmcu=atmega328p", "-Wl,--gc-sections"]).args(&objects).arg("-lm").arg("-o").arg(&program);
    output(link)?;
    let mut size = Command::new("avr-size");
    size.arg(&program);
    let sizes = String::from_utf8(output(size)?.stdout)?;
    let sizes: Vec<u32> =
        sizes.lines().nth(1).unwrap_or_default().split_whitespace().filter_map(|number| number.parse().ok()).collect();
    ensure!(sizes.len() > 2 && sizes[0] + sizes[1] < 32_256 && sizes[1] + sizes[2] < 1_600, "flash and RAM: {sizes:?}");
    let angles = angles()?;
    // A sketch never ends.
    let mut simavr = Command::new("timeout");
    simavr.arg("10").arg(xtask::setup::emulator("simavr")?).args(["-m", "atmega328p", "-f", "16000000"]).arg(&program);
    let printed = simavr.output()?;
    let printed =
        String::from_utf8_lossy(&[printed.stdout, printed.stderr].concat()).replace("\x1b[32m", "").replace("\x1b[0m", "");
    // The emulator prints a point for each end of a line; the last line may be cut.
    let lines: Vec<&str> =
        printed.lines().map(|line| line.trim_end_matches('.')).filter(|line| line.parse::<f64>().is_ok()).collect();
    let lines = lines.get(..lines.len().saturating_sub(1)).unwrap_or_default();
    ensure!(lines.len() > 20, "the sketch prints {printed}");
    for line in lines {
        ensure!(angles.iter().any(|angle| angle == line), "{line} is no angle of the clip");
    }
    println!(
        "   {} bytes of flash, {} of RAM before the stack, {} angles",
        sizes[0] + sizes[1],
        sizes[1] + sizes[2],
        lines.len()
    );
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

/// What the Arduino IDE, PlatformIO and ESP-IDF read: the fields that they demand, and paths that exist.
pub fn metadata(folder: &TempDir) -> Result<()> {
    let read = |name: &str| std::fs::read_to_string(home().join(name)).with_context(|| name.to_owned());
    let properties = read("library.properties")?;
    let property = |key: &str| properties.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix('='));
    for key in
        ["name", "version", "author", "maintainer", "sentence", "paragraph", "category", "url", "architectures", "includes"]
    {
        ensure!(property(key).is_some_and(|value| !value.is_empty()), "library.properties lacks {key}");
    }
    ensure!(home().join("src").join(property("includes").unwrap_or_default()).is_file(), "the header of library.properties");
    ensure!(read("keywords.txt")?.lines().all(|line| line.split('\t').count() == 2), "keywords.txt has two columns");
    let library: Value = serde_json::from_str(&read("library.json")?)?;
    for key in ["name", "version"] {
        ensure!(library[key].as_str() == property(key), "{key} of library.json");
    }
    ensure!(home().join("src").join(library["headers"].as_str().unwrap_or_default()).is_file(), "the header of library.json");
    let version = format!("version: \"{}\"", property("version").unwrap_or_default());
    ensure!(read("idf_component.yml")?.lines().any(|line| line == version), "the version of idf_component.yml");
    let sources: Vec<String> = read("CMakeLists.txt")?.split('"').skip(1).step_by(2).map(str::to_owned).collect();
    ensure!(sources.len() == 4 && sources.iter().all(|path| home().join(path).exists()), "the paths of CMakeLists.txt");
    let Some(pio) = xtask::paths::program("pio") else {
        println!("   `pio pkg pack` skipped: PlatformIO is not installed (pip install platformio)");
        return Ok(());
    };
    // PlatformIO downloads the list of licences that it checks the field against: the copy has none.
    let (copy, packed, place) = (folder.path().join("copy"), folder.path().join("Pantin.tar.gz"), folder.path().join("Pantin"));
    let mut cp = Command::new("cp");
    cp.arg("-r").arg(home()).arg(&copy);
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
    for name in COPIES.into_iter().chain(["PantinPlayer.h"]) {
        ensure!(
            std::fs::read(place.join("src").join(name))? == std::fs::read(home().join("src").join(name))?,
            "{name} in the package"
        );
    }
    ensure!(!place.join("tests").exists(), "tests are not in the package");
    Ok(())
}
