//! The component for ESP-IDF (`bindings/esp-idf`) as `cargo xtask esp-idf` writes it: its examples on a display in memory, and other compilers. ESP-IDF itself
//! is not here: headers of its interface replace it.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::paths;
use pantin_images::image::Image;
use tempfile::TempDir;

use super::{SANITIZERS, WARNINGS, lvgl, output};
use crate::esp_idf::write;

/// The examples, the size of their displays, and how many pictures are compared: a face changes its emote after 120.
const EXAMPLES: [(&str, [u32; 2], u32); 2] = [("face_gc9a01", [240, 240], 300), ("body_cyd", [240, 320], 100)];

/// Compilers of processors that ESP-IDF is for, or are close to them: an ESP32-C3 has an RV32IMC, an ESP8266 the Xtensa LX106, an ESP32 the LX6.
const COMPILERS: [(&str, &[&str]); 2] = [
    ("riscv64-unknown-elf-gcc", &["-march=rv32imc", "-mabi=ilp32", "--specs=picolibc.specs"]),
    ("xtensa-lx106-elf-gcc", &["-ffreestanding", "-isystem", "tests/include"]),
];

fn home() -> PathBuf {
    paths::root().join("bindings/esp-idf")
}

/// The folder that the command writes, and what it is compiled with.
struct Component {
    place: PathBuf,
}

impl Component {
    /// A compiler in the folder of the decoder in C, whose tests have a `string.h` for a compiler without a library.
    fn compiler(&self, name: &str) -> Command {
        let mut command = Command::new(name);
        command.current_dir(super::home()).args(["-std=gnu17", "-Wconversion"]).args(&WARNINGS[..3]);
        for folder in ["src", "panel"] {
            command.arg("-I").arg(self.place.join(folder));
        }
        command.arg("-I").arg(home().join("tests/include"));
        command
    }

    fn example(&self, name: &str) -> PathBuf {
        self.place.join("examples").join(name).join("main/main.c")
    }

    /// Runs the examples: every row is sent once a frame, and not drawn into while it is sent. Their last pictures are in `target/esp-idf`.
    fn examples(&self) -> Result<()> {
        let pictures = paths::root().join("target/esp-idf");
        std::fs::create_dir_all(&pictures)?;
        for (name, [width, height], frames) in EXAMPLES {
            let program = self.place.join(name);
            let mut gcc = self.compiler("gcc");
            gcc.args(SANITIZERS).arg(self.example(name)).arg(home().join("tests/panel.c"));
            for source in
                ["panel/pantin_panel.c", "src/pantin.c", "src/pantin_face.c", "src/pantin_figure.c", "src/pantin_solid.c"]
            {
                gcc.arg(self.place.join(source));
            }
            gcc.arg("-o").arg(&program);
            output(gcc)?;
            let picture = pictures.join(name).with_extension("rgb565");
            let mut run = Command::new(&program);
            // The buffers of a program that never ends.
            run.env("ASAN_OPTIONS", "detect_leaks=0");
            run.args([width, height, frames].map(|number| number.to_string())).arg(&picture);
            print!("   {name}: {}", String::from_utf8(output(run)?.stdout)?);
            // The high byte of each pixel is first.
            let bytes: Vec<u8> = std::fs::read(&picture)?.chunks_exact(2).flat_map(|pixel| [pixel[1], pixel[0]]).collect();
            let image = Image::of(width as usize, lvgl::colours(&bytes));
            image.write_png(BufWriter::new(File::create(picture.with_extension("png"))?))?;
        }
        Ok(())
    }

    /// Compiles all sources and examples for other processors, and the widget for RISC-V, whose compiler has a library.
    fn compilers(&self, folder: &TempDir) -> Result<()> {
        let list = std::fs::read_to_string(self.place.join("CMakeLists.txt"))?;
        let sources: BTreeSet<&str> = list.split('"').skip(1).step_by(2).filter(|word| word.ends_with(".c")).collect();
        let object = folder.path().join("component.o");
        let readme = std::fs::read_to_string(self.place.join("README.md"))?;
        let program =
            readme.split("```c\n").nth(1).and_then(|rest| rest.split("```").next()).context("the README has a program")?;
        let of_page = folder.path().join("readme.c");
        std::fs::write(&of_page, program)?;
        for (name, options) in COMPILERS {
            let compile = |sources: &Path, more: &[&str]| {
                let mut gcc = self.compiler(name);
                gcc.args(["-Os", "-DPANTIN_KEYS"]).args(options).args(more).arg("-c").arg(sources).arg("-o").arg(&object);
                output(gcc).with_context(|| sources.display().to_string())
            };
            for source in sources.iter().filter(|source| !source.starts_with("lvgl")) {
                compile(&self.place.join(source), &[])?;
            }
            for (example, ..) in EXAMPLES {
                compile(&self.example(example), &[])?;
            }
            compile(&self.example("body_cyd"), &["-DCONFIG_CYD_ST7789"])?;
            compile(&of_page, &[])?;
            for format in ["-DCONFIG_PANTIN_FORMAT_L8", "-DCONFIG_PANTIN_FORMAT_RGB565"] {
                compile(&self.place.join("panel/pantin_panel.c"), &[format])?;
            }
            println!("   {name}: {} sources, the examples and the README's program", sources.len());
        }
        let widget = sources.iter().filter(|source| source.starts_with("lvgl"));
        for source in widget {
            let mut gcc = self.compiler(COMPILERS[0].0);
            gcc.args(COMPILERS[0].1).args(["-Os", "-Wno-conversion", "-DLV_CONF_INCLUDE_SIMPLE", "-DLV_PANTIN_BODY=1"]);
            gcc.arg("-I").arg(paths::root().join("bindings/lvgl/tests")).arg("-isystem").arg(lvgl::sources()?);
            gcc.arg("-c").arg(self.place.join(source)).arg("-o").arg(&object);
            output(gcc).with_context(|| (*source).to_owned())?;
        }
        println!("   {}: the widget for LVGL", COMPILERS[0].0);
        Ok(())
    }

    /// Every option that the build or the code asks for is one of Kconfig, and the manifest is of this version.
    fn metadata(&self) -> Result<()> {
        let read = |name: &str| std::fs::read_to_string(self.place.join(name)).with_context(|| name.to_owned());
        let kconfig = read("Kconfig")?;
        let options: BTreeSet<&str> = kconfig
            .lines()
            .filter_map(|line| line.trim().strip_prefix("config ").or(line.trim().strip_prefix("choice ")))
            .collect();
        for file in ["CMakeLists.txt", "panel/pantin_panel.c", "panel/pantin_panel.h"] {
            let text = read(file)?;
            let used =
                text.split("CONFIG_").skip(1).map(|rest| rest.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').next());
            for option in used.flatten() {
                ensure!(options.contains(option), "{file} asks for {option}, which Kconfig lacks");
            }
        }
        let properties = std::fs::read_to_string(paths::root().join("bindings/arduino/library.properties"))?;
        let version = properties.lines().find_map(|line| line.strip_prefix("version=")).context("the version")?;
        ensure!(read("idf_component.yml")?.lines().any(|line| line == format!("version: \"{version}\"")), "the version");
        for (example, ..) in EXAMPLES {
            ensure!(read("idf_component.yml")?.contains(&format!("- path: examples/{example}")), "{example} is listed");
        }
        Ok(())
    }
}

/// Checks the packed component.
pub fn run(folder: &TempDir) -> Result<()> {
    let component = Component { place: folder.path().join("components/pantin") };
    write(&component.place)?;
    component.metadata()?;
    component.examples()?;
    component.compilers(folder)
}
