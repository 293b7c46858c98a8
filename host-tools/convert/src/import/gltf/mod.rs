//! glTF 2.0, .gltf and .glb: one animation of a file as a motion of its nodes and morph weights.
//!
//! LINEAR, STEP and CUBICSPLINE tracks of places, weights and scales stay curves in time, which convert without a fit;
//! rotations are sampled and become Euler angles, or, if that is asked for and they are CUBICSPLINE, the four curves of a quaternion. Scales that change
//! become scalars, and in any case move the joints below.

mod accessor;
mod file;
mod joints;
mod list;
pub mod mesh;
mod place;
mod sampler;
mod scalars;
mod tree;

use super::from_transforms::{self, Affine};
use super::grid::{self, Grid};
use super::{Request, Source, units};
use crate::error::with_remedy;
use crate::events;
use crate::memory::Memory;
use crate::motion::{Event, Keys, Kind, Motion, Rig};
use crate::note::{Note, NoteKind, Remedy};
use anyhow::{Context, Result, anyhow, bail, ensure};
use file::{File, one_line};
use gltf::json::Root;
use gltf::json::animation::Property;
use gltf::json::validation::Checked;
pub use list::list;
use sampler::SamplerKeys;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// glTF's unit of length is the metre.
const CM_PER_UNIT: f64 = 100.0;
/// Figures of other heights make one doubt that the file's unit is the metre, in cm.
const PLAUSIBLE_CM: std::ops::RangeInclusive<f64> = 20.0..=500.0;

/// Whether `head` begins a glTF file.
pub fn begins(head: &[u8]) -> bool {
    let text = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head).trim_ascii_start();
    let asset = b"\"asset\"";
    head.starts_with(b"glTF") || (text.starts_with(b"{") && text.windows(asset.len()).any(|word| word == asset))
}

/// The files beside the glTF file `path` that hold its buffers.
pub(super) fn buffers(path: &Path, options: &Request) -> Result<Vec<PathBuf>> {
    Ok(File::open(path, &options.read(path)?, options)?.external_buffers())
}

/// Reads an animation of the glTF file `path`.
pub fn read(path: &Path, options: &Request) -> Result<Source> {
    let file = File::open(path, &options.read(path)?, options)?;
    let number = chosen(&file, path, options)?;
    let mut notes = file.notes.clone();
    let animations = &file.root.animations;
    if options.animation.is_none() && animations.len() > 1 {
        let first = named(number, &animations[number].name);
        let text = format!("animation {} of {}", one_line(&first), animations.len());
        notes.push(Note::warning(NoteKind::Animation, text).remedy(Remedy::ChooseAnimation));
    }
    let tracks = tracks(&file, number, &mut notes)?;
    if tracks.is_empty() {
        bail!(file.error(&format!("animations[{number}]"), "no channel moves a node or a weight"));
    }
    let place = || file.place(&format!("animations[{number}]"));
    let grid =
        grid::grid(&tracks.values().map(|track| track.times.as_slice()).collect::<Vec<_>>(), options.fps).with_context(place)?;
    notes.push(grid.note.clone());
    let tree = tree::tree(&file)?;
    check_size(&tracks, &tree, &grid, options.memory).with_context(place)?;
    let mut channels = joints::joints(&file, &tree, &tracks, &grid, options.quaternions)?;
    channels.scalars.extend(scalars::weights(&file, &tracks, &grid)?);
    scalars::tell_apart(&mut channels.scalars);
    notes.append(&mut channels.notes);
    let worlds = std::mem::take(&mut channels.worlds);
    let mut motion = channels.motion(&grid);
    if motion.rig.channels() == 0 && motion.frames > 1 {
        bail!(file.error(&format!("animations[{number}]"), "no channel moves a node of the scene, so nothing moves"));
    }
    motion.add_events(events(&file.root.animations[number], &grid, motion.frames, &mut notes));
    let error = from_transforms::error(&motion, &worlds.iter().map(Vec::as_slice).collect::<Vec<_>>());
    notes.extend(doubts(&file, &tree, &motion, options));
    Ok(Source { unit_known: true, error, sampled: options.fps.is_some(), ..Source::plain(motion, notes) })
}

