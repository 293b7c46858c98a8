//! From weights to vertices: neutral positions, plus deltas, then rotated.

use crate::error::ModelError;
use crate::model::Model;
use crate::opening_clip::clip_members;
use crate::rotate::{SideWeights, rotate};
use crate::shape::{Arc, Run, Shape, ShapeKind, eased};
use crate::vertex::{self, Vertex};
use crate::weights::Weights;

/// The vertices of a face as weights move them. `N` is the maximum number of vertices: [`VERTICES`](crate::VERTICES) for Pantin's own face.
#[derive(Clone, Debug)]
pub struct Morph<const N: usize> {
    vertices: [Vertex; N],
    count: usize,
    head: [i32; 3],
    pivot: Vertex,
}

impl<const N: usize> Morph<N> {
    /// A morph without vertices, for [`Morph::set_up`].
    pub const EMPTY: Self = Morph { vertices: [[0; 3]; N], count: 0, head: [0; 3], pivot: [0; 3] };

    /// Returns the neutral face, or [`ModelError::TooManyVertices`] if the model has more than `N`.
    #[inline(always)]
    pub fn new(model: &Model) -> Result<Self, ModelError> {
        let mut morph = Morph::EMPTY;
        morph.set_up(model)?;
        Ok(morph)
    }

    /// Makes this the neutral face in place: [`Morph::new`] may copy its result, for which a small machine may have no RAM. Returns
    /// [`ModelError::TooManyVertices`] if the model has more than `N`.
    #[inline(never)]
    pub fn set_up(&mut self, model: &Model) -> Result<(), ModelError> {
        if model.vertices() > N {
            return Err(ModelError::TooManyVertices { needed: model.vertices(), given: N });
        }
        self.count = model.vertices();
        let right = model.middles() + model.pairs();
        reset(model, [0, right], &mut self.vertices);
        reset(model, [right, model.vertices()], &mut self.vertices);
        Ok(())
    }

    /// The vertices in the order of the model.
    pub fn vertices(&self) -> &[Vertex] {
        self.vertices.get(..self.count).unwrap_or(&[])
    }

    /// The head's rotation: angles about x, y, z in 2^-32 turns, and the point about which it rotates.
    pub(crate) fn head_rotation(&self) -> ([i32; 3], Vertex) {
        (self.head, self.pivot)
    }

    /// Moves the vertices as `weights` say. `model` is the one that this morph was made for. The rotation of the head is applied later, by
    /// [`FaceRenderer::project`](crate::FaceRenderer::project).
    pub fn apply(&mut self, model: &Model, weights: &Weights) {
        self.apply_unclipped(model, weights);
        clip_members(model, &mut self.vertices, weights);
    }

    /// Like [`Morph::apply`], but lids and lips do not clip irises, teeth and the tongue.
    pub fn apply_unclipped(&mut self, model: &Model, weights: &Weights) {
        for range in model.moving() {
            reset(model, range, &mut self.vertices);
        }
        (self.head, self.pivot) = apply_shapes(model, weights, &mut self.vertices);
    }
}

/// Applies the shapes one after the other, and returns the head's rotation.
#[inline(never)]
fn apply_shapes(model: &Model, weights: &Weights, vertices: &mut [Vertex]) -> ([i32; 3], Vertex) {
    let (mut head, mut pivot) = ([0i32; 3], [0; 3]);
    let mut shapes = model.shapes();
    for pair in weights.pairs() {
        if pair == [0; 2] && shapes.skip_unless_head() {
            continue;
        }
        let Some(shape) = shapes.next() else { break };
        let pair = if shape.kind == ShapeKind::Unsigned { [pair[0].max(0), pair[1].max(0)] } else { pair };
        if shape.kind == ShapeKind::Head {
            for rotation in shape.rotations() {
                pivot = rotation.centre;
                if let Some(angle) = head.get_mut(rotation.axis) {
                    *angle = angle.wrapping_add((i32::from(rotation.angle) * pair[0]).wrapping_shl(1));
                }
            }
            continue;
        }
        add_deltas(model, &shape, pair, vertices);
        for rotation in shape.rotations() {
            let sides = SideWeights { pair, middles: model.middles(), pairs: model.pairs() };
            rotate(&rotation, shape.interpolation, sides, vertices);
        }
    }
    (head, pivot)
}

