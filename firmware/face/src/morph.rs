//! Weights become vertices: neutral places, plus deltas, then turned.

use crate::model::{Error, Model, Target};
use crate::shape::{Interpolation, Kind, Run, Shape};
use crate::turn::{self, Sides};
use crate::{FULL, SHAPES, aperture};
use pantin_figure::trig::{ONE, sin_cos};

/// A vertex, in steps of the model.
pub type Place = [i16; 3];

/// Weights of a model's shapes, Q15: each as it is stored (or its left side), and mirrored (or its right side). They are kept in Q14: nearly up to two
/// whole ones.
#[derive(Clone, Debug)]
pub struct Weights([[i16; 2]; SHAPES]);

impl Default for Weights {
    fn default() -> Self {
        Weights([[0; 2]; SHAPES])
    }
}

impl Weights {
    /// The neutral face.
    pub fn new() -> Self {
        Self::default()
    }

    /// Back to the neutral face.
    pub fn clear(&mut self) {
        self.0 = [[0; 2]; SHAPES];
    }

    /// Adds to a shape's weights.
    #[inline(always)]
    pub fn add(&mut self, target: Target, weight: i32) {
        let Some(pair) = self.0.get_mut(target.shape()) else { return };
        let sides = target.sides();
        if sides[0] {
            pair[0] = pair[0].saturating_add(kept(weight));
        }
        if sides[1] {
            pair[1] = pair[1].saturating_add(kept(weight));
        }
    }

    /// The two weights of each shape.
    #[inline(always)]
    pub fn pairs(&self) -> impl Iterator<Item = [i32; 2]> + '_ {
        self.0.iter().map(|&pair| match pair {
            [0, 0] => [0; 2],
            pair => pair.map(given),
        })
    }

    /// The two weights of a shape.
    pub fn of(&self, shape: usize) -> [i32; 2] {
        self.0.get(shape).map_or([0; 2], |pair| pair.map(given))
    }
}

/// Q15 to Q14.
#[inline(always)]
fn kept(weight: i32) -> i16 {
    (weight >> 1).clamp(i16::MIN.into(), i16::MAX.into()) as i16
}

/// And back, a whole weight at most.
#[inline(always)]
fn given(weight: i16) -> i32 {
    (i32::from(weight) << 1).clamp(-FULL, FULL)
}

/// The vertices of a face of at most `N`.
#[derive(Clone, Debug)]
pub struct Morph<const N: usize> {
    places: [Place; N],
    vertices: usize,
    head: [i32; 3],
    pivot: Place,
}

impl<const N: usize> Morph<N> {
    /// No face yet.
    pub const EMPTY: Self = Morph { places: [[0; 3]; N], vertices: 0, head: [0; 3], pivot: [0; 3] };

    /// The neutral face.
    #[inline(always)]
    pub fn new(model: &Model) -> Result<Self, Error> {
        let mut morph = Morph::EMPTY;
        morph.set_up(model)?;
        Ok(morph)
    }

    /// The neutral face, where there was none: what is handed on is copied, and for that a small machine may have no room.
    #[inline(never)]
    pub fn set_up(&mut self, model: &Model) -> Result<(), Error> {
        if model.vertices() > N {
            return Err(Error::TooManyVertices { most: N });
        }
        self.vertices = model.vertices();
        let right = model.middles() + model.pairs();
        rest(model, [0, right], &mut self.places);
        rest(model, [right, model.vertices()], &mut self.places);
        Ok(())
    }

    /// The vertices, in the order of the model.
    pub fn places(&self) -> &[Place] {
        self.places.get(..self.vertices).unwrap_or(&[])
    }

    /// How the head turns: angles in 2^-32 turns about x, y, z, and what it turns about.
    pub(crate) fn turn(&self) -> ([i32; 3], Place) {
        (self.head, self.pivot)
    }

    /// Puts the vertices where `weights` have them. The head's own turn is left to [`crate::FaceRenderer`].
    pub fn place(&mut self, model: &Model, weights: &Weights) {
        self.place_open(model, weights);
        aperture::close(model, &mut self.places, weights);
    }

