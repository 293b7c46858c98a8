//! The npm packages: built from the site's files, packed, and used by a clean project.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use serde_json::Value;
use xtask::browser::Browser;
use xtask::npm;

use crate::site::{CHARACTER, EXPORT, FACE, OTHERS, PLAYER};
use crate::{bundle, tools};
use xtask::{build, paths, setup};

/// The packages, those that others need first.
pub const PACKAGES: [&str; 4] = ["decoder", "animator", "three", "player"];
const CHECK: [&str; 12] = [
    "bundles.mjs",
    "check.mjs",
    "check.ts",
    "index.html",
    "main.ts",
    "pixels.html",
    "pixels.js",
    "pixels.mjs",
    "preact.tsx",
    "react.tsx",
    "templates.ts",
    "tsconfig.json",
];
/// Files that three.js draws as their own animation moves them and as a clip of it does: a fox, a man with a texture of stripes, a captured body. Each
/// with the error bound of the clip, and the part of the figure's pixels that may have no like one within a pixel in the other picture.
const DRAWN: [(&str, &str, f64); 3] = [
    ("gltf_khronos_fox.glb", "0.05cm", 0.005),
    ("gltf_khronos_cesium-man.glb", "0.005cm", 0.02),
    ("bvh_bandai1_dance.bvh", "0.05cm", 0.005),
];

/// A packed package.
pub struct Packed {
    /// Its name.
    pub name: String,
    /// What is published.
    pub file: PathBuf,
    /// Bytes of that, and of its content.
    pub sizes: [u64; 2],
}

/// Packs all packages into a folder, from a site that was built. Each has every file that its manifest names.
pub fn pack(site: &Path, out: &Path) -> Result<Vec<Packed>> {
    ensure!(tools::installed(), "the packages need terser and wasm-opt, which npm could not install");
    let mut packed = vec![];
    for package in PACKAGES {
        let (source, folder) = (paths::root().join("web/packages").join(package), out.join(package));
        std::fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
        let manifest: Value = serde_json::from_slice(&read(&source.join("package.json"))?).context("package.json")?;
        let files = manifest["files"].as_array().context("package.json names no files")?;
        for name in files.iter().filter_map(Value::as_str).chain(["package.json"]) {
            let bytes = match name {
                "LICENSE-MIT" | "LICENSE-APACHE" => read(&paths::root().join(name))?,
                "decoder.min.js" => bundle::decoder()?,
                "turns.min.js" => bundle::turns()?,
                name if [&PLAYER[..], &OTHERS, &EXPORT, &FACE, &CHARACTER].iter().any(|files| files.contains(&name)) => {
                    read(&site.join(name))?
                }
                name if name.ends_with(".js") => module(&source, name)?,
                name => read(&source.join(name))?,
            };
            crate::site::write(&folder.join(name), &bytes)?;
        }
        let told = npm::run(&folder, &["pack", "--json", "--pack-destination", ".."])?;
        let told: Value = serde_json::from_str(&told).context("npm pack")?;
        // A list, or an object by the packages' names.
        let told = told.get(0).or_else(|| told.as_object()?.values().next()).context("npm packed nothing")?;
        let contents = told["files"].as_array().context("npm packed no files")?;
        for name in files {
            ensure!(contents.iter().any(|file| file["path"] == *name), "{package}: {name} is not in the package");
        }
        packed.push(Packed {
            name: manifest["name"].as_str().unwrap_or_default().to_owned(),
            file: out.join(told["filename"].as_str().context("npm's file")?),
            sizes: ["size", "unpackedSize"].map(|field| told[field].as_u64().unwrap_or_default()),
        });
    }
    Ok(packed)
}

/// What using the packages showed.
pub struct Checked {
    /// What was measured in Node.
    pub measured: Value,
    /// Where in Chromium the element played.
    pub places: Vec<String>,
}

/// Uses the packages in a project of their own: in Node, with strict types, and in Chromium, in bundles of Vite's, webpack's and esbuild's and without one.
pub fn check(packed: &[Packed], site: &Path, folder: &Path) -> Result<Checked> {
    let source = paths::root().join("web/packages/check");
    npm::install(&source, folder)?;
    for name in CHECK {
        crate::site::write(&folder.join(name), &read(&source.join(name))?)?;
    }
    let files: Vec<String> = packed.iter().map(|package| package.file.display().to_string()).collect();
    let mut arguments = vec!["install", "--no-save", "--no-audit", "--no-fund"];
    arguments.extend(files.iter().map(String::as_str));
    npm::run(folder, &arguments)?;
    let measured =
        node(folder, "check.mjs", &["walk.ptn", "character.ptb"].map(|name| paths::root().join("motions").join(name)))?;
    node(folder, "node_modules/typescript/bin/tsc", &["--project".into(), ".".into()])?;
    let places = node(folder, "bundles.mjs", &[paths::root().join(site).join("clips")])?;
    Ok(Checked {
        measured: serde_json::from_str(&measured).context("check.mjs")?,
        places: serde_json::from_str(&places).context("bundles.mjs")?,
    })
}

