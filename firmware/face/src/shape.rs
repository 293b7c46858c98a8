//! What a weight moves: sparse deltas, and rotations about an axis.

use crate::bytes::Bytes;
use crate::error::ModelError;
use crate::model::Model;
use pantin_figure::trig::{ONE, sin_cos};

/// How vertices move from their neutral position to their final one (docs/METHOD.md 3.3).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// In proportion to the weight.
    Linear,
    /// An ease of Pantin's own, slow at both ends: (1 - cos(pi w)) / 2 of the distance at weight w.
    Eased,
    /// On the arc of a circle: of a rotation about its axis, of deltas about the [`Arc`] of their shape.
    Spherical,
    /// The paper's improved linear interpolation, fast at first and slow at the end: cos(pi (1 - w) / 2) of the distance at weight w.
    ImprovedLinear,
}

/// What the spherical interpolation of a shape's deltas needs: about which point, and by which angle.
///
/// A vertex goes from s to e, both seen from the centre, by sin((1 - w) W) / sin W s + sin(w W) / sin W e. If W is the angle between s and e, this is an arc of a
/// great circle; a larger W bends it more. Vertices that move less than
/// others of the shape are bent less: by the square of their part of the largest movement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arc {
    /// In steps; x is negated for the mirror image.
    pub centre: [i16; 3],
    /// The angle W, in 2^-16 turns: 1 to [`MOST_ANGLE`].
    pub angle: i16,
}

/// The largest angle of an [`Arc`]: 120 degrees. Near 180 degrees, sin W vanishes.
pub const MOST_ANGLE: i16 = 21_845;

/// The range of a shape's weights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShapeKind {
    /// Weights from 0 to 1.
    Unsigned,
    /// Weights from -1 to 1.
    Signed,
    /// Weights from -1 to 1 that rotate the whole head.
    Head,
}

/// [`ShapeKind::Head`] in a model's bytes.
const HEAD: u8 = 2;

/// A shape: what one unit of the face moves. It has two weights: one moves the shape as stored (its left side, if it has sides), the other
/// its mirror image.
#[derive(Clone, Copy, Debug)]
pub struct Shape<'a> {
    /// How its vertices move.
    pub interpolation: Interpolation,
    /// The range of its weights.
    pub kind: ShapeKind,
    /// Movement of a delta of 1 at full weight, in 256ths of a step.
    pub scale: u16,
    /// The arc of the deltas of a spherical shape.
    pub arc: Option<Arc>,
    pub(crate) deltas: &'a [u8],
    rotations: &'a [u8],
    wide: bool,
}

/// Deltas of consecutive vertices.
#[derive(Clone, Copy, Debug)]
pub struct Run<'a> {
    /// Index of the first vertex.
    pub first: u16,
    /// x, y, z of each delta as `i8`, in units of [`Shape::scale`].
    pub deltas: &'a [[u8; 3]],
}

/// A rotation about a line parallel to an axis.
#[derive(Clone, Copy, Debug)]
pub struct AxisRotation<'a> {
    /// The axis: 0, 1, 2 for x, y, z.
    pub axis: usize,
    /// A point of the line, in steps.
    pub centre: [i16; 3],
    /// The angle at full weight, in 2^-16 turns.
    pub angle: i16,
    pub(crate) members: &'a [u8],
    pub(crate) wide: bool,
}

/// Consecutive vertices that rotate by the same part of the angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Members {
    /// Index of the first vertex.
    pub first: u16,
    /// Number of vertices.
    pub count: u8,
    /// The part of the angle, in 255ths.
    pub part: u8,
}

impl<'a> Shape<'a> {
    #[inline(always)]
    fn parse(bytes: &mut Bytes<'a>, wide: bool) -> Result<Self, ModelError> {
        let [head, a, b, c, d, e, f] = bytes.array()?;
        let interpolation = match head & 3 {
            0 => Interpolation::Linear,
            1 => Interpolation::Eased,
            2 => Interpolation::Spherical,
            _ => Interpolation::ImprovedLinear,
        };
        let kind = match head >> 2 {
            0 => ShapeKind::Unsigned,
            1 => ShapeKind::Signed,
            HEAD => ShapeKind::Head,
            _ => return Err(ModelError::Malformed),
        };
        let (scale, deltas, rotations) = (u16::from_le_bytes([a, b]), u16::from_le_bytes([c, d]), u16::from_le_bytes([e, f]));
        let mut moved = Bytes(bytes.take(usize::from(deltas))?);
        let arc = match interpolation {
            Interpolation::Spherical if deltas > 0 => Some(arc(&mut moved)?),
            _ => None,
        };
        Ok(Shape { interpolation, kind, scale, arc, deltas: moved.0, rotations: bytes.take(usize::from(rotations))?, wide })
    }