    /// The same, but what is behind lids and lips is where it would be without them.
    pub fn place_open(&mut self, model: &Model, weights: &Weights) {
        for stretch in model.moving() {
            rest(model, stretch, &mut self.places);
        }
        (self.head, self.pivot) = apply(model, weights, &mut self.places);
    }
}

/// Applies the shapes one after the other, and returns how the head turns.
#[inline(never)]
fn apply(model: &Model, weights: &Weights, places: &mut [Place]) -> ([i32; 3], Place) {
    let (mut head, mut pivot) = ([0i32; 3], [0; 3]);
    for (shape, pair) in model.shapes().zip(weights.pairs()) {
        if pair == [0; 2] && shape.kind != Kind::Head {
            continue;
        }
        let pair = if shape.kind == Kind::Whole { [pair[0].max(0), pair[1].max(0)] } else { pair };
        if shape.kind == Kind::Head {
            for turn in shape.turns() {
                pivot = turn.centre;
                if let Some(angle) = head.get_mut(turn.axis) {
                    *angle = angle.wrapping_add((i32::from(turn.angle) * pair[0]).wrapping_shl(1));
                }
            }
            continue;
        }
        add(model, &shape, pair, places);
        for turn in shape.turns() {
            let sides = Sides { pair, middles: model.middles(), pairs: model.pairs() };
            turn::apply(&turn, shape.interpolation, sides, places);
        }
    }
    (head, pivot)
}

/// Puts vertices `from..to` in their neutral places.
fn rest(model: &Model, [from, to]: [usize; 2], places: &mut [Place]) {
    let points = model.points.as_chunks::<6>().0;
    let right = model.middles() + model.pairs();
    let stored = if from >= right { from - model.pairs() } else { from };
    let Some(places) = places.get_mut(from..to) else { return };
    for (place, point) in places.iter_mut().zip(points.get(stored..).unwrap_or(&[])) {
        let [x, y, z] = coordinates(*point);
        *place = [if from >= right { x.wrapping_neg() } else { x }, y, z];
    }
}

/// Factors below this move nothing by more than 16 steps, 1/8 mm of Pantin's face: left out.
const LEAST: i32 = 32;

/// Adds a shape's deltas.
fn add(model: &Model, shape: &Shape, pair: [i32; 2], places: &mut [Place]) {
    if !shape.moves_something() {
        return;
    }
    // Q15 times Q8 to Q8: at most 2^16.
    let factor = |weight| (eased(shape.interpolation, weight) * i32::from(shape.scale)) >> 15;
    let stored = factor(pair[0]);
    let mirrored = if pair[1] == pair[0] { stored } else { factor(pair[1]) };
    if stored.abs().max(mirrored.abs()) < LEAST {
        return;
    }
    for run in shape.runs() {
        if stored.abs() >= LEAST {
            add_run(run, run.first, [stored, stored], places);
        }
        if mirrored.abs() >= LEAST {
            add_run(run, model.mirror(run.first), [-mirrored, mirrored], places);
        }
    }
}

/// The first factor is that of x.
#[inline]
fn add_run(run: Run, first: u16, [across, factor]: [i32; 2], places: &mut [Place]) {
    let Some(places) = places.get_mut(usize::from(first)..) else { return };
    for (place, delta) in places.iter_mut().zip(run.deltas) {
        // A delta of 2^7 times a factor of 2^16, in Q8.
        let along = |x: i16, delta: u8, factor: i32| x.wrapping_add(((i32::from(delta as i8) * factor + 128) >> 8) as i16);
        *place = [along(place[0], delta[0], across), along(place[1], delta[1], factor), along(place[2], delta[2], factor)];
    }
}

#[inline(always)]
pub(crate) fn coordinates([a, b, c, d, e, f]: [u8; 6]) -> Place {
    [i16::from_le_bytes([a, b]), i16::from_le_bytes([c, d]), i16::from_le_bytes([e, f])]
}

/// The part of the way that a weight has gone, Q15.
pub(crate) fn eased(interpolation: Interpolation, weight: i32) -> i32 {
    if interpolation != Interpolation::Cosine {
        return weight;
    }
    // A whole weight is half a turn.
    let (_, cos) = sin_cos(weight.wrapping_shl(16));
    let way = (ONE - cos) >> 1;
    if weight < 0 { -way } else { way }
}
