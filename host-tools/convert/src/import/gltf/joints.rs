//! The channels of the joints: every node's local place and rotation on the frames.

use super::file::File;
use super::place::{Base, Rest, Stretch, affine, settled};
use super::sampler::SamplerKeys;
use super::scalars::Weight;
use super::tree::Tree;
use super::{Channels, POSITIONS, Target, Tracks, Values};
use crate::fk::{self, Matrix, apply, from_quaternion, product};
use crate::import::from_transforms::{Affine, UNMOVED, chained};
use crate::import::grid::Grid;
use crate::import::{angles, ends, scales};
use crate::keys::sample_pieces;
use crate::motion::{Joint, Keys, Kind, Piece};
use anyhow::Result;
use gltf::json::mesh::Semantic;
use gltf::json::validation::Checked;

/// Part of a place's largest coordinate by which it may waver and still be constant: the steps of f32 are up to 1.2e-7 of it.
const STANDS: f64 = 2e-7;

/// The joints of `tree` with their channels, and a scalar for each scale that changes.
pub fn joints(file: &File, tree: &Tree, tracks: &Tracks, grid: &Grid, quaternions: bool) -> Result<Channels> {
    let mut channels = Channels::default();
    let mut stretches: Vec<Stretch> = Vec::new();
    let mut sites = Vec::new();
    let mut scaled = Vec::new();
    let under = tree.under.iter().map(|&node| rest(file, node)).collect::<Result<Vec<_>>>()?;
    let below_all = under.iter().fold(UNMOVED, |above, rest| chained(&above, &rest.affine()));
    for (node, parent) in tree.nodes.iter().zip(&tree.parents) {
        let Some(node) = *node else {
            channels.joints.push(Joint {
                name: "root".into(),
                parent: None,
                offset: [0.0; 3],
                kinds: Vec::new(),
                end_site: false,
                helper: false,
            });
            stretches.push(Stretch::None);
            channels.worlds.push(vec![UNMOVED; grid.frames]);
            continue;
        };
        let moving = Moving::new(file, node, tracks, grid)?;
        let name = name(file, node);
        let base = parent.map_or_else(|| Base::nodes(&under), |parent| Base::joint(stretches[parent].clone()));
        let (offset, places) = moving.places(&base, grid);
        let mut kinds = Vec::new();
        for (axis, place) in places {
            kinds.push(POSITIONS[axis]);
            channels.of_joints.push(place);
        }
        let rotations = match moving.curves.filter(|_| quaternions) {
            Some(track) => quaternion(track, &base, grid),
            None => moving.rotations(&base, grid),
        };
        for (kind, values) in rotations {
            kinds.push(kind);
            channels.of_joints.push(values);
        }
        let scales = moving.scales(&name, grid);
        scaled.extend((!scales.is_empty()).then(|| name.clone()));
        channels.scalars.extend(scales);
        let above = |frame: usize| parent.map_or(below_all, |parent| channels.worlds[parent][frame]);
        let worlds = (0..grid.frames).map(|frame| chained(&above(frame), &moving.local(frame))).collect();
        channels.worlds.push(worlds);
        let below = base.stretch.below(&moving.turns, &moving.scale, grid.frames);
        let index = channels.joints.len();
        if moving.turns.len() > 1 && !tree.parents.contains(&Some(index)) {
            sites.extend(end(file, node, parent.map(|_| offset), &below).map(|offset| (index, offset)));
        }
        stretches.push(below);
        channels.joints.push(Joint { name, parent: *parent, offset, kinds, end_site: false, helper: false });
    }
    let site = |(parent, offset)| Joint {
        name: String::new(),
        parent: Some(parent),
        offset,
        kinds: Vec::new(),
        end_site: true,
        helper: false,
    };
    channels.joints.extend(sites.into_iter().map(site));
    channels.notes.extend(ends::complete(&mut channels.joints));
    channels.notes.extend(scales::warning(&scaled.iter().map(String::as_str).collect::<Vec<_>>()));
    Ok(channels)
}

/// An End Site for a joint that turns and carries no other, as a bound on places would not see its rotation: at the farthest corner of its
/// mesh, or, without one, half as far as the bone before it and in the same direction.
fn end(file: &File, node: usize, bone: Option<[f64; 3]>, below: &Stretch) -> Option<[f64; 3]> {
    let corner = corner(file, node).map(|corner| apply(&below.at(0), corner));
    corner.or(bone.map(|bone| bone.map(|x| x / 2.0))).filter(|end| end.iter().any(|x| *x != 0.0))
}

