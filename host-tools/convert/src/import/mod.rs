//! Motion files in: one file a format, one entry in [`FORMATS`]. [`import`] finds the format and settles the units.

mod acclaim;
mod amc;
mod angles;
pub mod animations;
pub mod arrays;
mod asf;
mod bvh;
mod bvh_stream;
mod ends;
mod expression;
mod fap;
mod fap_names;
#[cfg(feature = "fbx")]
mod fbx;
#[cfg(not(feature = "fbx"))]
#[path = "fbx_absent.rs"]
mod fbx;
mod files;
mod format;
mod from_transforms;
#[cfg(feature = "gltf")]
mod gltf;
#[cfg(not(feature = "gltf"))]
#[path = "gltf_absent.rs"]
mod gltf;
mod grid;
mod helpers;
mod keyframes;
mod livelink;
mod options;
mod procedural;
mod request;
mod scalars;
pub(crate) mod scales;
mod sheet;
mod table;
pub mod text;
mod timecode;
pub mod units;
pub mod up;
mod vrml;
mod written;
#[cfg(feature = "zip")]
mod zip;
#[cfg(not(feature = "zip"))]
#[path = "zip_absent.rs"]
mod zip;

use crate::error::{Error, Setting, require};
use crate::motion::{Event, Motion, Origin, Rig, Up};
use crate::note::{Note, NoteKind};
use anyhow::{Context, Result};
pub use bvh_stream::{BvhStream, Head};
pub use files::{Disk, Files, InMemory, read as read_file, read_from};
pub use format::{FORMATS, Format};
#[cfg(feature = "gltf")]
pub use gltf::mesh;
pub use livelink::live_link_name;
pub use options::ImportOptions;
pub(crate) use request::Request;
use std::path::{Path, PathBuf};

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
    /// Whether the file was read at the times of [`ImportOptions::fps`], from its first to its last, instead of frame by frame.
    pub sampled: bool,
    /// Whether unit, vertical direction and angles are settled: the motion was imported from a file inside of this one.
    pub settled: bool,
    /// What was odd or could not be used.
    pub notes: Vec<Note>,
}

impl Source {
    /// A source of frames that is read as it is, and states no unit of length.
    fn plain(motion: Motion, notes: Vec<Note>) -> Source {
        Source { motion, unit_known: false, error: 0.0, sampled: false, settled: false, notes }
    }
}

/// A motion ready for edits and conversion.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Imported {
    /// The motion; angles run on past half a turn instead of jumping.
    pub motion: Motion,
    /// What was odd, what could not be used, and where the unit of length comes from.
    pub notes: Vec<Note>,
}

/// Bytes at the front of a file from which its format can be told.
const HEAD: u64 = 1024;

/// Reads the motion `name` among `files`. Errors name the file and, where the format has them, the line.
pub fn import(files: &dyn Files, name: &Path, options: &ImportOptions) -> Result<Imported, Error> {
    imported(name, &Request::new(files, options)).map_err(|error| Error::of(&error, Error::source))
}

/// Reads the motion file `path` of this machine.
pub fn load(path: &Path, options: &ImportOptions) -> Result<Imported, Error> {
    import(&Disk::new(options.memory), path, options)
}

/// The animations of the file `name`: of a glTF or FBX file, the time sensors of a VRML world, or the motions of an archive with several. Other
/// formats hold one motion without a name.
pub fn list(files: &dyn Files, name: &Path, options: &ImportOptions) -> Result<Vec<animations::Entry>, Error> {
    let request = Request::new(files, options);
    format_of(name, &request).and_then(|format| (format.list)(name, &request)).map_err(|error| Error::of(&error, Error::source))
}

fn imported(path: &Path, request: &Request) -> Result<Imported> {
    if let Some(fps) = request.fps {
        require!(fps.is_finite() && fps > 0.0, Error::value(Setting::FrameRate, fps, "expected a number above 0"));
    }
    let format = format_of(path, request)?;
    let place = || path.display().to_string();
    check_settings(format, request).with_context(place)?;
    let Source { mut motion, unit_known, error, sampled, settled, mut notes } = (format.read)(path, request)?;
    if settled {
        motion.origin.bytes = request.bytes_read();
        return Ok(Imported { motion, notes });
    }
    notes.extend(replaced(&motion.rig, &motion.events));
    let channels = motion.rig.channels();
    if !format.has_rows {
        request.memory.check(motion.frames, channels).with_context(place)?;
    }
    if motion.rig.joints.is_empty() {
        let given = [(Setting::Unit, request.cm_per_unit.is_some()), (Setting::Up, request.up.is_some())];
        let given = given.into_iter().filter(|(_, given)| *given);
        notes.extend(given.map(|(setting, _)| Note::no_effect(setting, "the motion has no joints")));
    }
    let known = unit_known.then_some(motion.rig.cm_per_unit);
    let (unit, note) = units::settle(&motion, request.cm_per_unit, known).with_context(place)?;
    motion.rig.cm_per_unit = unit;
    notes.push(note);
    motion.rig.up = request.up.unwrap_or_else(|| if format.states_up { Up::Y } else { up::guess(&motion) });
    if format.states_up {
        helpers::mark(&mut motion.rig);
    }
    unwrap_angles(&mut motion);
    motion.origin = Origin {
        error_cm: error * unit,
        sampled_fps: request.fps.filter(|_| sampled),
        bytes: request.bytes_read(),
        retarget_max_cm: None,
    };
    Ok(Imported { motion, notes })
}

