//! `cargo xtask bindings [--mutants N]`: tests of the decoder in C, the Arduino library, the ESPHome component, the decoder in MicroPython and the
//! Python package (`bindings`), which need compilers for other targets.

mod animator;
mod arduino;
mod blender;
mod esp_idf;
mod esphome;
mod face;
mod figure;
mod flash;
mod licences;
pub mod lvgl;
mod micropython;
mod programs;
mod python;
mod readme;
mod solid;
mod talk;
mod turns;
mod tutorial;
mod uno;
mod xiaozhi;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use anyhow::{Context, Result, bail, ensure};
use clap::Args;
use harness::differential::{self, Decoder};
use harness::{paths, vectors};
use serde_json::Value;
use tempfile::TempDir;
use xtask::setup;
use xtask::steps::Steps;

/// The decoder, key clips, rotations, figures, solid ones, faces, lips for speech, the animator, and feet.
pub const SOURCES: [&str; 9] = [
    "src/pantin.c",
    "src/pantin_keys.c",
    "src/pantin_turn.c",
    "src/pantin_figure.c",
    "src/pantin_solid.c",
    "src/pantin_face.c",
    "src/pantin_talk.c",
    "src/pantin_animator.c",
    "src/pantin_feet.c",
];
/// Defined where key clips are to be played.
const KEYS: &str = "-DPANTIN_KEYS";

/// Every warning is an error.
const WARNINGS: [&str; 4] = ["-Wall", "-Wextra", "-Werror", "-pedantic"];
const SANITIZERS: [&str; 4] = ["-O1", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"];
/// Options by which unused functions can be left out of an image.
const SECTIONS: [&str; 3] = ["-Os", "-ffunction-sections", "-fdata-sections"];

/// Compilers for small machines: their options, and the most bytes of code of the slice decoder and of the whole decoder without tables.
const TARGETS: [Target; 3] = [
    Target {
        compiler: "arm-none-eabi-gcc",
        options: &["-mcpu=cortex-m0", "-mthumb"],
        limits: Some([6 * 1024, 10 * 1024]),
        figures: Some(10 * 1024),
    },
    Target {
        compiler: "avr-gcc",
        options: &["-mmcu=atmega328p", "-mcall-prologues"],
        limits: Some([12 * 1024, 16 * 1024]),
        figures: Some(21 * 1024),
    },
    Target {
        compiler: "riscv64-unknown-elf-gcc",
        options: &["-march=rv32imc", "-mabi=ilp32", "--specs=picolibc.specs"],
        limits: None,
        figures: None,
    },
];

/// Functions of banks and streams, which the slice decoder does not need.
const EXTRAS: [&str; 17] = [
    "pantin_byte",
    "pantin_find_event",
    "pantin_find_section",
    "pantin_keep_starts",
    "pantin_open_bank",
    "pantin_first_entry",
    "pantin_next_entry",
    "next_entry",
    "pantin_open_entry",
    "pantin_open_named",
    "pantin_open_stream",
    "pantin_push",
    "load_stream",
    "advance",
    "pantin_paged",
    "load_page",
    "pantin_read_progmem",
];

/// Emulated boards that play the test vectors; files and output go through semihosting.
const BOARDS: [Board; 3] = [
    Board {
        name: "a Cortex-M3",
        compiler: "arm-none-eabi-gcc",
        options: &["-mcpu=cortex-m3", "-mthumb", "--specs=rdimon.specs", "-T", "tests/mps2.ld"],
        emulator: "qemu-system-arm",
        machine: &["-M", "mps2-an385"],
    },
    Board {
        name: "a Cortex-M3, code for a Cortex-M0",
        compiler: "arm-none-eabi-gcc",
        options: &["-mcpu=cortex-m0", "-mthumb", "--specs=rdimon.specs", "-T", "tests/mps2.ld"],
        emulator: "qemu-system-arm",
        machine: &["-M", "mps2-an385"],
    },
    Board {
        name: "RISC-V",
        compiler: "riscv64-unknown-elf-gcc",
        options: &[
            "-march=rv32imac",
            "-mabi=ilp32",
            "--specs=picolibc.specs",
            "--oslib=semihost",
            "--crt0=semihost",
            "-Wl,--defsym=__flash=0x80000000",
            "-Wl,--defsym=__flash_size=0x200000",
            "-Wl,--defsym=__ram=0x80200000",
            "-Wl,--defsym=__ram_size=0x400000",
        ],
        emulator: "qemu-system-riscv32",
        machine: &["-M", "virt", "-bios", "none"],
    },
];

struct Board {
    name: &'static str,
    compiler: &'static str,
    options: &'static [&'static str],
    emulator: &'static str,
    machine: &'static [&'static str],
}

