//! The ESPHome component (`bindings/esphome`) as `cargo xtask esphome` writes it: its examples, wrong configurations, and ESPHome on this machine.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail, ensure};
use harness::paths;
use harness::vectors::keyed;
use tempfile::TempDir;

use super::{SANITIZERS, lvgl, output};
use crate::esphome::{home, write};
use crate::wheels;

/// The package with which the component is tested.
const PACKAGE: &str = "esphome==2026.6.5";

/// A configuration that is valid.
const RIGHT: &str = "\
esphome:
  name: wrong
  on_boot:
    - pantin.emote: happy
host:
external_components:
  - source:
      type: local
      path: components
display:
  - platform: memory
    id: panel
    width: 64
    height: 64
pantin:
  id: face
  width: 64
  height: 64
";

/// What is wrong with a configuration, the text that is replaced and by what, and a part of the error.
const WRONG: [(&str, &str, &str, &str); 14] = [
    ("an unknown emote", "emote: happy", "emote: hapy", "Unknown value 'hapy', did you mean 'happy'"),
    ("an unknown initial emote", "id: face", "emote: glad", "Unknown value 'glad', valid options are 'angry'"),
    (
        "no display",
        "display:\n  - platform: memory\n    id: panel\n    width: 64\n    height: 64\n",
        "",
        "Component pantin requires component display",
    ),
    ("a size of 0", "  width: 64\n  height: 64\n", "  width: 0\n  height: 64\n", "value must be at least 1"),
    ("a size above 2047", "  width: 64\n  height: 64\n", "  width: 64\n  height: 2048\n", "value must be at most 2047"),
    ("a clip that is not there", "id: face", "id: face\n  clips:\n    hello: none.ptn", "Could not find file"),
    ("a file that is no clip", "id: face", "id: face\n  clips:\n    hello: wrong.yaml", "wrong.yaml is not a clip"),
    ("a key clip", "id: face", "id: face\n  clips:\n    hello: keys.ptn", "convert its motion with --segments"),
    (
        "a clip that the face has not",
        "pantin.emote: happy",
        "pantin.play: hello",
        "the face has no clip 'hello'; under clips it has none",
    ),
    ("no height", "id: face\n  width: 64\n  height: 64\n", "id: face\n  width: 64\n", "'height' is a required option"),
    ("an id of the C library", "id: face", "id: pantin_face", "choose an id that does not start with pantin_"),
    (
        "a display with a lambda",
        "pantin:\n",
        "    lambda: it.fill(COLOR_ON);\npantin:\n  display_id: panel\n",
        "With display_id the face draws on this display itself",
    ),
    ("a widget without LVGL", "pantin:\n", "pantin:\n  widget: stage\n", "This option requires component lvgl"),
    (
        "two outputs",
        "pantin:\n",
        "lvgl:\n  displays: panel\n  widgets:\n    - obj:\n        id: stage\npantin:\n  display_id: panel\n  widget: stage\n",
        "Cannot specify more than one of '",
    ),
];

/// Checks the packed component with ESPHome from PyPI.
pub fn run(folder: &TempDir) -> Result<()> {
    let Some(environment) = environment() else { return Ok(()) };
    let place = folder.path().join("esphome");
    write(&place)?;
    let esphome = Esphome { environment, place };
    esphome.examples()?;
    esphome.add_tests()?;
    esphome.wrong()?;
    esphome.on_this_machine()
}

/// How ESPHome's loop waits: `esphome::internal::wakeable_delay(uint32_t)`.
const WAIT: &str = "_ZN7esphome8internal14wakeable_delayEj";

/// Where ESPHome and the pictures of the test are kept.
fn target() -> PathBuf {
    paths::root().join("target/esphome")
}

/// The Python environment with ESPHome, which is made once; none if it cannot be installed.
fn environment() -> Option<PathBuf> {
    let folder = target().join("python");
    let version = |folder: &Path| {
        let printed = Command::new(folder.join("bin/esphome")).arg("version").output().ok()?;
        String::from_utf8_lossy(&printed.stdout).trim().strip_prefix("Version: ").map(|version| format!("esphome=={version}"))
    };
    if version(&folder).as_deref() == Some(PACKAGE) {
        return Some(folder);
    }
    if let Err(error) = wheels::environment("python3", &folder).and_then(|()| wheels::pip(&folder, &[PACKAGE])) {
        println!("   skipped: {PACKAGE} cannot be installed from PyPI: {error:#}");
        return None;
    }
    Some(folder)
}

struct Esphome {
    environment: PathBuf,
    /// The packed component.
    place: PathBuf,
}

