//! The build script of all boards: it brings memory map and clips to where the linker and the program find them.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// The repository's root, from a board's folder.
const ROOT: &str = "../../..";
/// The clips that a board plays by default.
const DEFAULT: [&str; 2] = ["walk", "run"];
/// The clips that it also plays by default if it draws faces.
const FACES: [&str; 5] = ["greet", "face/hello", "face/joy", "face/surprise", "face/wink"];

/// The whole script of most boards: the memory map `memory.x` of the board's folder, arguments for the linker, the linker script of `defmt` if
/// the board's feature of that name is on, and the clips.
pub fn board(link_arguments: &[&str]) {
    board_in("memory.x", link_arguments);
}

/// The same with another file for the memory map.
pub fn board_in(map: &str, link_arguments: &[&str]) {
    memory_map(map);
    link(link_arguments);
    if feature("defmt") {
        link(&["-Tdefmt.x"]);
    }
    display();
    clips();
}

/// The displays over SPI: the board's feature, the name of its `Module` in `board_drivers::color_panels`, and the most columns and rows of its
/// pictures.
const DISPLAYS: [(&str, &str, [usize; 2]); 6] = [
    ("st7789", "ST7789_240X240", [240, 240]),
    ("st7789-135x240", "ST7789_135X240", [135, 240]),
    ("st7789-170x320", "ST7789_170X320", [170, 320]),
    ("st7789-240x320", "ST7789_240X320", [240, 320]),
    ("ili9341", "ILI9341_240X320", [240, 320]),
    // The square that the circle does not cut.
    ("gc9a01", "GC9A01_240X240", [168, 168]),
];

/// Writes `display.rs` for a board with a display over SPI: the constant `MODULE`, and the types of pictures `Colour`, `Greys` and `Mono`, which
/// are as large as the display and the layout allow. `PANTIN_ROTATION` turns the picture clockwise, by 0, 90, 180 or 270 degrees.
pub fn display() {
    println!("cargo::rerun-if-env-changed=PANTIN_ROTATION");
    let is_on = |name: &&str| feature(name);
    let chosen: Vec<&str> =
        DISPLAYS.iter().map(|(name, ..)| *name).chain(["sh1106", "ssd1306-128x32", "ssd1306-72x40"]).filter(is_on).collect();
    if let [first, second, ..] = *chosen {
        println!("cargo::error=the features {first} and {second} exclude each other: choose one display");
    }
    let Some((name, module, [wide, high])) = DISPLAYS.into_iter().find(|(name, ..)| feature(name)) else { return };
    let rotation = env::var("PANTIN_ROTATION").unwrap_or("0".into());
    let [wide, high] = match &*rotation {
        "0" | "180" => [wide, high],
        "90" | "270" => [high, wide],
        _ => return println!("cargo::error=PANTIN_ROTATION is {rotation}, not 0, 90, 180 or 270"),
    };
    if wide > 256 {
        return println!(
            "cargo::error=PANTIN_ROTATION={rotation}: a picture of {wide} columns is too wide: {name} can be turned by 180 degrees only"
        );
    }
    let in_pairs = wide / 2 * 2;
    let in_eights = wide / 8 * 8;
    let text = format!(
        "pub const MODULE: board_drivers::color_panels::Module<board_drivers::color_panels::{controller}> =\n    \
         board_drivers::color_panels::{module}.rotated(board_drivers::color_panels::Rotation::Deg{rotation});\n\
         /// In colour.\n#[allow(dead_code)]\n\
         pub type Colour = pantin_figure::surface::Rgb565Rows<{in_pairs}, {high}, {pairs}>;\n\
         /// In 16 greys.\n#[allow(dead_code)]\n\
         pub type Greys = pantin_figure::surface::Gray4Rows<{in_eights}, {high}, {words}>;\n\
         /// In black and white.\n\
         pub type Mono = pantin_figure::surface::MonoPages<{in_pairs}, {pages}, {bytes}>;\n",
        controller = module.split('_').next().unwrap_or_default(),
        pairs = in_pairs * high / 2,
        words = in_eights * high / 8,
        pages = high / 8 * 8,
        bytes = in_pairs * (high / 8),
    );
    fs::write(out().join("display.rs"), text).expect("OUT_DIR is writable");
}

/// Copies a memory map (its path from the board's folder) to where the linker looks for `memory.x`.
pub fn memory_map(path: &str) {
    script(path, "memory.x", "the board's memory map");
}

/// Copies a part of a memory map, which includes it by this name.
pub fn memory_map_part(path: &str, name: &str) {
    script(path, name, "a part of the board's memory map");
}

/// Copies the names of a board's interrupts to where the linker looks for `device.x`.
pub fn interrupts(path: &str) {
    script(path, "device.x", "the board's interrupts");
}

fn script(path: &str, name: &str, what: &str) {
    println!("cargo::rerun-if-changed={path}");
    if let Err(error) = fs::copy(path, out().join(name)) {
        println!("cargo::error={path}: {error}: it is {what}");
    }
    println!("cargo::rustc-link-search={}", out().display());
}

