//! The web page's files: modules built for WebAssembly, the page itself, and our own clips.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use pantin::Bank;
use pantin_convert::bank;
use pantin_convert::export;
use pantin_convert::import::{self, ImportOptions};
use pantin_convert::{Length, Level, Options, convert};
use pantin_pictures::machine;
use serde_json::json;

use xtask::build::{self, Build};
use xtask::{paths, setup};

use crate::{bundle, compare, downloads, inline, offline, pack, script, tools};

/// What the modules are compiled for.
pub const TARGET: &str = "wasm32-unknown-unknown";

/// For small modules: functions of a few instructions more are put in line, and addresses are not stepped on from one turn of a loop to the next.
const SMALL: &str = "-Cllvm-args=-inline-threshold=25 -Cllvm-args=-disable-lsr";
/// For modules without the standard library, too: a small stack.
const SMALL_STACK: &str = "-Clink-arg=-zstack-size=65536";

/// A module that a worker of the page loads.
struct Module {
    /// Its package in the web workspace.
    package: &'static str,
    /// The profile that it is built in.
    profile: &'static str,
    /// Its name in the site.
    name: &'static str,
}

const MODULES: [Module; 2] = [
    Module { package: "pantin-web-converter", profile: "converter", name: CONVERTER[1] },
    Module { package: "pantin-web-machine", profile: "machine", name: MACHINE[2] },
];

/// A file of the player, or of the converter, and its bytes.
pub struct Size {
    /// Its name in the site.
    pub name: &'static str,
    /// As it is served without compression.
    pub bytes: usize,
}

/// What a page that plays clips loads.
pub const PLAYER: [&str; 1] = ["pantin-player.js"];
/// What it loads too: once a picture has the focus, for files of more than a packet, for key clips, for the solid look and its characters, for the display's look, for scalars that drive no face, for a table of poses, in other
/// languages than English.
pub const OTHERS: [&str; 9] = [
    "pantin-controls.js",
    "pantin-stream.js",
    "pantin-keys.js",
    "pantin-solid.js",
    "pantin-looks.js",
    "pantin-oled.js",
    "pantin-bars.js",
    "pantin-table.js",
    "pantin-words.js",
];
/// What it loads too once a picture or a recording is saved.
pub const EXPORT: [&str; 1] = ["pantin-export.js"];
/// What it loads too once a clip may drive a face.
pub const FACE: [&str; 1] = ["pantin-face.js"];
/// What it loads too for a bank, and for one with a state machine.
pub const CHARACTER: [&str; 2] = ["pantin-bank.js", "pantin-character.js"];
/// What is loaded beside it once a motion is dropped.
pub const CONVERTER: [&str; 3] = ["converter.js", "pantin-converter.wasm", "wasm.js"];
/// What is loaded beside it once the text of the character's state machine is opened.
pub const MACHINE: [&str; 4] = ["machine.js", "machine-worker.js", "pantin-machine.wasm", "wasm.js"];

/// Texts of programs: they stay as they are.
const PROGRAMS: &str = "programs.js";

/// Builds the site into a folder, in place of what of it was there, and a page in one file for each of the `inlined` clips.
pub fn build(out: &Path, inlined: &[PathBuf]) -> Result<()> {
    let make = |folder: &Path| std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()));
    make(&out.join("clips"))?;
    setup::rust_target(TARGET)?;
    // It compiles the reader of FBX files.
    setup::install_emulator("clang")?;
    for Module { package, profile, name } in MODULES {
        write(&out.join(name), &module(package, "", profile)?)?;
    }
    let page = listed(&paths::root().join("web/page"))?;
    let packages = paths::root().join("web/packages");
    for (name, modules) in bundle::SCRIPTS {
        write(&out.join(name), &tools::minified(bundle::bundle(&packages, modules)?.into_bytes())?)?;
    }
    clips(out)?;
    emotes(out)?;
    character(out)?;
    downloads::archives(out)?;
    let scripted = |bytes: &[u8]| tools::minified(script::shortened(bytes)?);
    let mut worker = String::new();
    for entry in page {
        let name = entry.file_name().unwrap_or_default();
        let mut bytes = std::fs::read(&entry).with_context(|| entry.display().to_string())?;
        if name == offline::SCRIPT {
            worker = String::from_utf8(bytes).context(offline::SCRIPT)?;
            continue;
        }
        if name == "index.html" {
            bytes = compare::filled(out, &String::from_utf8(bytes).context("index.html")?)?.into_bytes();
        }
        let is_script = entry.extension().is_some_and(|extension| extension == "js") && name != PROGRAMS;
        write(&out.join(name), &if is_script { scripted(&bytes)? } else { bytes })?;
    }
    for clip in inlined {
        let bytes = std::fs::read(clip).with_context(|| clip.display().to_string())?;
        let name = clip.file_stem().unwrap_or_default();
        ensure!(name != "index", "{}: its page would be in place of the site's", clip.display());
        let page = inline::page(out, &bytes, &name.to_string_lossy()).with_context(|| clip.display().to_string())?;
        write(&out.join(name).with_extension("html"), page.as_bytes())?;
    }
    write(&out.join(offline::SCRIPT), &scripted(offline::filled(out, &worker)?.as_bytes())?)?;
    tools::compress(&out.join("clips"))?;
    tools::compress(out)
}

