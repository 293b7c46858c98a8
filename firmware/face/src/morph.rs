//! Weights become vertices: neutral places, plus deltas, then turned.

use crate::model::{Error, Model};
use crate::shape::{Interpolation, Kind, Run, Shape};
use crate::turn::{self, Sides};
use crate::{FULL, SHAPES, aperture};
use heapless::Vec;
use pantin_figure::trig::{ONE, sin_cos};

/// A vertex, in steps of the model.
pub type Place = [i16; 3];

/// Weights of a model's shapes, Q15: each as it is stored (or its left side), and mirrored (or its right side).
#[derive(Clone, Debug)]
pub struct Weights([[i32; 2]; SHAPES]);

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
    #[inline]
    pub fn add(&mut self, shape: usize, sides: [bool; 2], weight: i32) {
        let Some(pair) = self.0.get_mut(shape) else { return };
        for (total, driven) in pair.iter_mut().zip(sides) {
            if driven {
                *total = total.saturating_add(weight);
            }
        }
    }

    /// The two weights of each shape.
    pub fn pairs(&self) -> impl Iterator<Item = [i32; 2]> + '_ {
        self.0.iter().map(|pair| pair.map(|weight| weight.clamp(-FULL, FULL)))
    }

    /// The two weights of a shape.
    pub fn of(&self, shape: usize) -> [i32; 2] {
        self.0.get(shape).map_or([0; 2], |pair| pair.map(|weight| weight.clamp(-FULL, FULL)))
    }
}

/// The vertices of a face of at most `N`.
#[derive(Clone, Debug)]
pub struct Morph<const N: usize> {
    pub(crate) places: Vec<Place, N>,
    pub(crate) head: [i32; 3],
    pub(crate) pivot: Place,
}

impl<const N: usize> Morph<N> {
    /// The neutral face.
    pub fn new(model: &Model) -> Result<Self, Error> {
        if model.vertices() > N {
            return Err(Error::TooManyVertices { most: N });
        }
        let mut morph = Morph { places: Vec::new(), head: [0; 3], pivot: [0; 3] };
        morph.neutral(model);
        Ok(morph)
    }

    /// The vertices, in the order of the model.
    pub fn places(&self) -> &[Place] {
        &self.places
    }

    /// Puts the vertices where `weights` have them. The head's own turn is left to [`crate::Look`].
    pub fn place(&mut self, model: &Model, weights: &Weights) {
        self.place_open(model, weights);
        aperture::close(model, &mut self.places, weights);
        (self.head, self.pivot) = model.head(weights);
    }

    /// The same, but what is behind lids and lips is where it would be without them, and the head stays.
    pub fn place_open(&mut self, model: &Model, weights: &Weights) {
        self.neutral(model);
        for (shape, pair) in model.shapes().zip(weights.pairs()) {
            if pair != [0; 2] && shape.kind != Kind::Head {
                self.add(model, &shape, pair);
            }
        }
        for (shape, pair) in model.shapes().zip(weights.pairs()) {
            if pair != [0; 2] && shape.kind != Kind::Head && shape.turns_something() {
                self.turn(model, &shape, pair);
            }
        }
    }

    fn neutral(&mut self, model: &Model) {
        self.places.clear();
        let stored = || model.points.as_chunks::<6>().0.iter().map(|point| coordinates(*point));
        // There is room: checked in `new`.
        self.places.extend(stored().take(N));
        let right = stored().skip(model.middles()).map(|[x, y, z]| [x.wrapping_neg(), y, z]);
        self.places.extend(right.take(N - self.places.len()));
    }

    fn add(&mut self, model: &Model, shape: &Shape, pair: [i32; 2]) {
        // Q15 times Q8 to Q8: at most 2^16.
        let factors = pair.map(|weight| (eased(shape.interpolation, whole(shape.kind, weight)) * i32::from(shape.scale)) >> 15);
        for run in shape.runs() {
            if factors[0] != 0 {
                self.add_run(run, run.first, factors[0], factors[0]);
            }
            if factors[1] != 0 {
                self.add_run(run, model.mirror(run.first), -factors[1], factors[1]);
            }
        }
    }

    /// `across` is the factor of x.
    fn add_run(&mut self, run: Run, first: u16, across: i32, factor: i32) {
        let Some(places) = self.places.get_mut(usize::from(first)..) else { return };
        for (place, delta) in places.iter_mut().zip(run.deltas) {
            // A delta of 2^7 times a factor of 2^16, in Q8.
            let along = |x: i16, delta: u8, factor: i32| x.wrapping_add(((i32::from(delta as i8) * factor + 128) >> 8) as i16);
            *place = [along(place[0], delta[0], across), along(place[1], delta[1], factor), along(place[2], delta[2], factor)];
        }
    }

    fn turn(&mut self, model: &Model, shape: &Shape, pair: [i32; 2]) {
        let pair = pair.map(|weight| whole(shape.kind, weight));
        for turn in shape.turns() {
            turn::apply(
                &turn,
                shape.interpolation,
                Sides { pair, middles: model.middles(), pairs: model.pairs() },
                &mut self.places,
            );
        }
    }
}

pub(crate) fn coordinates([a, b, c, d, e, f]: [u8; 6]) -> Place {
    [[a, b], [c, d], [e, f]].map(i16::from_le_bytes)
}

fn whole(kind: Kind, weight: i32) -> i32 {
    if kind == Kind::Whole { weight.max(0) } else { weight }
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