    /// Walks its deltas.
    #[inline(always)]
    pub fn runs(&self) -> impl Iterator<Item = Run<'a>> {
        let (mut bytes, wide) = (Bytes(self.deltas), self.wide);
        core::iter::from_fn(move || {
            let (first, count) = bytes.index_and_byte(wide)?;
            Some(Run { first, deltas: bytes.next(usize::from(count) * 3)?.as_chunks().0 })
        })
    }

    /// Walks its rotations.
    pub fn rotations(&self) -> impl Iterator<Item = AxisRotation<'a>> {
        let (mut bytes, wide) = (Bytes(self.rotations), self.wide);
        core::iter::from_fn(move || rotation(&mut bytes, wide).ok())
    }

    pub(crate) fn has_deltas(&self) -> bool {
        !self.deltas.is_empty()
    }
}

#[inline(always)]
fn run<'a>(bytes: &mut Bytes<'a>, wide: bool) -> Result<Run<'a>, ModelError> {
    let first = bytes.index(wide)?;
    let count = bytes.u8()?;
    Ok(Run { first, deltas: bytes.take(usize::from(count) * 3)?.as_chunks().0 })
}

fn arc(bytes: &mut Bytes) -> Result<Arc, ModelError> {
    let [x, y, z, angle] = [(); 4].map(|()| bytes.i16());
    let arc = Arc { centre: [x?, y?, z?], angle: angle? };
    if (1..=MOST_ANGLE).contains(&arc.angle) { Ok(arc) } else { Err(ModelError::Malformed) }
}

fn rotation<'a>(bytes: &mut Bytes<'a>, wide: bool) -> Result<AxisRotation<'a>, ModelError> {
    let [axis, runs, a, b, c, d, e, f, g, h] = bytes.array()?;
    let [x, y, z, angle] = [[a, b], [c, d], [e, f], [g, h]].map(i16::from_le_bytes);
    if axis > 2 {
        return Err(ModelError::Malformed);
    }
    let members = bytes.take(usize::from(runs) * (3 + usize::from(wide)))?;
    Ok(AxisRotation { axis: usize::from(axis), centre: [x, y, z], angle, members, wide })
}

impl AxisRotation<'_> {
    /// Walks the vertices that rotate.
    pub fn members(&self) -> impl Iterator<Item = Members> + '_ {
        let (mut bytes, wide) = (Bytes(self.members), self.wide);
        core::iter::from_fn(move || {
            let (first, count) = bytes.index_and_byte(wide)?;
            let &[part] = bytes.next(1)? else { return None };
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
    pub(crate) fn new(bytes: &'a [u8], model: &Model) -> Self {
        Shapes { bytes: Bytes(bytes), left: model.shape_count, wide: model.wide }
    }

    pub(crate) fn check(bytes: &mut Bytes<'a>, model: &Model) -> Result<(), ModelError> {
        for _ in 0..model.shape_count() {
            let shape = Shape::parse(bytes, model.wide)?;
            let mut deltas = Bytes(shape.deltas);
            while !deltas.0.is_empty() {
                let run = run(&mut deltas, model.wide)?;
                model.check_run(run.first, run.deltas.len() as u8)?;
            }
            let mut rotations = Bytes(shape.rotations);
            while !rotations.0.is_empty() {
                for members in rotation(&mut rotations, model.wide)?.members() {
                    model.check_run(members.first, members.count)?;
                }
            }
        }
        Ok(())
    }
}

impl Shapes<'_> {
    /// Passes over the next shape unless it rotates the head; returns whether it did.
    #[inline(always)]
    pub(crate) fn skip_unless_head(&mut self) -> bool {
        let [head, _, _, a, b, c, d, rest @ ..] = self.bytes.0 else { return false };
        let len = usize::from(u16::from_le_bytes([*a, *b])) + usize::from(u16::from_le_bytes([*c, *d]));
        match (rest.get(len..), self.left.checked_sub(1)) {
            (Some(rest), Some(left)) if head >> 2 != HEAD => {
                (self.bytes, self.left) = (Bytes(rest), left);
                true
            }
            _ => false,
        }
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

/// The part of its distance that a vertex has moved at a weight; both in Q15.
pub(crate) fn eased(interpolation: Interpolation, weight: i32) -> i32 {
    match interpolation {
        // A full weight is half a turn.
        Interpolation::Eased => {
            let (_, cos) = sin_cos(weight.wrapping_shl(16));
            let part = (ONE - cos) >> 1;
            if weight < 0 { -part } else { part }
        }
        // cos(pi (1 - w) / 2) is sin(pi w / 2): a full weight is a quarter turn. Negative weights go the opposite way.
        Interpolation::ImprovedLinear => sin_cos(weight.wrapping_shl(15)).0,
        Interpolation::Linear | Interpolation::Spherical => weight,
    }
}

impl Arc {
    /// For a weight (Q15): by which part of its distance from the centre a vertex is moved away from it, and of its delta along it, both Q15.
    /// The first is sin((1 - w) W) / sin W + sin(w W) / sin W - 1.
    pub(crate) fn parts(&self, weight: i32) -> [i32; 2] {
        let angle = i32::from(self.angle);
        let sin = |weight: i32| sin_cos((angle * weight).wrapping_shl(1)).0;
        let whole = sin(ONE).max(1);
        // Sines are at most 2^15, products at most 2^30. One division for each shape and frame.
        let part = |sin: i32| (sin << 15) / whole;
        let (from, to) = (part(sin(ONE - weight)), part(sin(weight)));
        [from + to - ONE, to]
    }
}
