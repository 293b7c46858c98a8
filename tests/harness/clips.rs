//! Clips made by the host tool, for tests that play them.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use pantin::Clip;
use pantin_face::MODEL;
use pantin_face::{Binding, Model};

use crate::build;
use crate::paths;
use crate::qemu::{LM3S6965EVB, Machine};

/// Returns the boards' feature that draws faces if any of the clips drives one, otherwise none.
pub fn feature(clips: &[&Path]) -> Result<&'static str> {
    let model = Model::new_checked(MODEL).map_err(|error| anyhow::anyhow!("{error}"))?;
    for path in clips {
        let bytes = std::fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
        let clip = Clip::new_checked(&bytes).map_err(|error| anyhow::anyhow!("{}: {error}", path.display()))?;
        if Binding::new(&clip.rig(), &model).is_face() {
            return Ok("face");
        }
    }
    Ok("")
}

/// Returns the features with which a board plays these clips: `face` if one drives a face, and on the reference board the feature
/// for large rigs.
pub fn features(machine: Machine, clips: &[&Path]) -> Result<String> {
    let large = if machine.name == LM3S6965EVB.name { "large" } else { "" };
    Ok([large, feature(clips)?].into_iter().filter(|feature| !feature.is_empty()).collect::<Vec<_>>().join(","))
}

/// Converts a motion, whose joints are then drawn as lines, to a clip in `folder`: places alone are bounded, by the default.
pub fn convert(motion: &Path, folder: &Path) -> Result<PathBuf> {
    let name = motion.file_stem().unwrap_or(motion.as_os_str());
    let clip = folder.join(name).with_extension("ptn");
    let output = Command::new(build::host_tool()?)
        .args(["convert", "--places-only", "--segments"])
        .arg(motion)
        .arg("-o")
        .arg(&clip)
        .output();
    let output = output.context("cannot start the host tool")?;
    let words = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "{}: {}", motion.display(), words.trim());
    Ok(clip)
}

/// The folders and files of our motions, in the order in which boards play them: first those of a body, then faces.
const MOTIONS: [&str; 6] = ["walk.keys", "greet.keys", "library", "face", "kneebend.keys", "emotes"];

/// What a figure is drawn as, and with that what a clip keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drawn {
    /// Lines between joints: their places alone are bounded.
    Lines,
    /// A body with volume: joints keep how they are turned, too, as the head does.
    Solid,
}

/// Converts all our motions to clips of 60 frames per second in `folder`. Those of the library are one bank.
pub fn own(folder: &Path, drawn: Drawn) -> Result<Vec<PathBuf>> {
    let places = if drawn == Drawn::Lines { &["--places-only"][..] } else { &[] };
    let convert_own = |motions: &[&Path], words: &[&str], out: &Path| convert_own(motions, &[places, words].concat(), out);
    let mut clips = vec![];
    for name in MOTIONS {
        let motion = paths::root().join("motions").join(name);
        if name == "library" {
            let bank = folder.join("library.ptb");
            convert_own(&[&motion], &["--same-form", "--max-error", "0.5cm"], &bank)?;
            clips.push(bank);
        } else if motion.is_dir() {
            let own = folder.join(name);
            convert_own(&[&motion], &[], &own)?;
            let files = std::fs::read_dir(&own).with_context(|| own.display().to_string())?;
            let mut files: Vec<PathBuf> = files.map(|file| Ok(file?.path())).collect::<Result<_>>()?;
            files.retain(|file| file.extension().is_some_and(|extension| extension == "ptn"));
            files.sort();
            clips.append(&mut files);
        } else {
            let clip = folder.join(name).with_extension("ptn");
            convert_own(&[&motion], &[], &clip)?;
            clips.push(clip);
        }
    }
    Ok(clips)
}

/// Converts a motion to a clip of this rate whose joints keep how they are turned.
pub fn convert_at(motion: &Path, rate: u32, clip: &Path) -> Result<()> {
    let output = Command::new(build::host_tool()?)
        .args(["convert", "--segments", "--quiet", "--fps", &rate.to_string()])
        .arg(motion)
        .arg("-o")
        .arg(clip)
        .output();
    let output = output.context("cannot start the host tool")?;
    ensure!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr).trim());
    Ok(())
}

fn convert_own(motions: &[&Path], words: &[&str], out: &Path) -> Result<()> {
    let mut command = Command::new(build::host_tool()?);
    command.args(["convert", "--segments"]).args(motions).args(["--fps", "60", "--quiet"]).args(words).arg("-o").arg(out);
    let output = command.output().context("cannot start the host tool")?;
    ensure!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr).trim());
    Ok(())
}
