//! `cargo xtask blender [--python PROGRAM] [--validator FOLDER]`: what others read of our exports.
//!
//! Blender's own importers come with the Python package `bpy` (`pip install bpy`, about 1 GB); `gltf-validator` is an npm package.
//! Without one of them its part is skipped with a message.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail, ensure};
use clap::Args;
use harness::{build, paths};
use serde::Deserialize;
use tempfile::TempDir;

const SCRIPT: &str = include_str!("blender.py");
const VALIDATE: &str = include_str!("gltf_validator.mjs");
/// What both scripts print before their JSON: Blender prints lines of its own.
const MARK: &str = "PANTIN ";
/// Joints with one, two and no rotation channels, a name twice, and a leaf without an End Site.
const ODD: &str = "HIERARCHY
ROOT hip
{
  OFFSET 0 0 0
  CHANNELS 4 Yposition Zrotation Xrotation Yrotation
  JOINT arm { OFFSET 0 40 0 CHANNELS 1 Xrotation JOINT hand { OFFSET 0 30 0 CHANNELS 2 Zrotation Yrotation } }
  JOINT arm { OFFSET 9 40 0 CHANNELS 0 JOINT tip { OFFSET 0 30 0 CHANNELS 1 Yrotation End Site { OFFSET 0 9 0 } } }
}
MOTION
Frames: 3
Frame Time: 0.0333333
90 0 0 0 0 0 0 0
91 0 5 0 20 7 0 30
92 0 9 0 40 9 5 60
";

/// Imports exports of our clips into Blender, and validates the glTF files
#[derive(Args)]
pub struct Blender {
    /// The Python that has the package bpy
    #[arg(long, default_value = "python3")]
    python: String,
    /// The folder whose node_modules has the package gltf-validator
    #[arg(long, default_value = ".")]
    validator: PathBuf,
}

/// What Blender made of a file.
#[derive(Debug, Deserialize)]
struct Imported {
    armatures: usize,
    bones: usize,
    actions: usize,
    curves: usize,
    shapes: usize,
}

/// An exported file, and what must be found in it.
struct Export {
    path: PathBuf,
    bones: usize,
    shapes: usize,
}

impl Blender {
    /// Exports, imports and validates; fails if a file is not read as it should be.
    pub fn run(self) -> Result<()> {
        let folder = TempDir::new()?;
        let exports = exports(folder.path())?;
        match self.import(&exports, folder.path())? {
            None => println!("skipped: {} has no package bpy; pip install bpy brings Blender's importers", self.python),
            Some(imported) => {
                for (export, found) in exports.iter().zip(imported) {
                    println!("{:14} {found:?}", export.name());
                    let Imported { armatures, bones, actions, curves, shapes } = found;
                    let armature = usize::from(export.bones > 0);
                    ensure!(
                        (armatures, bones, actions, shapes) == (armature, export.bones, 1, export.shapes) && curves > 0,
                        "{}: expected {armature} armatures with {} bones, and {} shapes",
                        export.name(),
                        export.bones,
                        export.shapes
                    );
                }
            }
        }
        let glb: Vec<&Export> = exports.iter().filter(|export| export.path.extension().is_some_and(|end| end == "glb")).collect();
        match self.validate(&glb, folder.path())? {
            None => println!("skipped: no gltf-validator; npm install gltf-validator brings it, --validator names its folder"),
            Some(found) => {
                let wrong: Vec<String> = glb
                    .iter()
                    .zip(found)
                    .flat_map(|(export, found)| found.into_iter().map(|line| export.name() + ": " + &line))
                    .collect();
                ensure!(wrong.is_empty(), "gltf-validator reports:\n{}", wrong.join("\n"));
                println!("gltf-validator: {} files without errors and warnings", glb.len());
            }
        }
        Ok(())
    }

    /// `None` without bpy.
    fn import(&self, exports: &[Export], folder: &Path) -> Result<Option<Vec<Imported>>> {
        let has = Command::new(&self.python).args(["-c", "import bpy"]).output().is_ok_and(|output| output.status.success());
        if !has {
            return Ok(None);
        }
        let script = folder.join("blender.py");
        std::fs::write(&script, SCRIPT)?;
        printed(Command::new(&self.python).arg(script), exports.iter()).map(Some)
    }

    /// `None` without the validator.
    fn validate(&self, exports: &[&Export], folder: &Path) -> Result<Option<Vec<Vec<String>>>> {
        if !self.validator.join("node_modules/gltf-validator").is_dir() {
            return Ok(None);
        }
        let script = folder.join("gltf_validator.mjs");
        std::fs::write(&script, VALIDATE)?;
        let validator = self.validator.canonicalize()?;
        printed(Command::new("node").arg(script).arg(validator), exports.iter().copied()).map(Some)
    }
}

impl Export {
    fn name(&self) -> String {
        self.path.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }
}

/// The JSON that a script prints about the files.
fn printed<'e, T: for<'a> Deserialize<'a>>(command: &mut Command, exports: impl Iterator<Item = &'e Export>) -> Result<T> {
    let output = command.args(exports.map(|export| &export.path)).output().context("the script cannot be started")?;
    let text = String::from_utf8_lossy(&output.stdout);
    let Some(json) = text.lines().find_map(|line| line.strip_prefix(MARK)) else {
        bail!("a file cannot be read:\n{}{}", text, String::from_utf8_lossy(&output.stderr));
    };
    Ok(serde_json::from_str(json)?)
}

/// Every clip of ours, and one with odd joints, as .glb and, where the format holds them, as .bvh.
fn exports(folder: &Path) -> Result<Vec<Export>> {
    let tool = build::host_tool()?;
    std::fs::write(folder.join("odd.bvh"), ODD)?;
    let done =
        Command::new(&tool).arg("convert").arg(folder.join("odd.bvh")).args(["-q", "-o"]).arg(folder.join("odd.ptn")).output()?;
    ensure!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let motions = paths::root().join("motions");
    let names = ["walk", "run", "greet", "kneebend", "face/joy"].map(|name| motions.join(name).with_extension("ptn"));
    let mut exports = Vec::new();
    for clip in names.into_iter().chain([folder.join("odd.ptn")]) {
        let bytes = std::fs::read(&clip).with_context(|| clip.display().to_string())?;
        let opened = pantin::Clip::new_checked(&bytes)?;
        let (rig, stem) = (opened.rig(), clip.file_stem().unwrap_or_default().to_os_string());
        for format in ["bvh", "glb"] {
            // A .bvh holds no scalars.
            if format == "bvh" && rig.scalars().count() > 0 {
                continue;
            }
            // Beside the clips of the repository nothing is written.
            let path = folder.join(&stem).with_extension(format!("out.{format}"));
            let done = Command::new(&tool).arg("expand").arg(&clip).args(["-q", "-o"]).arg(&path).output()?;
            ensure!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
            // Blender makes bones of a BVH's joints, and of every node of a glTF's skin.
            let bones = rig.joints().filter(|joint| format == "glb" || !joint.end_site).count();
            exports.push(Export { path, bones, shapes: rig.scalars().count() });
        }
    }
    Ok(exports)
}
