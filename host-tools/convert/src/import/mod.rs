//! Motion files in: one file a format. [`load`] finds the format and settles the units.

mod acclaim;
pub mod amc;
mod angles;
pub mod arrays;
mod asf;
pub mod bvh;
mod ends;
mod expression;
pub mod fap;
mod fap_names;
#[cfg(feature = "fbx")]
pub mod fbx;
#[cfg(not(feature = "fbx"))]
#[path = "fbx_absent.rs"]
pub mod fbx;
mod files;
mod from_transforms;
#[cfg(feature = "gltf")]
pub mod gltf;
#[cfg(not(feature = "gltf"))]
#[path = "gltf_absent.rs"]
pub mod gltf;
mod grid;
mod helpers;
pub mod keyframes;
pub mod list;
pub mod livelink;
pub mod procedural;
mod scalars;
mod scales;
mod sheet;
pub mod table;
pub mod text;
mod timecode;
pub mod units;
pub mod up;
pub mod vrml;
mod written;

use crate::budget;
use crate::motion::{Motion, Up};
use anyhow::{Context, Result, bail, ensure};
pub use files::Files;
use pantin::codec::layout::MAX_CHANNELS;
use std::path::{Path, PathBuf};

/// What the user says about a source.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Length of the source's unit in cm, instead of a guess.
    pub cm_per_unit: Option<f64>,
    /// The direction that is vertical, instead of what the source says or of a guess.
    pub up: Option<Up>,
    /// Frames a second, for a source that does not say or says nonsense, and at which one with keys or times is sampled. A source of frames
    /// that states its rate keeps it: [`crate::edit::resample`] changes that.
    pub fps: Option<f64>,
    /// The skeleton of a motion that has its own in another file (AMC), instead of one found beside it.
    pub skeleton: Option<PathBuf>,
    /// Whether rotations on a glTF's CUBICSPLINE keys become the four curves of a quaternion, which convert without a fit, instead of Euler angles.
    pub quaternions: bool,
    /// Which animation of a file that holds several: its name, or its number from 0, instead of the first.
    pub animation: Option<String>,
    /// Where the source and what belongs to it is read from.
    pub files: Files,
}

/// What an importer read.
#[derive(Clone, Debug)]
pub struct Source {
    /// The motion; its rig's `cm_per_unit` counts only when `unit_known`.
    pub motion: Motion,
    /// Whether the format or the file states its unit of length.
    pub unit_known: bool,
    /// The greatest distance, in the source's unit, of a joint of the motion from where the file has it: places that waver by less than numbers are
    /// rounded to count as constant.
    pub error: f64,
    /// What was odd or could not be used, a sentence each.
    pub warnings: Vec<String>,
}

/// A motion ready for the other stages.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The motion; angles run on past half a turn instead of jumping.
    pub motion: Motion,
    /// The greatest distance in cm of a joint of the motion from where the file has it, over all frames: a bound against the file is a bound against
    /// the motion less this.
    pub error_cm: f64,
    /// Where its unit of length comes from, as a sentence for the user.
    pub units: String,
    /// What was odd or could not be used, a sentence each.
    pub warnings: Vec<String>,
}

/// A format that [`load`] knows.
struct Format {
    name: &'static str,
    extensions: &'static [&'static str],
    /// Whether a file that begins so is of this format, for files whose extension says nothing.
    begins: fn(&[u8]) -> bool,
    read: fn(&Path, &Options) -> Result<Source>,
}

impl Format {
    /// Whether its files may hold several motions.
    fn takes_animation(&self) -> bool {
        matches!(self.name, "glTF" | "FBX" | "VRML")
    }

    /// Whether its files take their skeleton from another one.
    fn takes_skeleton(&self) -> bool {
        self.name == "AMC"
    }
}

/// Whether `--animation` and `--skeleton` apply to the motion file `path`.
pub fn takes(path: &Path) -> Result<[bool; 2]> {
    let format = format_of(path, &Files::default())?;
    Ok([format.takes_animation(), format.takes_skeleton()])
}