/// Refuses settings that do not apply to files of a format.
fn check_settings(format: &Format, request: &Request) -> Result<()> {
    let name = format.name;
    if let Some(animation) = &request.animation {
        let reason = format!("a file of {name} holds one motion");
        require!(format.has_animations, Error::value(Setting::Animation, animation, reason));
    }
    if let Some(skeleton) = &request.skeleton {
        let reason = format!("only an .amc takes one, and this is {name}");
        require!(format.has_skeleton, Error::value(Setting::Skeleton, skeleton.display(), reason));
    }
    Ok(())
}

/// A warning about names with letters that the file has not as UTF-8 text.
fn replaced(rig: &Rig, events: &[Event]) -> Option<Note> {
    let joints = rig.joints.iter().map(|joint| &joint.name);
    let names = joints.chain(rig.scalars.iter().map(|scalar| &scalar.name)).chain(events.iter().map(|event| &event.name));
    let odd: Vec<String> =
        names.filter(|name| name.contains(char::REPLACEMENT_CHARACTER)).map(|name| text::quoted(name)).collect();
    let first = odd.first()?;
    let many = if odd.len() > 1 { format!("{} names, as {first}, have", odd.len()) } else { format!("the name {first} has") };
    let text = format!("{many} letters that are not UTF-8, in place of which there is {}", char::REPLACEMENT_CHARACTER);
    Some(Note::warning(NoteKind::Names, text))
}

/// Whether `bytes`, the content of `path`, are of a format that [`import`] knows, by their name or by how they begin.
pub fn looks_like_motion(path: &Path, bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(HEAD as usize)];
    is_motion(path) || FORMATS.iter().any(|format| (format.begins)(head))
}

/// Whether a file's name says that it is of a format that [`import`] knows.
pub fn is_motion(path: &Path) -> bool {
    FORMATS.iter().any(|format| format.names(path))
}

/// The format of the file `path`, by its name and first bytes.
pub fn format(files: &dyn Files, path: &Path) -> Result<&'static Format, Error> {
    format_of(path, &Request::new(files, &ImportOptions::new())).map_err(|error| Error::of(&error, Error::source))
}

fn format_of(path: &Path, request: &Request) -> Result<&'static Format> {
    let refuse = |text: &str| Error::source(format!("{}: {text}", path.display()));
    require!(!path.is_dir(), refuse("a directory; expected a motion file"));
    let head = request.head(path, HEAD)?;
    require!(!head.is_empty(), refuse("the file is empty; expected a motion file"));
    let clip = head.starts_with(&pantin::codec::layout::MAGIC) || head.starts_with(&pantin::codec::layout::BANK_MAGIC);
    require!(!clip, refuse("a clip or a bank, not a motion; expand a clip to turn it back into one"));
    let of_extension = || FORMATS.iter().filter(|format| format.names(path));
    let by_extension = of_extension().find(|format| (format.begins)(&head)).or_else(|| of_extension().next_back());
    let found = by_extension.or_else(|| FORMATS.iter().find(|format| (format.begins)(&head)));
    found.ok_or_else(|| {
        let known: Vec<String> = FORMATS.iter().map(Format::sentence).collect();
        refuse(&format!("unknown kind of file; expected {}", known.join(" or "))).into()
    })
}

/// Messages that quote a file stay short and on their line.
pub fn one_line(text: &str) -> String {
    text.chars().take(200).map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// The files that `path` is read with, as far as can be told without importing it: skeletons that lie beside an .amc, and a glTF's buffers.
pub fn companions(files: &dyn Files, path: &Path) -> Vec<PathBuf> {
    let options = ImportOptions::new();
    let request = Request::new(files, &options);
    let found = FORMATS.iter().filter(|format| format.names(path)).map(|format| (format.companions)(path, &request));
    found.flat_map(Result::unwrap_or_default).collect()
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