/// Builds each of the examples with the packed player, and uses what was built in Chromium. Returns their names.
pub fn examples(packed: &[Packed], folder: &Path) -> Result<Vec<String>> {
    let source = paths::root().join("web/examples");
    npm::install(&source, folder)?;
    copied(&source, folder)?;
    let player = packed.iter().find(|package| package.name == "@pantin/player").context("the player was not packed")?;
    npm::run(folder, &["install", "--no-save", "--no-audit", "--no-fund", &player.file.display().to_string()])?;
    let built = node(folder, "check.mjs", &[paths::root().join("motions/walk.ptn")])?;
    serde_json::from_str(&built).context("check.mjs")
}

/// Copies a folder, without what tools leave there.
fn copied(from: &Path, to: &Path) -> Result<()> {
    const LEFT: [&str; 7] = ["node_modules", "dist", "build", "out", ".next", ".svelte-kit", ".astro"];
    std::fs::create_dir_all(to).with_context(|| format!("cannot make {}", to.display()))?;
    for entry in std::fs::read_dir(from).with_context(|| from.display().to_string())? {
        let (name, path) = entry.map(|entry| (entry.file_name(), entry.path()))?;
        if LEFT.iter().any(|left| name == *left) {
        } else if path.is_dir() {
            copied(&path, &to.join(&name))?;
        } else {
            std::fs::copy(&path, to.join(&name)).with_context(|| path.display().to_string())?;
        }
    }
    Ok(())
}

/// What three.js shows: a line for each of the captured files, or none where these are not at hand.
pub fn pixels(folder: &Path) -> Result<Vec<String>> {
    let Some(data) = paths::data() else { return Ok(vec![]) };
    let pairs = tempfile::Builder::new().prefix("pantin-pixels-").tempdir().context("cannot make a temporary folder")?;
    let tool = build::host_tool()?;
    let pantin = |arguments: &[&OsStr]| -> Result<()> {
        let output = Command::new(&tool).args(arguments).output().context("cannot start the host tool")?;
        ensure!(output.status.success(), "pantin: {}", String::from_utf8_lossy(&output.stderr));
        Ok(())
    };
    for (name, bound, _) in DRAWN {
        let (source, stem) = (data.join(name), name.split('.').next().unwrap_or(name));
        let [file, clip] = ["glb", "ptn"].map(|extension| pairs.path().join(stem).with_extension(extension));
        if name.ends_with(".glb") {
            std::fs::copy(&source, &file).with_context(|| source.display().to_string())?;
        } else {
            let body = pairs.path().join("body");
            pantin(&["convert".as_ref(), source.as_ref(), "--to".as_ref(), "300".as_ref(), "-o".as_ref(), body.as_ref()])?;
            pantin(&["expand".as_ref(), body.as_ref(), "-o".as_ref(), file.as_ref()])?;
        }
        pantin(&[
            "convert".as_ref(),
            "--segments".as_ref(),
            file.as_ref(),
            "--max-error".as_ref(),
            bound.as_ref(),
            "-o".as_ref(),
            clip.as_ref(),
        ])?;
    }
    let told: Value = serde_json::from_str(&node(folder, "pixels.mjs", &[pairs.path().into()])?).context("pixels.mjs")?;
    let line = |(name, bound, most): (&str, &str, f64)| {
        let stem = name.split('.').next().unwrap_or(name);
        let part = told[stem]["most"].as_f64().with_context(|| format!("{stem} was not drawn"))?;
        ensure!(told[stem]["shown"].as_u64() > Some(200), "{stem}: the pictures show nothing");
        let line = format!("{stem} at {bound}: at most {:.2} % of its pixels have no like within a pixel", 100.0 * part);
        ensure!(part <= most, "{line}; expected {} %", 100.0 * most);
        Ok(line)
    };
    DRAWN.into_iter().map(line).collect()
}

fn node(folder: &Path, program: &str, arguments: &[PathBuf]) -> Result<String> {
    let mut node = Command::new(setup::emulator("node")?);
    node.arg(program).args(arguments).current_dir(folder).envs(Browser::ready()?.environment());
    let output = node.output().context("cannot start node")?;
    let [out, err] = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    ensure!(output.status.success(), "{program}: {out}{err}");
    Ok(out)
}

/// A package's module: its own, or the player's. Modules of other packages are imported by the packages' names.
fn module(source: &Path, name: &str) -> Result<Vec<u8>> {
    let own = source.join(name);
    let text = read(&if own.is_file() { own } else { source.join("../player").join(name) })?;
    let text = String::from_utf8(text).with_context(|| format!("{name} is no text"))?;
    Ok(text.replace("\"../decoder/", "\"@pantin/decoder/").replace("\"../player/", "\"./").into_bytes())
}

fn read(path: &Path) -> Result<Vec<u8>> {
    std::fs::read(path).with_context(|| path.display().to_string())
}