/// The corner of the box around a node's mesh that is farthest from the node.
fn corner(file: &File, node: usize) -> Option<[f64; 3]> {
    let mesh = file.root.meshes.get(file.root.nodes[node].mesh?.value())?;
    let position = Checked::Valid(Semantic::Positions);
    let places = mesh.primitives.iter().filter_map(|primitive| primitive.attributes.get(&position));
    let mut corner = [0f64; 3];
    for accessor in places.filter_map(|accessor| file.root.accessors.get(accessor.value())) {
        for bound in [&accessor.min, &accessor.max].into_iter().flatten() {
            for (axis, far) in corner.iter_mut().enumerate() {
                let x = bound.get(axis).and_then(|x| x.as_f64()).filter(|x| x.abs() <= 1e9).unwrap_or(0.0);
                *far = if x.abs() > far.abs() { x } else { *far };
            }
        }
    }
    Some(corner).filter(|corner| *corner != [0.0; 3])
}

/// What a person would call a node.
pub fn name(file: &File, node: usize) -> String {
    let name = file.root.nodes[node].name.as_deref().map(super::one_line).unwrap_or_default();
    if name.trim().is_empty() { format!("node{node}") } else { name }
}

fn rest(file: &File, node: usize) -> Result<Rest> {
    let rest = Rest::of(&file.root.nodes[node]);
    rest.ok_or_else(|| file.error(&format!("nodes[{node}]"), "its place is not in numbers below 1e9"))
}

/// A node on the frames. What stands still is there once.
struct Moving<'t> {
    rest: Rest,
    translation: Option<&'t SamplerKeys>,
    /// Its place in what carries it, where a track moves it.
    own: Vec<[f64; 3]>,
    /// The track of its rotation, if that is one of four curves.
    curves: Option<&'t SamplerKeys>,
    scaled: Option<&'t SamplerKeys>,
    turns: Vec<Matrix>,
    scale: Vec<[f64; 3]>,
    steps: bool,
}