struct Target {
    compiler: &'static str,
    options: &'static [&'static str],
    limits: Option<[u64; 2]>,
    /// Most bytes of code of figures.
    figures: Option<u64>,
}

/// Minutes of processor time that the drop-in parts may take, with one Blender.
const MINUTES: f64 = 30.0;

/// Tests the decoder in C: test vectors, damaged files, mutants, code size, emulated boards
#[derive(Args)]
pub struct Bindings {
    /// Number of mutants that are compared with the Rust decoder
    #[arg(long, default_value_t = 6000)]
    mutants: usize,
    /// Selects which mutants are made
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// A Python that has Blender's module bpy, numpy and pytest, for the Blender add-on; may be given several times
    #[arg(long, value_name = "PYTHON")]
    bpy: Vec<String>,
    /// Runs only the drop-in parts: LVGL, xiaozhi, ESP-IDF, ESPHome, MicroPython, Blender; at most 30 minutes of processor time
    #[arg(long)]
    dropins: bool,
    /// Runs only the steps whose name contains this text
    #[arg(long)]
    only: Option<String>,
}

/// The steps that were asked for.
struct Selected<'a> {
    steps: Steps,
    only: Option<&'a str>,
}

impl Selected<'_> {
    fn run(&self, name: &str, step: impl FnOnce() -> Result<()>) {
        if self.only.is_none_or(|only| name.contains(only)) {
            self.steps.run(name, step);
        }
    }
}

impl Bindings {
    /// Runs all steps, failed ones too, then lists them.
    pub fn run(self) -> Result<()> {
        let steps = Selected { steps: Steps::default(), only: self.only.as_deref() };
        let folder = tempfile::tempdir()?;
        // Whatever is chosen needs some of them.
        steps.steps.run("tools", || {
            for emulator in ["simavr", "qemu-system-arm", "qemu-system-riscv32"] {
                setup::install_emulator(emulator)?;
            }
            let hosts = ["gcc", "g++", "clang", "clang++", "xtensa-lx106-elf-gcc"];
            for compiler in hosts.into_iter().chain(TARGETS.iter().map(|target| target.compiler)) {
                setup::install_emulator(compiler)?;
            }
            setup::sanitizers()
        });
        if !self.dropins {
            self.decoders(&steps, &folder);
        }
        self.parts(&steps, &folder);
        if self.dropins {
            steps.steps.run("time of the drop-in parts", processor_time_is_within_the_limit);
        }
        steps.steps.finish()
    }