/// Moves vertices `from..to` to their neutral positions.
fn reset(model: &Model, [from, to]: [usize; 2], vertices: &mut [Vertex]) {
    let points = model.points.as_chunks::<6>().0;
    let right = model.middles() + model.pairs();
    let stored = if from >= right { from - model.pairs() } else { from };
    let Some(vertices) = vertices.get_mut(from..to) else { return };
    for (vertex, point) in vertices.iter_mut().zip(points.get(stored..).unwrap_or(&[])) {
        let [x, y, z] = vertex::of_bytes(*point);
        *vertex = [if from >= right { x.wrapping_neg() } else { x }, y, z];
    }
}

/// Smaller factors move no vertex by more than 16 steps, which are 1/8 mm of Pantin's face: such deltas are skipped.
const MIN_FACTOR: i32 = 32;

/// Adds a shape's deltas.
fn add_deltas(model: &Model, shape: &Shape, pair: [i32; 2], vertices: &mut [Vertex]) {
    if !shape.has_deltas() {
        return;
    }
    if let Some(arc) = shape.arc {
        return add_along_arc(model, shape, arc, pair, vertices);
    }
    // Q15 times Q8 to Q8: at most 2^16.
    let factor = |weight| (eased(shape.interpolation, weight) * i32::from(shape.scale)) >> 15;
    let stored = factor(pair[0]);
    let mirrored = if pair[1] == pair[0] { stored } else { factor(pair[1]) };
    if stored.abs().max(mirrored.abs()) < MIN_FACTOR {
        return;
    }
    for run in shape.runs() {
        if stored.abs() >= MIN_FACTOR {
            add_run(run, run.first, [stored, stored], vertices);
        }
        if mirrored.abs() >= MIN_FACTOR {
            add_run(run, model.mirror(run.first), [-mirrored, mirrored], vertices);
        }
    }
}

/// Adds a spherical shape's deltas, and moves their vertices away from the centre of the arc. In a function of its own, because few shapes need it.
#[inline(never)]
fn add_along_arc(model: &Model, shape: &Shape, arc: Arc, pair: [i32; 2], vertices: &mut [Vertex]) {
    for (side, weight) in pair.into_iter().enumerate().filter(|entry| entry.1 != 0) {
        let [away, along] = arc.parts(weight);
        // A part of the delta of at most 2: below 2^17.
        let factor = (along * i32::from(shape.scale >> 1)) >> 14;
        let (mirrored, sign) = (side == 1, if side == 1 { -1 } else { 1 });
        let centre = [sign * i32::from(arc.centre[0]), i32::from(arc.centre[1]), i32::from(arc.centre[2])];
        for run in shape.runs() {
            let first = if mirrored { model.mirror(run.first) } else { run.first };
            for (index, delta) in (first..=u16::MAX).zip(run.deltas) {
                // What moves less is bent less: by the square of its part of the largest movement, which is 127. Q8.
                let most = delta.iter().fold(0, |most: i32, &x| most.max(i32::from(x as i8).abs()));
                let bent = (away * ((most * most * 65) >> 12)) >> 8;
                let from = model.neutral(index);
                let Some(vertex) = vertices.get_mut(usize::from(index)) else { continue };
                for axis in 0..3 {
                    let pushed = (i32::from(from[axis]) - centre[axis]).wrapping_mul(bent).wrapping_add(1 << 14) >> 15;
                    vertex[axis] = vertex[axis].wrapping_add(pushed as i16);
                }
            }
            add_run(run, first, [sign * factor, factor], vertices);
        }
    }
}

/// Adds a run of deltas: x times the first factor (Q8), y and z times the second.
#[inline]
fn add_run(run: Run, first: u16, [across, factor]: [i32; 2], vertices: &mut [Vertex]) {
    let Some(vertices) = vertices.get_mut(usize::from(first)..) else { return };
    for (vertex, delta) in vertices.iter_mut().zip(run.deltas) {
        // A delta of 2^7 times a factor of 2^16, in Q8.
        let along = |x: i16, delta: u8, factor: i32| x.wrapping_add(((i32::from(delta as i8) * factor + 128) >> 8) as i16);
        *vertex = [along(vertex[0], delta[0], across), along(vertex[1], delta[1], factor), along(vertex[2], delta[2], factor)];
    }
}