impl<'t> Moving<'t> {
    fn new(file: &File, node: usize, tracks: &'t Tracks, grid: &Grid) -> Result<Moving<'t>> {
        let rest = rest(file, node)?;
        let turned = tracks.get(&Target::Rotation(node));
        let quaternions = match turned {
            Some(track) => track.rotations(grid.first, grid.frame_time, grid.frames)?,
            None => vec![rest.rotation],
        };
        let turns = quaternions.into_iter().map(|[x, y, z, w]| from_quaternion([w, x, y, z])).collect();
        let scaled = tracks.get(&Target::Scale(node));
        let scale = match scaled {
            Some(track) => settled(vectors(&[0, 1, 2].map(|i| sampled(track, i, grid)))),
            None => vec![rest.scale],
        };
        let scaled = scaled.filter(|_| scale.len() > 1);
        let steps = turned.is_some_and(SamplerKeys::steps);
        let translation = tracks.get(&Target::Translation(node));
        let own = translation.map_or_else(Vec::new, |track| vectors(&[0, 1, 2].map(|i| sampled(track, i, grid))));
        let curves = turned.filter(|track| track.is_cubic());
        Ok(Moving { rest, translation, own, curves, scaled, turns, scale, steps })
    }

    /// Its place at a frame in what carries it.
    fn place(&self, frame: usize) -> [f64; 3] {
        self.own.get(frame).copied().unwrap_or(self.rest.translation)
    }

    /// Its transform at a frame in what carries it.
    fn local(&self, frame: usize) -> Affine {
        let (turn, scale) = (&self.turns[frame.min(self.turns.len() - 1)], self.scale[frame.min(self.scale.len() - 1)]);
        affine(turn, scale, self.place(frame))
    }

    /// The offset, and the axes along which the place moves.
    fn places(&self, base: &Base, grid: &Grid) -> ([f64; 3], Vec<(usize, Values)>) {
        let curves = self.translation.map(|track| [0, 1, 2].map(|i| track.pieces(i, grid.first, grid.frame_time)));
        if curves.is_none() && base.stretch.is_still() {
            return (base.at(0, self.rest.translation), Vec::new());
        }
        let places: Vec<[f64; 3]> = (0..grid.frames).map(|frame| base.at(frame, self.place(frame))).collect();
        let largest = places.iter().flatten().fold(0f64, |largest, x| largest.max(x.abs()));
        let moves = |axis: &usize| places.iter().any(|place| (place[*axis] - places[0][*axis]).abs() > STANDS * largest);
        let channel = |axis: usize| {
            let pieces = curves.as_ref().filter(|_| base.stretch.is_still()).map(|curves| along(axis, curves, base));
            let values = match &pieces {
                Some(pieces) => sample_pieces(pieces, grid.frames),
                None => places.iter().map(|place| place[axis]).collect(),
            };
            (axis, Values { values, keys: pieces.map(Keys::Pieces) })
        };
        (places[0], (0..3).filter(moves).map(channel).collect())
    }

    fn rotations(&self, base: &Base, grid: &Grid) -> Vec<(Kind, Values)> {
        let turns: Vec<Matrix> = self.turns.iter().map(|turn| product(&base.turn, turn)).collect();
        let channels = angles::channels(&turns).into_iter();
        let whole = |(kind, mut values): (Kind, Vec<f64>)| {
            values.resize(grid.frames, values[0]);
            let keys = self.steps.then(|| Keys::Pieces(runs(&values)));
            (kind, Values { values, keys })
        };
        channels.map(whole).collect()
    }

    /// Scalars for the axes along which the scale changes.
    fn scales(&self, name: &str, grid: &Grid) -> Vec<Weight> {
        let Some(track) = self.scaled else { return Vec::new() };
        let axes = scales::changing(&self.scale).into_iter();
        axes.map(|axis| Weight::new(scales::name(name, axis), name, track, axis, 0.0, grid)).collect()
    }
}

/// The four curves of a quaternion. What carries the joint stands still, so it mixes them at every time alike.
fn quaternion(track: &SamplerKeys, base: &Base, grid: &Grid) -> Vec<(Kind, Values)> {
    const KINDS: [Kind; 4] = [Kind::Wquaternion, Kind::Xquaternion, Kind::Yquaternion, Kind::Zquaternion];
    let curves = [3, 0, 1, 2].map(|component| track.pieces(component, grid.first, grid.frame_time));
    let [x, y, z, w] = fk::quaternion(&base.turn);
    let mixed = [[w, -x, -y, -z], [x, w, -z, y], [y, z, w, -x], [z, -y, x, w]];
    let turned = |row: usize| -> Vec<Piece> {
        let mix = |n: usize, part: fn(&Piece) -> f64| (0..4).map(|i| mixed[row][i] * part(&curves[i][n])).sum::<f64>();
        let piece = |n: usize| Piece {
            start: curves[row][n].start,
            p: mix(n, |piece| piece.p),
            c: mix(n, |piece| piece.c),
            w: mix(n, |piece| piece.w),
            k: mix(n, |piece| piece.k),
        };
        (0..curves[row].len()).map(piece).collect()
    };
    let channel = |row: usize| {
        let pieces = turned(row);
        (KINDS[row], Values { values: sample_pieces(&pieces, grid.frames), keys: Some(Keys::Pieces(pieces)) })
    };
    (0..4).map(channel).collect()
}

fn sampled(track: &SamplerKeys, component: usize, grid: &Grid) -> Vec<f64> {
    sample_pieces(&track.pieces(component, grid.first, grid.frame_time), grid.frames)
}

fn vectors(curves: &[Vec<f64>; 3]) -> Vec<[f64; 3]> {
    (0..curves[0].len()).map(|frame| std::array::from_fn(|i| curves[i][frame])).collect()
}

/// Pieces of the place along `axis`: those of all three own axes, which begin alike, as the base mixes them.
fn along(axis: usize, curves: &[Vec<Piece>; 3], base: &Base) -> Vec<Piece> {
    let linear = base.linear(0);
    let mixed = |n: usize, part: fn(&Piece) -> f64| match &linear {
        Some(linear) => (0..3).map(|i| linear[axis][i] * part(&curves[i][n])).sum::<f64>(),
        None => part(&curves[axis][n]),
    };
    let piece = |n: usize| Piece {
        start: curves[axis][n].start,
        p: base.place[axis] + mixed(n, |piece| piece.p),
        c: mixed(n, |piece| piece.c),
        w: mixed(n, |piece| piece.w),
        k: mixed(n, |piece| piece.k),
    };
    (0..curves[axis].len()).map(piece).collect()
}

/// A piece for each run of equal values.
fn runs(values: &[f64]) -> Vec<Piece> {
    let begins = |frame: &usize| *frame == 0 || values[*frame] != values[*frame - 1];
    let frames = (0..values.len()).filter(begins);
    frames.map(|frame| Piece { start: frame as f64, p: values[frame], ..Piece::default() }).collect()
}