/// The animation that the user names, by name or by number from 0, or the first.
fn chosen(file: &File, path: &Path, options: &Request) -> Result<usize> {
    let animations = &file.root.animations;
    if animations.is_empty() {
        bail!("{}: no animation, so nothing moves", path.display());
    }
    let Some(wanted) = &options.animation else { return Ok(0) };
    let called = animations.iter().map(|animation| animation.name.as_deref());
    super::animations::choose(wanted, called).ok_or_else(|| {
        let names: Vec<String> =
            animations.iter().enumerate().map(|(number, animation)| named(number, &animation.name)).collect();
        anyhow!("{}: no animation `{wanted}`: the file has {}", path.display(), one_line(&names.join(", ")))
    })
}

fn named(number: usize, name: &Option<String>) -> String {
    name.as_ref().map_or_else(|| number.to_string(), |name| format!("{number} ({name})"))
}

/// Events in an animation's `extras`: `events` or `markers`, a list of objects with `time` in seconds and `name`. Other objects are left out: what an
/// exporter keeps there is its own.
fn events(animation: &gltf::json::Animation, grid: &Grid, frames: usize, notes: &mut Vec<Note>) -> Vec<Event> {
    let extras = animation.extras.as_ref().and_then(|extras| serde_json::from_str::<serde_json::Value>(extras.get()).ok());
    let Some(extras) = extras else { return Vec::new() };
    let lists = ["events", "markers"].into_iter().filter_map(|key| extras[key].as_array());
    let entries = lists.flatten().filter(|entry| !entry["time"].is_null() && !entry["name"].is_null());
    let read = |entry: &serde_json::Value| {
        let time = entry["time"].as_f64().context("a time that is no number")?;
        let name = entry["name"].as_str().context("a name that is no text")?;
        events::check_name(name)?;
        let frame = ((time - grid.first) / grid.frame_time).round();
        ensure!((0.0..frames as f64).contains(&frame), "a time of {time} s, outside the animation");
        Ok(Event { frame: frame as usize, name: name.into() })
    };
    let (mut found, mut errors) = (Vec::new(), Vec::new());
    for entry in entries {
        match read(entry) {
            Ok(event) => found.push(event),
            Err(error) => errors.push(error),
        }
    }
    if let Some(first) = errors.first() {
        let (count, first) = (errors.len(), one_line(&first.to_string()));
        let text = format!("{count} of the animation's events are left out; of the first: {first}");
        notes.push(Note::warning(NoteKind::Events, text));
    }
    found
}

/// What moves a node or a mesh's weights.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Target {
    Translation(usize),
    Rotation(usize),
    Scale(usize),
    Weights(usize),
}

/// Tracks of an animation by node and property.
type Tracks = BTreeMap<Target, SamplerKeys>;

fn tracks(file: &File, number: usize, notes: &mut Vec<Note>) -> Result<Tracks> {
    let animation = &file.root.animations[number];
    check_keys(file, animation).with_context(|| file.place(&format!("animations[{number}]")))?;
    let mut tracks = Tracks::new();
    for (index, channel) in animation.channels.iter().enumerate() {
        let node = channel.target.node.value();
        let (target, components) = match channel.target.path {
            Checked::Valid(Property::Translation) => (Target::Translation(node), 3),
            Checked::Valid(Property::Rotation) => (Target::Rotation(node), 4),
            Checked::Valid(Property::Scale) => (Target::Scale(node), 3),
            Checked::Valid(Property::MorphTargetWeights) => (Target::Weights(node), 1),
            Checked::Invalid => bail!(file.error(&format!("animations[{number}].channels[{index}]"), "unknown target path")),
        };
        let track = SamplerKeys::read(file, number, animation, channel.sampler.value(), components)?;
        if tracks.insert(target, track).is_some() {
            let text = format!("animations[{number}].channels[{index}]: {target:?} has a channel already; the last one counts");
            notes.push(Note::warning(NoteKind::Joints, text));
        }
    }
    Ok(tracks)
}

/// Refuses keys that would fill the memory: any number of tracks may share one accessor.
fn check_keys(file: &File, animation: &gltf::json::Animation) -> Result<()> {
    file.memory().check_numbers(key_numbers(file, animation), "the keys of all tracks")
}