    /// The decoder in C and in JavaScript, the Arduino library and the Python package.
    fn decoders(&self, steps: &Selected<'_>, folder: &TempDir) {
        for compiler in ["gcc", "clang"] {
            steps.run(&format!("test vectors with {compiler} and sanitizers"), || test_vectors(folder, compiler));
            steps.run(&format!("test vectors of key clips with {compiler} and sanitizers"), || key_vectors(folder, compiler));
        }
        steps.run("the README's program in C", || readme::run(folder));
        steps.run("rotations against the crate's", || turns::vectors(folder));
        steps.run("rotations of captures against the crate's", || turns::captures(folder));
        steps.run("a damaged clip hides no other", || {
            let mut command = Command::new(host_program(folder, "gcc", "errors")?);
            command.args(["bank.ptb", "scalars.ptn"].map(|name| vectors::folder().join(name)));
            output(command).map(drop)
        });
        steps.run("C++", || {
            for (compiler, source) in ["g++", "clang++"].into_iter().flat_map(|compiler| SOURCES.map(|source| (compiler, source)))
            {
                let mut command = Command::new(compiler);
                command.args(["-x", "c++", "-std=c++11", KEYS]);
                compile(command, &[source], &folder.path().join("cpp.o"))?;
            }
            Ok(())
        });
        steps.run("conversions", || conversions(folder));
        steps.run("lines of figures against the crate's", || figure::lines(folder));
        steps.run("solid figures against the crate's", || solid::pictures(folder));
        steps.run("failed reads of figures", || solid::reads(folder));
        steps.run("faces against the crate's", || face::pictures(folder));
        steps.run("what faces promise", || face::rules(folder));
        steps.run("memory of faces", || face::memory(folder));
        steps.run("lips for speech against the crate's", || talk::weights(folder));
        steps.run("lips for speech of espeak-ng", || talk::speech(folder));
        steps.run("the tutorial of a talking face", || tutorial::talking_face(folder));
        steps.run("animators against the crate's", || animator::transitions(folder));
        steps.run("state machines against the crate's", || animator::machines(folder));
        steps.run("feet of characters against the crate's", || animator::feet(folder));
        steps.run("cuts and flipped bits", || damage(folder));
        steps.run(&format!("{} mutants", self.mutants), || self.mutants(folder));
        steps.run(&format!("{} mutants of key clips", self.mutants), || self.key_mutants(folder));
        steps.run(&format!("{} mutants of banks", self.mutants), || self.bank_mutants(folder));
        for target in &TARGETS {
            steps.run(&format!("size with {}", target.compiler), || target.size(folder));
        }
        for board in &BOARDS {
            steps.run(&format!("test vectors on {}", board.name), || board.test_vectors(folder));
            steps.run(&format!("rotations on {}", board.name), || turns::on_board(folder, board));
        }
        steps.run("a clip on an Arduino Uno in simavr", || uno::walk(folder));
        steps.run("rotations on an Arduino Uno in simavr, and what they cost", || uno::turns(folder));
        steps.run("compiler of the ESP8266", || flash::sizes(folder));
        steps.run("tables in program memory", || flash::moved(folder));
        steps.run("classes of the Arduino library", || arduino::classes(folder));
        steps.run("examples of the Arduino library", || arduino::examples(folder));
        steps.run("sketch of the Arduino library on an Uno in simavr", || arduino::uno(folder));
        steps.run("names that a clip lacks, on an Uno in simavr", || arduino::missing(folder));
        steps.run("four servos on an Arduino Uno in simavr", || arduino::servos(folder));
        steps.run("metadata of the Arduino library", || arduino::metadata(folder));
        steps.run("programs that the page offers", || programs::run(folder));
        steps.run("JavaScript", || turns::javascript(folder));
        steps.run("wheel of the Python package", || python::run(folder));
    }

    /// Parts that are dropped into other people's systems, each from its packed folder.
    fn parts(&self, steps: &Selected<'_>, folder: &TempDir) {
        steps.run("faces and bodies on the test display of LVGL", || lvgl::run(folder));
        steps.run("a face that speaks on the test display of LVGL", lvgl::speech);
        steps.run("a display for xiaozhi on the test display of LVGL", || xiaozhi::run(folder));
        steps.run("the component for ESP-IDF", || esp_idf::run(folder));
        steps.run("a face on ESPHome's displays", || esphome::run(folder));
        steps.run("MicroPython", || micropython::run(folder));
        steps.run("the module in C for MicroPython", || micropython::module(folder));
        steps.run("licences", || licences::run(folder));
        steps.run("Blender add-on", || blender::run(folder, &self.bpy));
    }

    fn mutants(&self, folder: &TempDir) -> Result<()> {
        let program = host_program(folder, "gcc", "mutants")?;
        let counts = differential::run(&Decoder::Program(program), self.mutants, self.seed, |counts| {
            xtask::steps::progress("mutants", counts.agreed + counts.refused + counts.differing.len(), self.mutants);
        })?;
        no_difference(&counts)
    }

    fn key_mutants(&self, folder: &TempDir) -> Result<()> {
        let program = host_program_with(folder, "gcc", "mutants", &[KEYS])?;
        let counts = differential::run_keys(&Decoder::Program(program), self.mutants, self.seed, |counts| {
            xtask::steps::progress("mutants", counts.agreed + counts.refused + counts.differing.len(), self.mutants);
        })?;
        no_difference(&counts)
    }

