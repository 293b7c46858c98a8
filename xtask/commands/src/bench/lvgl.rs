//! The widget for LVGL against LVGL's own for GIF and Lottie: flash, RAM, stack and instructions of a frame of 240 by 240 pixels on an emulated Cortex-M4.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::{build, paths};
use xtask::setup;

use super::{Goal, Setting, table};
use crate::bindings::lvgl::{Build, folder, home, library, sources};
use crate::bindings::{SOURCES, output};

/// Options of all that is compiled.
const OPTIONS: &[&str] =
    &["-Os", "-ffunction-sections", "-fdata-sections", "-mcpu=cortex-m4", "-mthumb", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard"];
/// With what Lottie needs, too.
const VECTOR: &[&str] = &[
    "-Os",
    "-ffunction-sections",
    "-fdata-sections",
    "-mcpu=cortex-m4",
    "-mthumb",
    "-mfpu=fpv4-sp-d16",
    "-mfloat-abi=hard",
    "-DCOSTS_LOTTIE",
    "-fno-exceptions",
    "-fno-rtti",
];

const PLAIN: Build =
    Build { name: "cortex-m4", compilers: [Some("arm-none-eabi-gcc"), None], options: OPTIONS, settings: "tests/costs" };
const LOTTIE: Build = Build {
    name: "cortex-m4-lottie",
    compilers: [Some("arm-none-eabi-gcc"), Some("arm-none-eabi-g++")],
    options: VECTOR,
    settings: "tests/costs",
};

/// The emote that all show, and its frames; the Lottie has a key every third frame.
const EMOTE: &str = "laughing";
const FRAMES: u32 = 36;
const KEY_EVERY: u32 = 3;

/// LVGL's memory, which is a variable of its own.
const POOL: u64 = 1024 * 1024;

/// A program that shows something.
struct Shown {
    name: &'static str,
    /// The function in `costs.c`.
    makes: &'static str,
    /// What is compiled of it.
    with: &'static [&'static str],
    build: &'static Build<'static>,
}

const FACE: &[&str] = &["-DWITH_PANTIN", "-DLV_PANTIN_BODY=0"];
const BODY: &[&str] = &["-DWITH_PANTIN"];

const SHOWN: [Shown; 6] = [
    Shown { name: "no widget", makes: "make_nothing", with: &[], build: &PLAIN },
    Shown { name: "lv_pantin: the cartoon, 23 emotes, speech", makes: "make_face", with: FACE, build: &PLAIN },
    Shown { name: "lv_pantin: a body with volume, a state machine of 16 clips", makes: "make_solid", with: BODY, build: &PLAIN },
    Shown { name: "lv_pantin: the same as lines", makes: "make_lines", with: BODY, build: &PLAIN },
    Shown { name: "lv_gif: one emote", makes: "make_gif", with: &["-DWITH_GIF"], build: &PLAIN },
    Shown { name: "lv_lottie (ThorVG): one emote", makes: "make_lottie", with: &["-DWITH_LOTTIE"], build: &LOTTIE },
];

/// What a program takes.
struct Cost {
    code: u64,
    memory: u64,
    heap: u64,
    stack: u64,
    mean: u64,
    most: u64,
    pictures: u64,
}

/// Builds and runs all programs.
pub fn run(setting: &Setting) -> Result<Vec<Goal>> {
    for tool in ["arm-none-eabi-gcc", "arm-none-eabi-g++", "qemu-system-arm"] {
        setup::install_emulator(tool)?;
    }
    setup::arm_cpp()?;
    let content = content(setting)?;
    let mut rows = vec![];
    let mut goals = vec![];
    let mut nothing = None;
    for shown in &SHOWN {
        let cost = cost(shown, &content)?;
        let base = *nothing.get_or_insert(cost.code);
        if shown.makes == "make_nothing" {
            continue;
        }
        let size = content.size(shown);
        let number = |value: u64| value.to_string();
        rows.push(vec![
            shown.name.to_owned(),
            number(cost.code - base),
            number(size),
            number(cost.memory + cost.heap),
            number(cost.stack),
            number(cost.mean),
            number(cost.most),
            number(cost.pictures),
        ]);
        goals.push(Goal::told(
            shown.name,
            format!(
                "flash {} + {size} bytes of content, RAM {} bytes, stack {} bytes, {} instructions a picture ({} at most)",
                cost.code - base,
                cost.memory + cost.heap,
                cost.stack,
                cost.mean,
                cost.most
            ),
        ));
    }
    let header =
        ["widget, 240x240, RGB565", "flash", "content", "RAM", "stack", "instructions a picture", "at most", "pictures in 3 s"];
    table::print(&header, &rows);
    Ok(goals)
}

/// Files that the programs contain.
struct Content {
    bank: PathBuf,
    gif: PathBuf,
    lottie: PathBuf,
}

impl Content {
    /// The bytes of what a program shows; the face's are part of its code.
    fn size(&self, shown: &Shown) -> u64 {
        let of = |path: &Path| std::fs::metadata(path).map_or(0, |data| data.len());
        match shown.makes {
            "make_nothing" => 0,
            "make_gif" => of(&self.gif),
            "make_lottie" => of(&self.lottie),
            "make_solid" | "make_lines" => of(&self.bank),
            _ => (pantin_face::CARTOON.len() + pantin_face::EMOTES.iter().map(|(_, clip)| clip.len()).sum::<usize>()) as u64,
        }
    }
}