impl Esphome {
    /// `esphome` with these arguments, in the folder of the packed component.
    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(self.environment.join("bin/esphome"));
        command.current_dir(&self.place).args(arguments);
        command
    }

    /// The folder of the program that ESPHome generates of a configuration.
    fn generate(&self, file: &str, name: &str) -> Result<PathBuf> {
        output(self.command(&["compile", "--only-generate", file])).with_context(|| file.to_owned())?;
        let folder = self.place.join(file).with_file_name("").join(".esphome/build").join(name).join("src");
        ensure!(folder.join("main.cpp").is_file(), "{file} generates no program");
        Ok(folder)
    }

    /// Validates the examples, and generates their programs for an ESP32.
    fn examples(&self) -> Result<()> {
        let expected = [
            ("display", "face", "face->add_clip(\"hello\", "),
            ("voice-assistant", "talking-face", "face->set_display(panel, 0, 0, true);"),
        ];
        for (name, program, line) in expected {
            let file = format!("examples/{name}.yaml");
            output(self.command(&["config", &file])).with_context(|| file.clone())?;
            let source = self.generate(&file, program)?;
            ensure!(fs::read_to_string(source.join("main.cpp"))?.contains(line), "the program of {file} lacks {line}");
            let component = source.join("esphome/components/pantin");
            for name in ["face.cpp", "pantin.c", "pantin_face.c", "pantin_talk.c"] {
                ensure!(component.join(name).is_file(), "the program of {file} lacks {name}");
            }
            // A component that does not use the speaker does not need ESPHome's audio.
            ensure!(component.join("speaker/face_speaker.cpp").is_file() == (name == "voice-assistant"), "the speaker of {file}");
        }
        println!("   {} examples are valid, and their programs are generated", expected.len());
        Ok(())
    }

    /// Adds the display and the speaker in memory, which need the sources of ESPHome's audio.
    fn add_tests(&self) -> Result<()> {
        let mut copy = Command::new("cp");
        copy.arg("-r")
            .args(["host.yaml", "clock.cpp", "components"].map(|name| home().join("tests").join(name)))
            .arg(&self.place);
        output(copy)?;
        let motions = paths::root().join("motions");
        let mut damaged = fs::read(motions.join("face/hello.ptn"))?;
        damaged.truncate(60);
        fs::write(self.place.join("damaged.ptn"), damaged)?;
        for (from, to) in [
            (motions.join("face/hello.ptn"), "hello.ptn"),
            (motions.join("walk.ptn"), "walk.ptn"),
            (keyed::folder().join("walk.ptn"), "keys.ptn"),
        ] {
            fs::copy(from, self.place.join(to))?;
        }
        let mut find = Command::new(self.environment.join("bin/python"));
        find.args(["-c", "import esphome; print(esphome.__path__[0])"]);
        let package = String::from_utf8(output(find)?.stdout)?;
        for name in ["audio.h", "audio.cpp"] {
            let audio = Path::new("components/audio").join(name);
            fs::copy(Path::new(package.trim()).join(&audio), self.place.join(&audio)).with_context(|| name.to_owned())?;
        }
        Ok(())
    }

    /// Compares the errors of configurations that are wrong.
    fn wrong(&self) -> Result<()> {
        let config = |text: &str| -> Result<(bool, String)> {
            fs::write(self.place.join("wrong.yaml"), text)?;
            let printed = self.command(&["config", "wrong.yaml"]).output()?;
            Ok((printed.status.success(), String::from_utf8_lossy(&printed.stdout).into_owned()))
        };
        let (valid, printed) = config(RIGHT)?;
        ensure!(valid, "{printed}");
        for (what, from, to, error) in WRONG {
            let text = RIGHT.replacen(from, to, 1);
            ensure!(text != RIGHT, "{what}: the configuration has no {from:?}");
            let (valid, printed) = config(&text)?;
            ensure!(!valid && printed.contains(error), "{what}: ESPHome prints {printed}");
        }
        // The folder of the repository has no C sources.
        let source = |path: &Path| format!("  - source:\n      type: local\n      path: {}\n", path.display());
        let here = source(Path::new("components"));
        let unpacked = format!("{here}    components: [memory]\n{}", source(&home().join("components")));
        let (valid, printed) = config(&RIGHT.replace(&here, &unpacked))?;
        ensure!(!valid && printed.contains("use the folder that `cargo xtask esphome` writes"), "{printed}");
        println!("   {} wrong configurations are refused", WRONG.len() + 1);
        Ok(())
    }

    /// Compiles the program of `tests/host.yaml` with ESPHome's own sources, runs it, and checks what it prints.
    fn on_this_machine(&self) -> Result<()> {
        let source = self.generate("host.yaml", "host")?;
        let mut files = vec![];
        lvgl::files_of(&source, "cpp", Some("g++"), &mut files)?;
        lvgl::files_of(&source, "c", Some("gcc"), &mut files)?;
        ensure!(files.len() > 30, "the program has {} sources", files.len());
        // Its time is the test's.
        let clock = self.place.join("clock.cpp");
        let (_, hal) =
            files.iter_mut().find(|(_, file)| file.ends_with("host/hal.cpp")).context("ESPHome's hal.cpp is not there")?;
        *hal = clock;
        // ESPHome writes the settings of LVGL, and takes the version that is in cargo's registry.
        let settings = source.to_str().context("the folder's name is UTF-8")?;
        let lvgl = lvgl::library(&lvgl::Build { name: "esphome", compilers: [Some("gcc"), None], options: &["-O1"], settings })?;
        let headers = lvgl::sources()?;
        let objects: Vec<PathBuf> = (0..files.len()).map(|index| self.place.join(format!("{index}.o"))).collect();
        lvgl::each(&files, |index, (compiler, file)| {
            let mut command = Command::new(compiler);
            command.args(SANITIZERS).args(["-DUSE_HOST", "-DESPHOME_LOG_LEVEL=ESPHOME_LOG_LEVEL_INFO"]);
            command.arg("-DLV_CONF_INCLUDE_SIMPLE").arg("-isystem").arg(&headers).arg("-isystem").arg(headers.join("src"));
            let standard: &[&str] = if *compiler == "g++" { &["-std=gnu++20", "-fno-exceptions"] } else { &["-std=gnu17"] };
            // ESPHome's headers have unused parameters.
            let ours = file.components().any(|part| part.as_os_str() == "pantin");
            command.args(standard).args(if ours {
                &["-Wall", "-Wextra", "-Wno-unused-parameter", "-Werror"][..]
            } else {
                &["-w"]
            });
            command.arg("-I").arg(&source).arg("-c").arg(file).arg("-o").arg(&objects[index]);
            output(command).map(drop)
        })?;
        let program = self.place.join("host");
        let mut link = Command::new("g++");
        link.args(SANITIZERS)
            .args(&objects)
            .arg(&lvgl)
            .arg(format!("-Wl,--wrap={WAIT}"))
            .arg("-lpthread")
            .arg("-o")
            .arg(&program);
        output(link)?;
        let pictures = target().join("pictures");
        fs::create_dir_all(&pictures)?;
        let mut run = Command::new("timeout");
        run.arg("60").arg(&program).current_dir(&pictures);
        let printed = String::from_utf8(output(run)?.stdout)?;
        check(&printed).with_context(|| printed.clone())?;
        println!("   {} sources of ESPHome and the component; {}", files.len(), summary(&printed));
        Ok(())
    }
}

