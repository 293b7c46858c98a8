//! FBX: one animation stack of a file as a motion of its nodes and blend shapes' weights.
//!
//! The `ufbx` crate evaluates layers, pivots, pre- and post-rotations and inherited scales, and turns axes and units to y up and cm; its
//! world transforms are sampled on the frames.

mod layers;
mod nodes;

use super::animations::{self, Entry};
use super::from_transforms::{self, Affine, Figure, Node};
use super::grid::{self, Grid};
use super::{Request, Source, one_line};
use crate::error::{Error, require};
use crate::memory::Memory;
use crate::motion::Scalar;
use crate::note::{Note, NoteKind, Remedy};
use anyhow::{Context, Result, anyhow, bail};
use nodes::Moves;
use std::path::Path;
use ufbx::{AnimStack, Scene, SceneRoot};

/// Bytes that a scene may take: the largest real one of motion alone takes a tenth.
const MOST_BYTES: usize = 1 << 31;
/// Elements of the scene times frames: the evaluation looks at all of them on each. So many take about a minute.
const MOST_WORK: usize = 1 << 27;
/// Nodes in nodes: the deepest skeletons have about 60.
const DEEPEST: u32 = 1000;
/// Frames a second where the file does not say.
const PLAIN_FPS: f64 = 30.0;

/// Whether `head` begins an FBX file, binary or text.
pub fn begins(head: &[u8]) -> bool {
    head.starts_with(b"Kaydara FBX Binary") || head.starts_with(b"; FBX")
}

/// Reads an animation stack of the FBX file `path`.
pub fn read(path: &Path, options: &Request) -> Result<Source> {
    let place = || path.display().to_string();
    let scene = open(path, options)?;
    let stack = chosen(&scene, options.animation.as_deref()).with_context(place)?;
    let moves = Moves::of(&scene, stack);
    let grid = grid(&scene, stack, options.fps).with_context(place)?;
    let (figure, left_out) = motion(&scene, stack, &grid, options.memory).with_context(place)?;
    let mut notes = vec![grid.note];
    let unit = ufbx::find_prop(&scene.settings.props, "UnitScaleFactor").map_or(1.0, |unit| unit.value_vec4.x);
    if !(unit.is_finite() && unit > 0.0) {
        notes.push(Note::warning(NoteKind::Unit, format!("UnitScaleFactor is {unit}, which is no unit: taken as cm")));
    }
    let stacks = scene.anim_stacks.len();
    if options.animation.is_none() && stacks > 1 {
        let name = one_line(&stack.element.name);
        let note = Note::warning(NoteKind::Animation, format!("stack `{name}` of {stacks}"));
        notes.push(note.remedy(Remedy::ChooseAnimation));
    }
    notes.extend(layers::left_out(stack));
    notes.extend(figure.notes);
    if moves.none() {
        let text = format!("stack `{}` moves nothing: a pose", one_line(&stack.element.name));
        notes.push(Note::warning(NoteKind::Still, text));
    }
    notes.extend(nodes::unused(&scene, left_out));
    let (error, sampled) = (figure.error, options.fps.is_some());
    Ok(Source { unit_known: true, error, sampled, ..Source::plain(figure.motion, notes) })
}

/// Half of the step in which the format counts time, in seconds. A frame's time may be a little before that of its key, where a stepped curve still has the value of
/// the key before.
const HALF_A_TICK: f64 = 0.5 / 46_186_158_000.0;

/// All stacks of the FBX file `path`.
pub fn list(path: &Path, options: &Request) -> Result<Vec<Entry>> {
    let scene = open(path, options)?;
    let entry = |stack: &AnimStack| {
        let grid = grid(&scene, stack, options.fps).with_context(|| path.display().to_string())?;
        let name = Some(one_line(&stack.element.name)).filter(|name| !name.is_empty());
        Ok(Entry { name, frames: grid.frames, fps: 1.0 / grid.frame_time, tracks: Moves::of(&scene, stack).curves })
    };
    scene.anim_stacks.iter().map(|stack| entry(stack)).collect()
}

fn open(path: &Path, options: &Request) -> Result<SceneRoot> {
    let bytes = options.read(path)?;
    let limit = || ufbx::AllocatorOpts { memory_limit: MOST_BYTES, ..Default::default() };
    let options = ufbx::LoadOpts {
        temp_allocator: limit(),
        result_allocator: limit(),
        ignore_geometry: true,
        ignore_embedded: true,
        node_depth_limit: DEEPEST,
        file_format: ufbx::FileFormat::Fbx,
        target_axes: ufbx::CoordinateAxes::right_handed_y_up(),
        target_unit_meters: 0.01,
        ..Default::default()
    };
    ufbx::load_memory(&bytes, options)
        .map_err(|error| anyhow!("{}: not a readable FBX file: {}", path.display(), one_line(&error.description)))
}