/// Numbers of the keys of an animation, at most.
fn key_numbers(file: &File, animation: &gltf::json::Animation) -> usize {
    // No accessor has more elements than its view has bytes: one that claims more is refused when it is read.
    let count = |index: usize| {
        let Some(accessor) = file.root.accessors.get(index) else { return 0 };
        let view = accessor.buffer_view.and_then(|view| file.root.buffer_views.get(view.value()));
        let most = view.map_or(accessor::MOST_ZEROS, |view| view.byte_length.0 as usize);
        (accessor.count.0 as usize).min(most)
    };
    let samplers = animation.channels.iter().filter_map(|channel| animation.samplers.get(channel.sampler.value()));
    // Of a key's time and the numbers of its value, of which rotations have most.
    let numbers =
        samplers.map(|sampler| count(sampler.input.value()).saturating_add(count(sampler.output.value()).saturating_mul(4)));
    numbers.fold(0, usize::saturating_add)
}

/// Refuses a motion that would fill the memory: two keys a year apart are a small file.
fn check_size(tracks: &Tracks, tree: &tree::Tree, grid: &Grid, memory: Memory) -> Result<()> {
    let stretches = tracks.keys().any(|target| matches!(target, Target::Scale(_)));
    let of_joint = if stretches { 27 } else { 18 };
    let of_tracks: usize = tracks.values().map(|track| 3 * track.components).sum();
    let numbers = (of_tracks + of_joint * tree.nodes.len()).saturating_mul(grid.frames);
    let frames = grid.frames;
    memory
        .check_numbers(numbers, "the tracks")
        .with_context(|| format!("{frames} frames are too many for this figure"))
        .map_err(|error| with_remedy(&error, Remedy::LowerFrameRate))
}

/// A channel of the motion: its values, and its curve where that is known.
pub(crate) struct Values {
    values: Vec<f64>,
    keys: Option<Keys>,
}

/// Joints and scalars with their channels.
#[derive(Default)]
struct Channels {
    joints: Vec<crate::motion::Joint>,
    of_joints: Vec<Values>,
    scalars: Vec<scalars::Weight>,
    /// World transforms of the first joints on the frames, as the file has them.
    worlds: Vec<Vec<Affine>>,
    notes: Vec<Note>,
}

impl Channels {
    fn motion(self, grid: &Grid) -> Motion {
        let (scalars, of_scalars): (Vec<_>, Vec<_>) = self.scalars.into_iter().map(scalars::Weight::split).unzip();
        let rig = Rig { joints: self.joints, scalars, cm_per_unit: CM_PER_UNIT, ..Rig::default() };
        let (values, keys) = self.of_joints.into_iter().chain(of_scalars).map(|entry| (entry.values, entry.keys)).unzip();
        Motion {
            rig,
            frame_time: grid.frame_time,
            frames: grid.frames,
            values,
            keys,
            looped: false,
            events: Vec::new(),
            origin: Default::default(),
        }
    }
}

/// What is odd, and what is not used.
fn doubts(file: &File, tree: &tree::Tree, motion: &Motion, options: &Request) -> Vec<Note> {
    let mut doubts = Vec::new();
    if let Some(node) = tree.outside.first() {
        let count = tree.outside.len();
        let text = format!("{count} moving nodes (nodes[{node}] is one) are outside of the scene and left out");
        doubts.push(Note::warning(NoteKind::Joints, text));
    }
    let height = units::posed_height_cm(motion);
    if options.cm_per_unit.is_none() && height > 0.0 && !PLAUSIBLE_CM.contains(&height) {
        let metres = height / 100.0;
        let note = Note::warning(NoteKind::Unit, format!("the figure is {metres:.4} m high in glTF's metres"));
        doubts.push(note.remedy(Remedy::StateCentimetre));
    }
    let left_out = file.root.nodes.len() - tree.nodes.iter().flatten().count() - tree.under.len();
    doubts.extend(unused(&file.root, left_out));
    doubts
}

/// A note about what motion does not need.
fn unused(root: &Root, left_out: usize) -> Option<Note> {
    let counts = [
        (left_out, "nodes that nothing moves"),
        (root.meshes.len(), "meshes"),
        (root.skins.len(), "skins' weights"),
        (root.materials.len(), "materials"),
        (root.images.len(), "images"),
        (root.cameras.len(), "cameras"),
    ];
    let present = counts.iter().filter(|(count, _)| *count > 0);
    let words: Vec<String> = present.map(|(count, what)| format!("{count} {what}")).collect();
    (!words.is_empty()).then(|| Note::info(NoteKind::Unread, format!("not used: {}", words.join(", "))))
}

/// The kinds of positions.
const POSITIONS: [Kind; 3] = [Kind::Xposition, Kind::Yposition, Kind::Zposition];