/// The numbers of a line that begins with `name:`.
fn numbers(printed: &str, name: &str) -> Result<Vec<i64>> {
    let line = printed.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(": "));
    let line = line.with_context(|| format!("no line {name}"))?;
    Ok(line.split(|c: char| !c.is_ascii_digit()).filter_map(|number| number.parse().ok()).collect())
}

/// Checks what the program of `tests/host.yaml` prints.
fn check(printed: &str) -> Result<()> {
    let in_range = |name: &str, index: usize, least: i64, most: i64| -> Result<()> {
        let number = *numbers(printed, name)?.get(index).with_context(|| format!("{name} has no number {index}"))?;
        ensure!((least..=most).contains(&number), "{name}: {number} is not {least} to {most}");
        Ok(())
    };
    // Lit pixels of the face, pixels unlike those of the C library, and lit pixels outside: around the widget of LVGL, all 4,000 of its white screen.
    for (name, outside) in [("lambda", 0), ("clipped", 0), ("direct", 0), ("lvgl", 4_000)] {
        in_range(name, 0, 200, 10_000)?;
        in_range(name, 1, 0, 0)?;
        in_range(name, 2, outside, outside)?;
    }
    in_range("oled", 0, 100, 2_000)?;
    // Of the 16,000 pixels around the mouth, those that another emote, an open mouth and speech change.
    in_range("happy", 0, 200, 8_000)?;
    in_range("unknown", 0, 0, 0)?;
    in_range("clip", 0, 100, 8_000)?;
    in_range("playing", 0, 0, 0)?;
    in_range("finished", 0, 1, 1)?;
    in_range("boot", 0, 1, 1)?;
    ensure!(numbers(printed, "refused")? == [0, 0, 0], "clips that do not play are refused");
    in_range("level", 0, 500, 8_000)?;
    in_range("closed", 0, 0, 50)?;
    in_range("lips", 0, 200, 8_000)?;
    // Of 32,768.
    in_range("waiting", 0, 0, 0)?;
    in_range("played", 0, 30_000, 32_768)?;
    in_range("played", 1, 16_000, 65_536)?;
    in_range("silence", 0, 0, 1_000)?;
    let [rows, bands] = numbers(printed, "sent")?[..] else { bail!("sent has two numbers") };
    // The first picture has 7 bands, and most of the 60 pictures or more that follow do not change all bands.
    ensure!((7..60 * 7).contains(&bands) && rows <= bands * 16, "{rows} rows in {bands} bands");
    Ok(())
}

/// What is worth printing of it.
fn summary(printed: &str) -> String {
    let lines =
        ["lambda", "direct", "lvgl", "lips"].map(|name| printed.lines().find(|line| line.starts_with(name)).unwrap_or_default());
    lines.join("; ")
}