/// Passes arguments to the linker.
pub fn link(arguments: &[&str]) {
    arguments.iter().for_each(|argument| println!("cargo::rustc-link-arg-bins={argument}"));
}

/// Writes `clips.rs`, which defines `CLIPS`: the clips and all clips of the banks that `PANTIN_CLIP` lists (absolute paths, separated as in PATH), or the
/// default ones.
/// Returns the largest number of channels, of moving channels, and of joints of the figure.
pub fn clips() -> [usize; 3] {
    println!("cargo::rerun-if-env-changed=PANTIN_CLIP");
    let paths: Vec<PathBuf> = match env::var_os("PANTIN_CLIP") {
        Some(paths) => env::split_paths(&paths).collect(),
        None => {
            let faces: &[&str] = if feature("face") { &FACES } else { &[] };
            let names = DEFAULT.iter().chain(faces);
            names.map(|name| Path::new(ROOT).join("motions").join(name).with_extension("ptn")).collect()
        }
    };
    let (mut list, mut banks) = (String::new(), String::new());
    let mut largest = [0; 3];
    for (index, path) in paths.iter().enumerate() {
        println!("cargo::rerun-if-changed={}", path.display());
        let copy = out().join(format!("clip-{index}.ptn"));
        if let Err(error) = fs::copy(path, &copy) {
            let advice = "set PANTIN_CLIP to absolute paths of clips; `cargo pantin convert IN -o OUT.ptn` makes one";
            println!("cargo::error={}: {error}: {advice}", path.display());
        }
        let bytes = fs::read(&copy).unwrap_or_default();
        if let Ok(bank) = pantin::Bank::new_checked(&bytes) {
            let part = |part: &[u8]| {
                let from = part.as_ptr() as usize - bytes.as_ptr() as usize;
                format!("part(BANK_{index}, {from}, {})", part.len())
            };
            let _ = writeln!(banks, "static BANK_{index}: &[u8] = include_bytes!({copy:?});");
            for entry in bank.entries() {
                let size = bank.open(&entry).map(|clip| size(&clip, path)).unwrap_or_default();
                largest = std::array::from_fn(|kind| size[kind].max(largest[kind]));
                let (name, bytes, rig) = (entry.name(), part(entry.bytes()), part(bank.rig_bytes()));
                let _ = writeln!(list, "    pantin_app::Entry {{ name: {name:?}, bytes: {bytes}, rig: {rig} }},");
            }
            continue;
        }
        let size = pantin::Clip::new_checked(&bytes).map(|clip| size(&clip, path)).unwrap_or_default();
        largest = std::array::from_fn(|kind| size[kind].max(largest[kind]));
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let _ = writeln!(list, "    pantin_app::Entry {{ name: {name:?}, bytes: include_bytes!({copy:?}), rig: &[] }},");
    }
    if !banks.is_empty() {
        banks += "const fn part(bank: &'static [u8], from: usize, len: usize) -> &'static [u8] {\n    bank.split_at(from).1.split_at(len).0\n}\n";
    }
    let clips =
        format!("{banks}/// The clips that this program was built with.\nstatic CLIPS: &[pantin_app::Entry] = &[\n{list}];\n");
    fs::write(out().join("clips.rs"), clips).expect("OUT_DIR is writable");
    largest
}

/// Channels, moving channels and joints for which 16 KiB of RAM have room.
pub const SMALL: [usize; 3] = [144, 96, 36];

/// Writes `capacity.rs`: the type `Capacity`, which has buffers for `clips`, but no more than `most`. The program refuses a clip that needs
/// more when it opens it.
pub fn capacity(clips: [usize; 3], most: [usize; 3]) {
    let [channels, moving, joints] = std::array::from_fn(|kind| clips[kind].min(most[kind]));
    let capacity = format!(
        "/// The largest clip: its channels, those of them that move, and the joints of its figure.\n\
         pub type Capacity = pantin_app::MaxClip<{channels}, {moving}, {joints}>;\n"
    );
    fs::write(out().join("capacity.rs"), capacity).expect("OUT_DIR is writable");
}

/// Returns whether a feature of the board's package is on.
pub fn feature(name: &str) -> bool {
    env::var_os(format!("CARGO_FEATURE_{}", name.to_uppercase().replace('-', "_"))).is_some()
}

/// Returns a clip's channels, states of a player, and joints of the figure with the crown that it may get. The program itself reports what is
/// no clip.
fn size(clip: &pantin::Clip, path: &Path) -> [usize; 3] {
    if clip.has_keys() && !feature("keys") {
        let advice = "build with feature `keys`, or convert its motion with `--segments`";
        println!("cargo::error={}: a key clip, which this image would not play: {advice}", path.display());
    }
    [clip.rig().channels(), clip.moving(), clip.rig().joint_count() + 1]
}

fn out() -> PathBuf {
    PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR for build scripts"))
}