/// Whether the motion file `path` is read at the times of `--fps`, from its first to its last, instead of frame by frame.
pub fn is_sampled(path: &Path, options: &Options) -> Result<bool> {
    let format = format_of(path, &options.files)?;
    let by_its_times = || (format.read)(path, &Options { fps: None, ..options.clone() }).is_ok();
    Ok(options.fps.is_some() && (format.takes_animation() || (format.name == "table" && by_its_times())))
}

/// One line a format. Of several with one extension, those that a file's begin tells stand before the one that takes all others.
const FORMATS: &[Format] = &[
    Format { name: "BVH", extensions: &["bvh"], begins: bvh::begins, read: bvh::read },
    Format { name: "AMC", extensions: &["amc"], begins: amc::begins, read: amc::read },
    Format { name: "glTF", extensions: &["glb", "gltf"], begins: gltf::begins, read: gltf::read },
    Format { name: "FBX", extensions: &["fbx"], begins: fbx::begins, read: fbx::read },
    Format { name: "VRML", extensions: &["wrl", "vrml", "x3dv"], begins: vrml::begins, read: vrml::read },
    Format { name: "key frames", extensions: &["keys"], begins: keyframes::begins, read: keyframes::read },
    Format { name: "procedural motion", extensions: &["proc"], begins: procedural::begins, read: procedural::read },
    Format { name: "FAP", extensions: &["fap"], begins: fap::begins, read: fap::read },
    Format { name: "Live Link Face", extensions: &["csv"], begins: livelink::begins, read: livelink::read },
    Format { name: "table", extensions: &["csv", "tsv"], begins: table::begins, read: table::read },
];

/// Bytes at the front of a file from which its format can be told.
const HEAD: u64 = 1024;

/// Reads the motion file `path`. Errors name the file and, where the format has them, the line.
pub fn load(path: &Path, options: &Options) -> Result<Imported> {
    if let Some(fps) = options.fps {
        ensure!(fps.is_finite() && fps > 0.0, "--fps {fps}: expected a number above 0");
    }
    let format = format_of(path, &options.files)?;
    let place = || path.display().to_string();
    if let Some(animation) = &options.animation {
        ensure!(format.takes_animation(), "{}: --animation {animation}: a file of {} holds one motion", place(), format.name);
    }
    if let Some(skeleton) = &options.skeleton {
        let (skeleton, name) = (skeleton.display(), format.name);
        ensure!(format.takes_skeleton(), "{}: --skeleton {skeleton}: only an .amc takes one, and this is {name}", place());
    }
    let source = (format.read)(path, options)?;
    let Source { mut motion, unit_known, error, mut warnings } = source;
    warnings.extend(replaced(&motion));
    ensure!(
        motion.rig.channels() <= MAX_CHANNELS,
        "{}: {} channels; a rig holds at most {MAX_CHANNELS}",
        place(),
        motion.rig.channels()
    );
    // Formats of rows hold as many bytes as they take; all others can ask for any number of frames.
    if !matches!(format.name, "BVH" | "AMC") {
        budget::check(motion.frames, motion.rig.channels()).with_context(place)?;
    }
    let known = unit_known.then_some(motion.rig.cm_per_unit);
    let unit = units::settle(&motion, options.cm_per_unit, known).with_context(|| path.display().to_string())?;
    motion.rig.cm_per_unit = unit.cm_per_unit;
    // These formats state that y is up, or are turned so that it is; they come from programs whose rigs have joints to steer by.
    let stated = matches!(format.name, "glTF" | "FBX" | "VRML");
    motion.rig.up = options.up.unwrap_or_else(|| if stated { Up::Y } else { up::guess(&motion) });
    if stated {
        helpers::mark(&mut motion.rig);
    }
    unwrap_angles(&mut motion);
    Ok(Imported { error_cm: error * motion.rig.cm_per_unit, motion, units: unit.sentence, warnings })
}