    fn bank_mutants(&self, folder: &TempDir) -> Result<()> {
        let program = host_program_with(folder, "gcc", "mutants", &[KEYS])?;
        let counts = differential::run_banks(&Decoder::Program(program), self.mutants, self.seed, |counts| {
            xtask::steps::progress("mutants", counts.agreed + counts.refused + counts.differing.len(), self.mutants);
        })?;
        no_difference(&counts)
    }
}

/// An error if the programs that were started took more processor time than the drop-in parts may; where the system counts none, nothing is checked.
fn processor_time_is_within_the_limit() -> Result<()> {
    let Some(seconds) = xtask::steps::processor_seconds() else { return Ok(()) };
    println!("   {:.1} of {MINUTES} minutes of processor time", seconds / 60.0);
    ensure!(seconds <= 60.0 * MINUTES, "the drop-in parts may take {MINUTES} minutes");
    Ok(())
}

/// Prints how many mutants agreed; an error that shows the first one that does not.
fn no_difference(counts: &differential::Counts) -> Result<()> {
    println!("   {} agreed, {} refused by both, {} differing", counts.agreed, counts.refused, counts.differing.len());
    if let Some(first) = counts.differing.first() {
        bail!("{}\nRust: {}\nC:    {}", first.bytes.escape_ascii(), first.rust, first.independent);
    }
    Ok(())
}

/// The folder of the decoder in C.
fn home() -> PathBuf {
    paths::root().join("bindings/c")
}

/// Runs a compiler in the folder of the decoder; `sources` are compiled to one object, or with other options to a program.
fn compile(mut command: Command, sources: &[&str], to: &Path) -> Result<PathBuf> {
    command.current_dir(home()).args(WARNINGS).arg("-Isrc").args(sources).arg("-o").arg(to);
    if to.extension().is_some_and(|extension| extension == "o") {
        command.arg("-c");
    }
    output(command)?;
    Ok(to.to_owned())
}

pub fn output(mut command: Command) -> Result<Output> {
    let name = command.get_program().to_string_lossy().into_owned();
    let output = command.output().with_context(|| format!("cannot start {name}"))?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    ensure!(output.status.success(), "{name}: {}{}", text(&output.stderr), text(&output.stdout));
    Ok(output)
}

/// Builds a test program for this machine, with sanitizers.
fn host_program(folder: &TempDir, compiler: &str, name: &str) -> Result<PathBuf> {
    host_program_with(folder, compiler, name, &[])
}

fn host_program_with(folder: &TempDir, compiler: &str, name: &str, options: &[&str]) -> Result<PathBuf> {
    let mut command = Command::new(compiler);
    command.arg("-std=c99").args(SANITIZERS).args(options);
    let test = format!("tests/{name}.c");
    let sources: Vec<&str> = SOURCES.into_iter().chain([test.as_str()]).collect();
    compile(command, &sources, &folder.path().join(format!("{name}-{compiler}")))
}

/// Compiles what programs compile with the warnings of strict projects: conversions that can change a value, and what C++20 deprecates.
fn conversions(folder: &TempDir) -> Result<()> {
    for (compiler, options) in [("gcc", &["-std=c99", "-O2"][..]), ("g++", &["-x", "c++", "-std=c++20"])] {
        for source in SOURCES {
            let mut command = Command::new(compiler);
            command.args(options).args([KEYS, "-Wconversion"]);
            compile(command, &[source], &folder.path().join("conversions.o"))?;
        }
    }
    Ok(())
}

/// The clips and banks among the vectors, with their rigs.
fn files() -> Result<Vec<(PathBuf, Option<PathBuf>)>> {
    files_of(&vectors::folder())
}

fn files_of(folder: &Path) -> Result<Vec<(PathBuf, Option<PathBuf>)>> {
    let mut files = vec![];
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "ptn" || extension == "ptb") {
            let rig = path.with_extension("rig");
            files.push((path, rig.is_file().then_some(rig)));
        }
    }
    files.sort();
    ensure!(files.len() > 20, "{} vectors", files.len());
    Ok(files)
}

/// Compares what the decoder prints of every vector with its record.
fn test_vectors(folder: &TempDir, compiler: &str) -> Result<()> {
    compare_records(&host_program(folder, compiler, "frames")?, &files()?)
}