/// Bytes of the site's files, of those that are there.
pub fn sizes(out: &Path, names: &[&'static str]) -> Vec<Size> {
    let bytes = |name| std::fs::metadata(out.join(name)).ok().map(|file| file.len() as usize);
    names.iter().filter_map(|name| Some(Size { name, bytes: bytes(name)? })).collect()
}

/// The firmware's decoder, figure and animator as a module, with which tests compare the element's own.
pub fn player_module() -> Result<Vec<u8>> {
    setup::rust_target(TARGET)?;
    module("pantin-web-player", "character,poses", "release")
}

/// The firmware's face code as a module, with which tests compare what draws faces here.
pub fn face_module() -> Result<Vec<u8>> {
    setup::rust_target(TARGET)?;
    module("pantin-web-face", "", "release")
}

/// A package of the web workspace as a module.
fn module(package: &str, features: &str, profile: &str) -> Result<Vec<u8>> {
    let arguments = ["--profile", profile, "--package", package, "--features", features, "--target", TARGET];
    let flags = match profile {
        "release" => Some(format!("{SMALL_STACK} {SMALL}")),
        "machine" => Some(SMALL.into()),
        _ => None,
    };
    let environment = flags.map(|flags| ("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS".into(), flags.into()));
    let product = build::cargo(&Build {
        workspace: paths::root().join("web"),
        arguments: arguments.map(OsString::from).into(),
        environment: environment.into_iter().collect(),
        product: package.replace('-', "_"),
        ..Build::default()
    })?;
    let bytes = std::fs::read(&product).with_context(|| product.display().to_string())?;
    // The optimizer would take minutes for the converter, and does not make the compiler of state machines smaller as sent.
    let bytes = if profile == "release" { tools::optimized(bytes)? } else { bytes };
    pack::pack(&bytes).with_context(|| product.display().to_string())
}

/// Motions of our library, which share a rig: one after the other, they are a clip that takes a while to arrive over a slow line.
const MEDLEY: [&str; 8] = ["idle", "wave", "bow", "dance", "jump", "sit_down", "stand_up", "turn_left"];
/// The error of that clip.
const MEDLEY_CM: f64 = 0.05;

/// Our own clips and the motions of our character, the list of them that the page reads, and a motion file for who has none.
fn clips(out: &Path) -> Result<()> {
    let mut list = vec![];
    for folder in ["motions", "motions/face"] {
        for clip in listed(&paths::root().join(folder))? {
            if clip.extension().is_some_and(|extension| extension == "ptn") {
                let bytes = std::fs::read(&clip).with_context(|| clip.display().to_string())?;
                let name = clip.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                list.push(listed_clip(out, "", &name, &bytes)?);
            }
        }
    }
    let moves = std::fs::read(paths::root().join("motions/character.ptb"))?;
    let bank = Bank::new_checked(&moves).map_err(|error| anyhow::anyhow!("{error}"))?;
    let rig = bank::CheckedRig::of(&bank);
    for entry in bank.entries() {
        if list.iter().all(|clip| clip["name"] != entry.name()) {
            list.push(listed_clip(out, "", entry.name(), &bank::with_rig(entry.bytes(), &rig)?)?);
        }
    }
    let medley = medley()?;
    list.push(listed_clip(out, "", "medley", &medley)?);
    let walk = import::load(&paths::root().join("motions/walk.keys"), &ImportOptions::new())?.motion;
    let mut bvh = vec![];
    export::bvh::write(&walk, export::bvh::Columns::ThreeRotations, &mut bvh)?;
    write(&out.join("clips/walk.bvh"), &bvh)?;
    write(&out.join("clips.json"), json!(list).to_string().as_bytes())
}

/// How the names of files of emotes begin.
const EMOTE: &str = "emote-";

/// Writes a clip, and as files of other programs, with names that begin so; returns its entry in the list.
fn listed_clip(out: &Path, begin: &str, name: &str, bytes: &[u8]) -> Result<serde_json::Value> {
    let file = format!("clips/{begin}{name}.ptn");
    write(&out.join(&file), bytes)?;
    let others = downloads::exported(&out.join(&file), bytes).with_context(|| file.clone())?;
    Ok(json!({ "name": name, "file": file, "bytes": bytes.len(), "others": others }))
}

/// The emotes of a face, and their list.
fn emotes(out: &Path) -> Result<()> {
    let mut list = vec![];
    for clip in listed(&paths::root().join("firmware/face/emotes"))? {
        let bytes = std::fs::read(&clip).with_context(|| clip.display().to_string())?;
        let name = clip.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        list.push(listed_clip(out, EMOTE, &name, &bytes)?);
    }
    write(&out.join("clips/emotes.json"), json!(list).to_string().as_bytes())
}

/// Our character, with the text and the picture of its state machine, the inputs that do something in each state, and our characters of the solid figure.
fn character(out: &Path) -> Result<()> {
    let path = paths::root().join("motions/character.toml");
    let text = std::fs::read_to_string(&path).with_context(|| path.display().to_string())?;
    write(&out.join("clips/character.ptb"), &std::fs::read(paths::root().join("motions/character.ptb"))?)?;
    write(&out.join("clips/character.toml"), text.as_bytes())?;
    let source = machine::Source::parse(&machine::Text { name: "character.toml", text: &text })?;
    let inputs: BTreeMap<_, _> = machine::inputs::of_states(&source).into_iter().collect();
    write(&out.join("clips/character.json"), json!(inputs).to_string().as_bytes())?;
    for look in listed(&paths::root().join("motions/looks"))? {
        let bytes = std::fs::read(&look).with_context(|| look.display().to_string())?;
        write(&out.join("clips").join(look.file_name().unwrap_or_default()), &bytes)?;
    }
    write(&out.join("clips/character.svg"), machine::graph::svg(&source).as_bytes())
}

/// Several motions in turn, within [`MEDLEY_CM`].
fn medley() -> Result<Vec<u8>> {
    let load = |name: &&str| {
        let path = paths::root().join("motions/library").join(name).with_extension("keys");
        anyhow::Ok(import::load(&path, &ImportOptions::new())?.motion)
    };
    let motions = MEDLEY.iter().map(load).collect::<Result<Vec<_>>>()?;
    let [first, others @ ..] = &motions[..] else { return Ok(vec![]) };
    let mut whole = first.clone();
    for motion in others {
        ensure!(motion.rig == whole.rig && motion.frame_time == whole.frame_time, "motions of the library have different rigs");
        whole.frames += motion.frames;
        whole.values.iter_mut().zip(&motion.values).for_each(|(values, more)| values.extend(more));
    }
    (whole.looped, whole.events) = (false, vec![]);
    whole.keys.fill(None);
    let options = Options::new().max_error(Length::cm(MEDLEY_CM)).places_only(true).effort(Level::FAST);
    Ok(convert(&whole, &options, &mut |_| ())?.clip)
}

pub(crate) fn listed(folder: &Path) -> Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(folder).with_context(|| folder.display().to_string())?;
    let mut files: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).filter(|path| path.is_file()).collect();
    files.sort();
    Ok(files)
}

pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    pantin_tools::output::write_whole(path, bytes)
}
