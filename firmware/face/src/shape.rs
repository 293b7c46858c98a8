//! What a weight moves: sparse deltas, and turns about an axis.

use crate::bytes::Bytes;
use crate::model::{Error, Model};

/// How vertices go from the neutral place to the final one (docs/METHOD.md 3.3).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// In proportion to the weight.
    Linear,
    /// Eased: (1 - cos(pi w)) / 2 of the way.
    Cosine,
    /// Along the arc of a turn; what does not turn goes straight, as near W = 0.
    Spherical,
}

/// What a shape takes its weights for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Weights from 0 to 1.
    Whole,
    /// Weights from -1 to 1.
    Signed,
    /// Weights from -1 to 1 that turn the whole head.
    Head,
}

/// A shape. It has two weights: as it is stored, which is its left side if it has sides, and mirrored.
#[derive(Clone, Copy, Debug)]
pub struct Shape<'a> {
    /// How it goes.
    pub interpolation: Interpolation,
    /// What its weights are.
    pub kind: Kind,
    /// Steps of a vertex that a delta of 1 is at full weight, Q8.
    pub scale: u16,
    pub(crate) deltas: &'a [u8],
    turns: &'a [u8],
    wide: bool,
}

/// Neighbouring vertices that a shape moves.
#[derive(Clone, Copy, Debug)]
pub struct Run<'a> {
    /// The first of them.
    pub first: u16,
    /// x, y, z of each.
    pub deltas: &'a [[u8; 3]],
}

/// A turn about a line parallel to an axis.
#[derive(Clone, Copy, Debug)]
pub struct Turn<'a> {
    /// 0, 1, 2: x, y, z.
    pub axis: usize,
    /// A point of the line, in steps.
    pub centre: [i16; 3],
    /// The angle at full weight, in 2^-16 turns.
    pub angle: i16,
    pub(crate) members: &'a [u8],
    pub(crate) wide: bool,
}

/// Neighbouring vertices that turn by one part of the angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Members {
    /// The first of them.
    pub first: u16,
    /// How many.
    pub count: u8,
    /// The part of the angle, in 255ths.
    pub part: u8,
}

impl<'a> Shape<'a> {
    #[inline(always)]
    fn parse(bytes: &mut Bytes<'a>, wide: bool) -> Result<Self, Error> {
        let [head, a, b, c, d, e, f] = bytes.array()?;
        let interpolation = match head & 3 {
            0 => Interpolation::Linear,
            1 => Interpolation::Cosine,
            2 => Interpolation::Spherical,
            _ => return Err(Error::Malformed),
        };
        let kind = match head >> 2 {
            0 => Kind::Whole,
            1 => Kind::Signed,
            2 => Kind::Head,
            _ => return Err(Error::Malformed),
        };
        let (scale, deltas, turns) = (u16::from_le_bytes([a, b]), u16::from_le_bytes([c, d]), u16::from_le_bytes([e, f]));
        Ok(Shape {
            interpolation,
            kind,
            scale,
            deltas: bytes.take(usize::from(deltas))?,
            turns: bytes.take(usize::from(turns))?,
            wide,
        })
    }

    /// Its deltas.
    #[inline(always)]
    pub fn runs(&self) -> impl Iterator<Item = Run<'a>> {
        let (mut bytes, wide) = (Bytes(self.deltas), self.wide);
        core::iter::from_fn(move || run(&mut bytes, wide).ok())
    }

    /// Its turns.
    pub fn turns(&self) -> impl Iterator<Item = Turn<'a>> {
        let (mut bytes, wide) = (Bytes(self.turns), self.wide);
        core::iter::from_fn(move || turn(&mut bytes, wide).ok())
    }

    /// Whether it has deltas.
    pub(crate) fn moves_something(&self) -> bool {
        !self.deltas.is_empty()
    }
}

#[inline(always)]
fn run<'a>(bytes: &mut Bytes<'a>, wide: bool) -> Result<Run<'a>, Error> {
    let first = bytes.index(wide)?;
    let count = bytes.byte()?;
    Ok(Run { first, deltas: bytes.take(usize::from(count) * 3)?.as_chunks().0 })
}

fn turn<'a>(bytes: &mut Bytes<'a>, wide: bool) -> Result<Turn<'a>, Error> {
    let [axis, runs] = bytes.array()?;
    let [x, y, z, angle] = [(); 4].map(|()| bytes.number());
    if axis > 2 {
        return Err(Error::Malformed);
    }
    let members = bytes.take(usize::from(runs) * (3 + usize::from(wide)))?;
    Ok(Turn { axis: usize::from(axis), centre: [x?, y?, z?], angle: angle?, members, wide })
}

impl Turn<'_> {
    /// What it turns.
    pub fn members(&self) -> impl Iterator<Item = Members> + '_ {
        let (mut bytes, wide) = (Bytes(self.members), self.wide);
        core::iter::from_fn(move || {
            let first = bytes.index(wide).ok()?;
            let [count, part] = bytes.array().ok()?;
            Some(Members { first, count, part })
        })
    }
}

/// Walks the shapes of a model.
#[derive(Clone, Copy, Debug)]
pub struct Shapes<'a> {
    bytes: Bytes<'a>,
    left: u8,
    wide: bool,
}

impl<'a> Shapes<'a> {
    pub(crate) fn new(bytes: &'a [u8], count: u8, wide: bool) -> Self {
        Shapes { bytes: Bytes(bytes), left: count, wide }
    }

    pub(crate) fn check(bytes: &mut Bytes<'a>, model: &Model) -> Result<(), Error> {
        for _ in 0..model.shape_count() {
            let shape = Shape::parse(bytes, model.wide)?;
            let mut deltas = Bytes(shape.deltas);
            while !deltas.0.is_empty() {
                let run = run(&mut deltas, model.wide)?;
                model.check_run(run.first, run.deltas.len() as u8)?;
            }
            let mut turns = Bytes(shape.turns);
            while !turns.0.is_empty() {
                for members in turn(&mut turns, model.wide)?.members() {
                    model.check_run(members.first, members.count)?;
                }
            }
        }
        Ok(())
    }
}

impl<'a> Iterator for Shapes<'a> {
    type Item = Shape<'a>;

    #[inline(always)]
    fn next(&mut self) -> Option<Shape<'a>> {
        self.left = self.left.checked_sub(1)?;
        Shape::parse(&mut self.bytes, self.wide).ok()
    }
}