/// Compares the vectors of key clips, then all others, with the decoder that plays both.
fn key_vectors(folder: &TempDir, compiler: &str) -> Result<()> {
    let program = host_program_with(folder, compiler, "frames", &[KEYS])?;
    compare_records(&program, &files_of(&vectors::keyed::folder())?)?;
    compare_records(&program, &files()?)
}

fn compare_records(program: &Path, files: &[(PathBuf, Option<PathBuf>)]) -> Result<()> {
    for (file, rig) in files {
        let mut command = Command::new(program);
        command.arg(file).args(rig);
        let printed = output(command).with_context(|| file.display().to_string())?;
        agrees(file, &printed.stdout).with_context(|| file.display().to_string())?;
    }
    println!("   {} files", files.len());
    Ok(())
}

/// An error if a field of the record is missing in what was printed, or different.
fn agrees(file: &Path, printed: &[u8]) -> Result<()> {
    let record: Value = serde_json::from_str(&std::fs::read_to_string(file.with_extension("json"))?)?;
    let printed: Value = serde_json::from_slice(printed)?;
    for (name, expected) in record.as_object().context("a record is an object")? {
        let actual = &printed[name];
        match name.as_str() {
            "poses" => {
                for (frame, pose) in expected.as_object().context("poses are by frame")? {
                    ensure!(actual[frame] == *pose, "the pose of frame {frame} is {}", actual[frame]);
                }
            }
            "clips" => {
                let fields = ["name", "bytes", "frames", "looped", "crcs"];
                let clips = actual.as_array().context("clips are a list")?;
                let clips: Value = clips.iter().map(|clip| fields.map(|field| clip[field].clone()).to_vec()).collect();
                ensure!(clips == *expected, "the bank's clips differ");
            }
            _ => ensure!(actual == expected, "{name} is {actual}, not {expected}"),
        }
    }
    Ok(())
}

fn damage(folder: &TempDir) -> Result<()> {
    let program = host_program(folder, "gcc", "damage")?;
    for (file, rig) in files()? {
        let mut command = Command::new(&program);
        command.arg(&file).args(rig);
        output(command).with_context(|| file.display().to_string())?;
    }
    Ok(())
}

impl Target {
    /// Bytes of code of all functions, and of those of the slice decoder; then those of figures, and of rotations.
    fn size(&self, folder: &TempDir) -> Result<()> {
        let decoder = self.functions(folder, "src/pantin.c", &[])?;
        let all: u64 = decoder.iter().map(|(_, bytes)| bytes).sum();
        let slice: u64 =
            decoder.iter().filter(|(function, _)| !EXTRAS.contains(&function.as_str())).map(|(_, bytes)| bytes).sum();
        println!("   {slice} bytes of code without banks, pages and streams, {all} with them");
        if let Some([most_slice, most_all]) = self.limits {
            ensure!(
                slice > 1000 && slice <= most_slice && all <= most_all,
                "at most {most_slice} and {most_all} bytes are allowed"
            );
        }
        let [figure, euler] = [&[][..], &["-DPANTIN_EULER_ONLY"]].map(|options| {
            self.functions(folder, "src/pantin_figure.c", options)
                .map(|functions| functions.iter().map(|(_, bytes)| bytes).sum::<u64>())
        });
        let (figure, euler) = (figure?, euler?);
        println!("   {figure} bytes of code for figures, {euler} with Euler angles alone");
        let turns: u64 = self.functions(folder, "src/pantin_turn.c", &[])?.iter().map(|(_, bytes)| bytes).sum();
        println!("   {turns} bytes of code for rotations of joints");
        let keys: u64 = self.functions(folder, "src/pantin_keys.c", &[KEYS])?.iter().map(|(_, bytes)| bytes).sum();
        println!("   {keys} bytes of code for key clips");
        if self.limits.is_some() && self.compiler.starts_with("avr") {
            // A face does not fit its RAM beside a display's library.
            return Ok(());
        }
        let faces: u64 = self.functions(folder, "src/pantin_face.c", &[])?.iter().map(|(_, bytes)| bytes).sum();
        println!("   {faces} bytes of code for faces");
        let solid: u64 = self.functions(folder, "src/pantin_solid.c", &[])?.iter().map(|(_, bytes)| bytes).sum();
        println!("   {solid} bytes of code for solid figures");
        ensure!(solid > 1000 && solid <= solid::MOST_CODE, "solid figures may take {} bytes", solid::MOST_CODE);
        ensure!(faces > 1000 && faces <= face::MOST_CODE, "faces may take {} bytes", face::MOST_CODE);
        let talk: u64 = self.functions(folder, "src/pantin_talk.c", &[])?.iter().map(|(_, bytes)| bytes).sum();
        println!("   {talk} bytes of code for lips for speech");
        let feet: u64 = self.functions(folder, "src/pantin_feet.c", &[])?.iter().map(|(_, bytes)| bytes).sum();
        println!("   {feet} bytes of code for feet");
        ensure!(feet > 1000 && feet <= animator::MOST_FEET_CODE, "feet may take {} bytes", animator::MOST_FEET_CODE);
        let animator: u64 = self.functions(folder, "src/pantin_animator.c", &[])?.iter().map(|(_, bytes)| bytes).sum();
        println!("   {animator} bytes of code for the animator");
        ensure!(animator > 1000 && animator <= animator::MOST_CODE, "the animator may take {} bytes", animator::MOST_CODE);
        if let Some(limit) = self.figures {
            ensure!(figure > 1000 && figure <= limit, "figures may take {limit} bytes");
        }
        Ok(())
    }