/// A sentence about names with letters that the file has not as UTF-8 text.
fn replaced(motion: &Motion) -> Option<String> {
    let joints = motion.rig.joints.iter().map(|joint| &joint.name);
    let names =
        joints.chain(motion.rig.scalars.iter().map(|scalar| &scalar.name)).chain(motion.events.iter().map(|event| &event.name));
    let odd: Vec<String> =
        names.filter(|name| name.contains(char::REPLACEMENT_CHARACTER)).map(|name| text::quoted(name)).collect();
    let first = odd.first()?;
    let many = if odd.len() > 1 { format!("{} names, as {first}, have", odd.len()) } else { format!("the name {first} has") };
    Some(format!("{many} letters that are not UTF-8, in place of which there is {}", char::REPLACEMENT_CHARACTER))
}

/// Whether `bytes`, the content of `path`, are of a format that [`load`] knows, by their name or by how they begin.
pub fn looks_like_motion(path: &Path, bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(HEAD as usize)];
    is_motion(path) || FORMATS.iter().any(|format| (format.begins)(head))
}

/// Whether a file's name says that it is of a format that [`load`] knows.
pub fn is_motion(path: &Path) -> bool {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    FORMATS.iter().any(|format| format.extensions.contains(&extension.as_str()))
}

fn format_of(path: &Path, files: &Files) -> Result<&'static Format> {
    let place = || path.display().to_string();
    ensure!(!path.is_dir(), "{}: a directory; expected a motion file", place());
    let head = files.head(path, HEAD)?;
    ensure!(!head.is_empty(), "{}: the file is empty; expected a motion file", place());
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    let of_extension = || FORMATS.iter().filter(|format| format.extensions.contains(&extension.as_str()));
    let clip = head.starts_with(&pantin::codec::layout::MAGIC) || head.starts_with(&pantin::codec::layout::BANK_MAGIC);
    ensure!(!clip, "{}: a clip or a bank, not a motion; `pantin expand` turns a clip back into one", place());
    let by_extension = of_extension().find(|format| (format.begins)(&head)).or_else(|| of_extension().next_back());
    let Some(format) = by_extension.or_else(|| FORMATS.iter().find(|format| (format.begins)(&head))) else {
        let known: Vec<String> =
            FORMATS.iter().map(|format| format!("{} (.{})", format.name, format.extensions.join(", ."))).collect();
        bail!("{}: unknown kind of file; expected {}", place(), known.join(" or "));
    };
    Ok(format)
}

/// Messages that quote a file stay short and on their line.
pub fn one_line(text: &str) -> String {
    text.chars().take(200).map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// The files that `path` is read with, as far as can be told without importing it: skeletons that lie beside an .amc, and a glTF's buffers.
pub fn companions(path: &Path) -> Vec<PathBuf> {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    match extension.as_str() {
        "amc" => amc::skeletons(path, &Files::default()).unwrap_or_default(),
        "glb" | "gltf" => gltf::buffers(path).unwrap_or_default(),
        _ => Vec::new(),
    }
}

/// The whole content of the machine's file `path`.
fn read_bytes(path: &Path) -> Result<Vec<u8>> {
    Files::default().read(path)
}

/// Adds whole turns so that no Euler angle moves by more than half a turn from one frame to the next (docs/METHOD.md 5).
/// Curves through keys run as their keys say.
pub fn unwrap_angles(motion: &mut Motion) {
    let kinds = motion.rig.channel_kinds();
    for ((values, (_, kind)), keys) in motion.values.iter_mut().zip(kinds).zip(&motion.keys) {
        if !kind.is_rotation() || keys.is_some() {
            continue;
        }
        let mut turns = 0.0;
        for frame in 1..values.len() {
            turns += ((values[frame - 1] - values[frame] - turns) / 360.0).round() * 360.0;
            values[frame] += turns;
        }
    }
}