/// The stack that the user names, by name or by number from 0, or the first that moves anything.
fn chosen<'s>(scene: &'s Scene, wanted: Option<&str>) -> Result<&'s AnimStack> {
    let stacks = &scene.anim_stacks;
    let Some(wanted) = wanted else {
        let moving = stacks.iter().find(|stack| !Moves::of(scene, stack).none());
        return moving
            .map(|stack| &**stack)
            .context("no curve changes a node's place or a blend shape's weight, so nothing moves");
    };
    let chosen = animations::choose(wanted, stacks.iter().map(|stack| Some(&*stack.element.name)));
    chosen.map(|number| &stacks[number]).ok_or_else(|| {
        let names = stacks.iter().enumerate().map(|(number, stack)| format!("{number} ({})", &*stack.element.name));
        anyhow!("no animation `{wanted}`: the file has {}", one_line(&names.collect::<Vec<_>>().join(", ")))
    })
}

/// The frames of a stack: as long as it says, or, where that is no time at all, as its curves are.
fn grid(scene: &Scene, stack: &AnimStack, fps: Option<f64>) -> Result<Grid> {
    let own = scene.settings.frames_per_second;
    let (fps, why) = match fps {
        Some(fps) => (fps, "as given"),
        None if own.is_finite() && own > 0.0 => (own, "as the file says"),
        None => (PLAIN_FPS, "as the file does not say"),
    };
    let (first, last) = if stack.time_end > stack.time_begin { (stack.time_begin, stack.time_end) } else { nodes::span(stack) };
    if !(first.is_finite() && last.is_finite()) {
        bail!("stack `{}`: its time is no number", one_line(&stack.element.name));
    }
    grid::over(first, last, fps, why)
}

/// The motion, and how many nodes are no part of it.
fn motion(scene: &Scene, stack: &AnimStack, grid: &Grid, memory: Memory) -> Result<(Figure, usize)> {
    let order = nodes::depth_first(scene);
    let kept: Vec<usize> = from_transforms::figure(&nodes::roles(scene, &order))?.into_iter().map(|index| order[index]).collect();
    let weights = nodes::weights(scene);
    let scaled = Moves::of(scene, stack).scaled;
    let scales = 3 * scaled.iter().filter(|scaled| **scaled).count();
    from_transforms::check_size(kept.len(), weights.len() + scales, grid, memory)?;
    let elements = scene.elements.len();
    let refusal = || Error::source(format!("{} frames are too many for a scene of {elements} elements", grid.frames));
    require!(elements.saturating_mul(grid.frames) <= MOST_WORK, refusal().remedy(Remedy::LowerFrameRate));
    let mut joint_of = vec![None; scene.nodes.len()];
    let mut joints: Vec<Node> = Vec::with_capacity(kept.len());
    for (joint, &node) in kept.iter().enumerate() {
        joint_of[node] = Some(joint);
        let parent = scene.nodes[node].parent.as_ref().and_then(|parent| joint_of[parent.element.typed_id as usize]);
        joints.push(Node { name: nodes::name(scene, node), parent, worlds: Vec::with_capacity(grid.frames), scales: Vec::new() });
    }
    let some_layers = layers::animation(scene, stack)?;
    let anim = some_layers.as_deref().unwrap_or(&stack.anim);
    let mut scalars: Vec<Vec<f64>> = vec![Vec::with_capacity(grid.frames); weights.len()];
    for frame in 0..grid.frames {
        let time = grid.first + frame as f64 * grid.frame_time + HALF_A_TICK;
        let now = ufbx::evaluate_scene(scene, anim, time, ufbx::EvaluateOpts::default())
            .map_err(|error| anyhow!("frame {frame}: {}", one_line(&error.description)))?;
        for (joint, &node) in joints.iter_mut().zip(&kept) {
            joint.worlds.push(affine(&now.nodes[node].node_to_world));
            if scaled[node] {
                let scale = &now.nodes[node].local_transform.scale;
                joint.scales.push([scale.x, scale.y, scale.z]);
            }
        }
        scalars.iter_mut().zip(&weights).for_each(|(values, &channel)| values.push(now.blend_channels[channel].weight));
    }
    let scalars = weights.iter().zip(scalars).map(|(&channel, values)| scalar(scene, channel, values)).collect::<Result<_>>()?;
    // The root of all, which is ufbx's own, is no node of the file.
    let left_out = scene.nodes.len() - 1 - kept.len().min(scene.nodes.len() - 1);
    Ok((from_transforms::motion(joints, scalars, grid)?, left_out))
}

/// A weight of 1 is the whole shape; full scale is more where a weight goes beyond.
fn scalar(scene: &Scene, channel: usize, values: Vec<f64>) -> Result<(Scalar, Vec<f64>)> {
    let name = one_line(&scene.blend_channels[channel].element.name);
    let name = if name.is_empty() { format!("weight{channel}") } else { name };
    let full_scale = values.iter().fold(1.0, |largest: f64, value| largest.max(value.abs()));
    if !values.iter().all(|value| value.abs() <= 1e9) {
        bail!("the weight `{name}` is moved beyond 1e9");
    }
    Ok((Scalar { name, full_scale }, values))
}

fn affine(m: &ufbx::Matrix) -> Affine {
    [[m.m00, m.m01, m.m02, m.m03], [m.m10, m.m11, m.m12, m.m13], [m.m20, m.m21, m.m22, m.m23]]
}
