//! VRML97 and X3D in its classic encoding: what time sensors move through interpolators, as a motion of the world's transforms.
//!
//! The scene graph is evaluated on the frames, with centers, scales and their orientations; rotations become Euler angles.

mod figure;
mod interpolator;
mod lexer;
mod parse;
mod time_sensor;
mod world;

use super::animations::{self, Entry};
use super::from_transforms::{self, Figure, Node};
use super::grid::{self, Grid};
use super::{Request, Source, one_line};
use crate::memory::Memory;
use crate::motion::Scalar;
use crate::note::{Note, NoteKind, Remedy};
use anyhow::{Context, Result, anyhow, bail};
use lexer::Words;
use std::collections::HashSet;
use std::path::Path;
use time_sensor::{TimeSensor, Tracks};
use world::{World, is_transform};

/// Whether `head` begins a world.
pub fn begins(head: &[u8]) -> bool {
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
    head.starts_with(b"#VRML V2.0") || head.starts_with(b"#X3D V3")
}

/// Reads what the longest time sensors of the world `path` move, or the one that is asked for.
pub fn read(path: &Path, options: &Request) -> Result<Source> {
    let place = || path.display().to_string();
    let bytes = options.read(path)?;
    let (words, world) = open(path, &bytes)?;
    let clocks = time_sensor::clocks(&world).with_context(place)?;
    let chosen = chosen(&world, &clocks, options.animation.as_deref()).with_context(place)?;
    let tracks = time_sensor::tracks(&world, &chosen, &words)?;
    if tracks.times().is_empty() {
        bail!("{}: the interpolators have no keys, so nothing moves", place());
    }
    let grid = frames(&tracks, chosen[0], options.fps).with_context(place)?;
    let figure = motion(&world, &clocks, &tracks, &grid, &words, options.memory).with_context(place)?;
    let mut notes = vec![grid.note.clone()];
    notes.extend(figure.notes);
    notes.extend(doubts(&world, &clocks, &chosen));
    let outside = |time: &&f64| !(0.0..=chosen[0].seconds * (1.0 + 1e-6)).contains(*time);
    if let Some(time) = tracks.times().into_iter().flatten().find(outside) {
        let part = time / chosen[0].seconds;
        let text = format!("keys outside the cycle are never reached, as one at {part:.3}; a cycle goes from 0 to 1");
        notes.push(Note::warning(NoteKind::Unread, text));
    }
    let sampled = options.fps.is_some();
    Ok(Source { error: figure.error, sampled, ..Source::plain(figure.motion, notes) })
}

/// The time sensors of the world `path` that move anything.
pub fn list(path: &Path, options: &Request) -> Result<Vec<Entry>> {
    let bytes = options.read(path)?;
    let (words, world) = open(path, &bytes)?;
    let entry = |clock: &TimeSensor| {
        let tracks = time_sensor::tracks(&world, &[clock], &words)?;
        let name = world.nodes[clock.node].def.as_deref().map(one_line);
        if tracks.times().is_empty() {
            return Ok(Entry { name, frames: 0, fps: 0.0, tracks: 0 });
        }
        let grid = frames(&tracks, clock, options.fps).with_context(|| path.display().to_string())?;
        Ok(Entry { name, frames: grid.frames, fps: 1.0 / grid.frame_time, tracks: tracks.times().len() })
    };
    time_sensor::clocks(&world).with_context(|| path.display().to_string())?.iter().map(entry).collect()
}

/// Frames of a whole cycle: the figure holds its first and last key.
fn frames(tracks: &Tracks, clock: &TimeSensor, fps: Option<f64>) -> Result<Grid> {
    grid::between(0.0, clock.seconds, fps, interpolator::distance(&tracks.times(), clock.seconds))
}

fn open<'a>(path: &'a Path, bytes: &'a [u8]) -> Result<(Words<'a>, World)> {
    let words = Words::new(path, bytes);
    if bytes.starts_with(b"\x1f\x8b") {
        bail!("{}: the file is compressed; gunzip it first", path.display());
    }
    if bytes.starts_with(b"#VRML V1") {
        bail!(words.error("VRML 1.0 has no motion; expected `#VRML V2.0`"));
    }
    let world = parse::world(words.clone())?;
    Ok((words, world))
}

/// The clock that the user names, by its sensor's name or by number from 0, or those with the longest cycle.
fn chosen<'c>(world: &World, clocks: &'c [TimeSensor], wanted: Option<&str>) -> Result<Vec<&'c TimeSensor>> {
    let longest = clocks.iter().map(|clock| clock.seconds).fold(0.0, f64::max);
    if clocks.is_empty() {
        bail!("no TimeSensor moves anything through an interpolator");
    }
    let Some(wanted) = wanted else { return Ok(clocks.iter().filter(|clock| clock.seconds == longest).collect()) };
    let chosen = animations::choose(wanted, clocks.iter().map(|clock| world.nodes[clock.node].def.as_deref()));
    chosen.map(|number| vec![&clocks[number]]).ok_or_else(|| {
        let names = clocks.iter().enumerate().map(|(number, clock)| format!("{number} ({})", world.name(clock.node)));
        anyhow!("no time sensor `{wanted}`: the file has {}", one_line(&names.collect::<Vec<_>>().join(", ")))
    })
}