    /// The functions of a source, and the bytes of each.
    fn functions(&self, folder: &TempDir, source: &str, options: &[&str]) -> Result<Vec<(String, u64)>> {
        let mut command = Command::new(self.compiler);
        command.arg("-std=c99").args(SECTIONS).args(self.options).args(options);
        let object = compile(command, &[source], &folder.path().join(format!("{}.o", self.compiler)))?;
        let mut size = Command::new(self.compiler.replace("-gcc", "-size"));
        size.arg("-A").arg(object);
        let sections = String::from_utf8(output(size)?.stdout)?;
        let function = |line: &str| {
            let (section, rest) = line.split_once(char::is_whitespace)?;
            let name = section.strip_prefix(".text")?.trim_start_matches('.');
            // A compiler appends to the name of a function of which it makes a variant.
            let name = name.split('.').next().unwrap_or_default();
            Some((name.to_owned(), rest.split_whitespace().next()?.parse().ok()?))
        };
        Ok(sections.lines().filter_map(function).collect())
    }
}

impl Board {
    /// Compares what the board prints of the vectors that need no second file with their records.
    fn test_vectors(&self, folder: &TempDir) -> Result<()> {
        let program = self.program(folder, "frames")?;
        for (file, _) in files()?.iter().filter(|(_, rig)| rig.is_none()) {
            agrees(file, &self.play(folder, &program, file)?).with_context(|| file.display().to_string())?;
        }
        Ok(())
    }

    /// Builds a test program that reads the file `clip.ptn`.
    fn program(&self, folder: &TempDir, name: &str) -> Result<PathBuf> {
        let mut command = Command::new(self.compiler);
        command.args(["-std=c99", "-Os", "-DCLIP_FILE=\"clip.ptn\""]).args(self.options);
        let test = format!("tests/{name}.c");
        compile(command, &["src/pantin.c", "src/pantin_turn.c", &test], &folder.path().join(format!("{name}.elf")))
    }

    /// What a test program prints of a clip.
    fn play(&self, folder: &TempDir, program: &Path, clip: &Path) -> Result<Vec<u8>> {
        std::fs::copy(clip, folder.path().join("clip.ptn"))?;
        let mut qemu = Command::new(setup::emulator(self.emulator)?);
        qemu.current_dir(folder.path()).args(self.machine).args(["-nographic", "-monitor", "none", "-serial", "none"]);
        qemu.args(["-semihosting-config", "enable=on,target=native"]).arg("-kernel").arg(program);
        let printed = output(qemu).with_context(|| clip.display().to_string())?;
        // Some C libraries print through the emulator's console, which is its standard error.
        Ok(if printed.stdout.is_empty() { printed.stderr } else { printed.stdout })
    }
}