/// The emote as a GIF and as Lottie.
fn content(setting: &Setting) -> Result<Content> {
    let folder = paths::root().join("target/lvgl");
    std::fs::create_dir_all(&folder)?;
    let source = paths::root().join("motions/emotes").join(EMOTE).with_extension("keys");
    let clip = setting.tool.converted(&source, "lvgl-emote", &["--max-scalar-error".into(), "2".into()])?.clip;
    let [gif, lottie, program] = [folder.join("emote.gif"), folder.join("emote.json"), folder.join("lottie")];
    let mut render = Command::new(build::host_tool()?);
    render.arg("render").arg(clip).args(["--face", "cartoon", "--size", "240x240", "-o"]).arg(&gif);
    output(render)?;
    let mut gcc = Command::new("gcc");
    gcc.current_dir(home()).args([
        "-std=c99",
        "-O2",
        "-I../c/src",
        "tests/costs/lottie.c",
        "../c/src/pantin.c",
        "../c/src/pantin_face.c",
    ]);
    gcc.arg("-o").arg(&program);
    output(gcc)?;
    let mut writer = Command::new(&program);
    writer.args([EMOTE, &FRAMES.to_string(), &KEY_EVERY.to_string()]);
    std::fs::write(&lottie, output(writer)?.stdout)?;
    Ok(Content { bank: paths::root().join("motions/character.ptb"), gif, lottie })
}

/// Compiles a program, runs it in QEMU, and reads its sizes.
fn cost(shown: &Shown, content: &Content) -> Result<Cost> {
    let (lvgl, library, folder) = (sources()?, library(shown.build)?, folder(shown.build)?);
    let program = folder.join(shown.makes);
    let data = folder.join("content.S");
    let incbin = |name: &str, path: &Path| {
        format!(
            ".section .rodata.{name},\"a\"\n.balign 4\n.global {name}\n.global {name}_end\n{name}:\n.incbin \"{}\"\n{name}_end:\n.byte 0\n",
            path.display()
        )
    };
    let [bank, gif, lottie] = [("bank", &content.bank), ("gif", &content.gif), ("lottie", &content.lottie)];
    std::fs::write(&data, [bank, gif, lottie].map(|(name, path)| incbin(name, path)).concat())?;
    let compile = |compiler: &str, file: &Path, options: &[&str], index: usize| -> Result<PathBuf> {
        let object = folder.join(format!("program{index}.o"));
        let mut gcc = Command::new(compiler);
        gcc.current_dir(home()).args(shown.build.options).args(options).args([
            "-DLV_CONF_INCLUDE_SIMPLE",
            "-Itests/costs",
            "-Isrc",
        ]);
        gcc.arg("-I../c/src").arg("-I").arg(&lvgl).arg("-c").arg(file).arg("-o").arg(&object);
        output(gcc)?;
        Ok(object)
    };
    let makes = format!("-DSHOWN={}", shown.makes);
    let options = [&["-std=gnu99", "-w", makes.as_str()], shown.with].concat();
    let mut files = vec![PathBuf::from("tests/costs/costs.c"), data];
    if shown.with.contains(&"-DWITH_PANTIN") {
        files.extend(["src/lv_pantin.c", "src/lv_pantin_body.c"].map(PathBuf::from));
        files.extend(SOURCES.map(|source| Path::new("../c").join(source)));
    }
    let objects = files.iter().enumerate().map(|(index, file)| compile("arm-none-eabi-gcc", file, &options, index));
    let objects = objects.collect::<Result<Vec<_>>>()?;
    let mut link = Command::new("arm-none-eabi-g++");
    link.current_dir(home())
        .args(OPTIONS)
        .args(["--specs=rdimon.specs", "-Wl,--gc-sections", "-T", "../c/tests/mps2.ld"])
        .args(objects);
    link.arg(&library).args(["-lm", "-o"]).arg(&program);
    output(link)?;
    let mut qemu = Command::new("qemu-system-arm");
    qemu.args([
        "-M",
        "mps2-an386",
        "-icount",
        "shift=0",
        "-nographic",
        "-semihosting-config",
        "enable=on,target=native",
        "-kernel",
    ]);
    qemu.arg(&program);
    let printed = String::from_utf8(output(qemu)?.stdout)?;
    let numbers: Vec<u64> =
        printed.split_whitespace().map(str::parse).collect::<Result<_, _>>().with_context(|| printed.clone())?;
    let [memory, heap, stack, mean, most, pictures] = numbers[..] else { anyhow::bail!("{}: {printed}", shown.makes) };
    ensure!(shown.makes == "make_nothing" || pictures > 20, "{} draws nothing", shown.makes);
    let code = code(&program)? - content.size(shown);
    Ok(Cost { code, memory, heap, stack, mean, most, pictures })
}

/// Bytes of code and constants of a program.
fn code(program: &Path) -> Result<u64> {
    let mut size = Command::new("arm-none-eabi-size");
    size.arg(program);
    let text = String::from_utf8(output(size)?.stdout)?;
    let numbers: Vec<u64> =
        text.lines().nth(1).unwrap_or_default().split_whitespace().map_while(|word| word.parse().ok()).collect();
    let [code, data, bss, ..] = numbers[..] else { anyhow::bail!("{text}") };
    ensure!(bss > POOL, "LVGL's memory is a variable");
    Ok(code + data)
}