fn motion(world: &World, clocks: &[TimeSensor], tracks: &Tracks, grid: &Grid, words: &Words, memory: Memory) -> Result<Figure> {
    let stands = figure::stands(world, words)?;
    // The figure is the same for every clock.
    let drives = clocks.iter().flat_map(|clock| &clock.drives);
    let moved: HashSet<usize> = drives.filter(|drive| drive.place(world).is_some()).map(|drive| drive.target).collect();
    let kept = from_transforms::figure(&figure::roles(world, &stands, |node| moved.contains(&node)))?;
    let scales = tracks.moves.keys().filter(|(_, field)| *field == figure::SCALE).count();
    from_transforms::check_size(kept.len(), tracks.scalars.len() + 3 * scales, grid, memory)?;
    let seconds = |frame: usize| grid.first + frame as f64 * grid.frame_time;
    let vector = |value: &[f64]| std::array::from_fn(|axis| value.get(axis).copied().unwrap_or(0.0));
    let mut joint_of = vec![None; stands.len()];
    let mut joints: Vec<Node> = Vec::with_capacity(kept.len());
    for (joint, &stand) in kept.iter().enumerate() {
        joint_of[stand] = Some(joint);
        let parent = stands[stand].parent.and_then(|parent| joint_of[parent]);
        let node = stands[stand].node;
        let scale = tracks.moves.get(&(node, figure::SCALE));
        let scales = scale.map(|track| (0..grid.frames).map(|frame| vector(&track.at(seconds(frame)))).collect());
        let worlds = Vec::with_capacity(grid.frames);
        joints.push(Node { name: world.name(node), parent, worlds, scales: scales.unwrap_or_default() });
    }
    let stands = figure::needed(world, &stands, &kept);
    for frame in 0..if joints.is_empty() { 0 } else { grid.frames } {
        let worlds = figure::evaluate(&stands, &tracks.moves, seconds(frame));
        joints.iter_mut().zip(&worlds[worlds.len() - kept.len()..]).for_each(|(joint, world)| joint.worlds.push(*world));
    }
    let scalar = |(name, track): &(String, interpolator::InterpolatorKeys)| {
        let values: Vec<f64> = (0..grid.frames).map(|frame| track.at(seconds(frame))[0]).collect();
        let full_scale = values.iter().fold(1.0, |largest: f64, value| largest.max(value.abs()));
        (Scalar { name: name.clone(), full_scale }, values)
    };
    from_transforms::motion(joints, tracks.scalars.iter().map(scalar).collect(), grid)
}

/// Which clock runs, and what is not used.
fn doubts(world: &World, clocks: &[TimeSensor], chosen: &[&TimeSensor]) -> Vec<Note> {
    let mut doubts = Vec::new();
    if clocks.len() > chosen.len() {
        let (count, first) = (clocks.len(), chosen[0]);
        let name = world.name(first.node);
        let text = format!("{count} time sensors; `{name}` with {} s is read", first.seconds);
        doubts.push(Note::warning(NoteKind::Animation, text).remedy(Remedy::ChooseAnimation));
    }
    for clock in chosen {
        if let Some(wrong) = &clock.wrong {
            let (name, line) = (world.name(clock.node), world.nodes[clock.node].line);
            let text = format!("`{name}` (line {line}) has the cycleInterval {wrong}; expected more than 0, and 1 s is taken");
            doubts.push(Note::warning(NoteKind::FrameRate, text).at_line(line));
        }
    }
    let wrong = |index: usize| {
        let width = |(name, width): &(&str, usize)| {
            let given = world.field(index, name).filter(|value| value.is.is_none());
            given.is_some_and(|value| !value.numbers.is_empty() && value.numbers.len() != *width)
        };
        figure::FIELDS.iter().find(|field| width(field)).map(|(name, width)| (index, *name, *width))
    };
    let wrong: Vec<(usize, &str, usize)> =
        (0..world.nodes.len()).filter(|&node| is_transform(world.kind(node))).filter_map(wrong).collect();
    if let Some((node, name, width)) = wrong.first() {
        let (count, line) = (wrong.len(), world.nodes[*node].line);
        let text = format!(
            "{count} nodes (one in line {line}) have a {name} or the like without its {width} numbers; it counts as not given"
        );
        doubts.push(Note::warning(NoteKind::Unread, text).at_line(line));
    }
    let mut driven = HashSet::new();
    let drives = chosen.iter().flat_map(|clock| &clock.drives);
    let twice = drives.filter_map(|drive| Some((drive.target, drive.place(world)?))).find(|&place| !driven.insert(place));
    if let Some((target, place)) = twice {
        let (name, line) = (world.name(target), world.nodes[target].line);
        let field = figure::FIELDS[place].0;
        let text = format!("two interpolators move the {field} of `{name}` (line {line}); the last one counts");
        doubts.push(Note::warning(NoteKind::Joints, text).at_line(line).of_joint(name));
    }
    let used: HashSet<usize> = clocks.iter().flat_map(|clock| &clock.drives).map(|drive| drive.interpolator).collect();
    let interpolators = (0..world.nodes.len()).filter(|&node| world.kind(node).ends_with("Interpolator"));
    let unused: Vec<usize> = interpolators.filter(|node| !used.contains(node)).collect();
    if let Some(&first) = unused.first() {
        let line = world.nodes[first].line;
        let text = format!("{} interpolators (one in line {line}) move no joint and no number; left out", unused.len());
        doubts.push(Note::warning(NoteKind::Unread, text).at_line(line));
    }
    doubts
}
