//! Reads a model: all bytes are checked once.

use crate::bytes::Bytes;
use crate::curve::Curves;
use crate::error::ModelError;
use crate::format::{NAME_LEN, SHAPES, VERSION, WIDE};
use crate::model::Model;
use crate::opening::Opening;
use crate::shape::Shapes;

impl<'a> Model<'a> {
    /// Checks `bytes`, which must be exactly one model. Returns an error if they are truncated, have an unknown version, or contradict
    /// themselves.
    pub fn new_checked(bytes: &'a [u8]) -> Result<Self, ModelError> {
        let mut bytes = Bytes(bytes);
        let version = bytes.u8()?;
        if version != VERSION {
            return Err(ModelError::UnsupportedVersion(version));
        }
        let flags = bytes.u8()?;
        let step_exponent = bytes.u8()? as i8;
        let [middles, pairs, moving_middles, moving_pairs] = [(); 4].map(|()| bytes.u16());
        let (middles, pairs, moving) = (middles?, pairs?, [moving_middles?, moving_pairs?]);
        let [triangles, outline, names] = [(); 3].map(|()| bytes.u16());
        let (triangles, outline, names) = (triangles?, outline?, names?);
        let [fixed, curves, openings, shape_count] = bytes.array()?;
        let wide = flags & WIDE != 0;
        let vertices = usize::from(middles) + 2 * usize::from(pairs);
        let stored = usize::from(middles) + usize::from(pairs);
        if flags & !WIDE != 0 || vertices > if wide { 1 << 15 } else { 1 << 8 } || vertices == 0 || outline > triangles {
            return Err(ModelError::Malformed);
        }
        if moving[0] > middles || moving[1] > pairs {
            return Err(ModelError::Malformed);
        }
        if usize::from(shape_count) > SHAPES || !(-24..=24).contains(&step_exponent) {
            return Err(ModelError::Malformed);
        }
        let width = 1 + usize::from(wide);
        let mut model = Model {
            wide,
            step_exponent,
            middles,
            pairs,
            moving,
            outline,
            points: bytes.take(stored * 6)?,
            normals: bytes.take(stored * 3)?,
            triangles: bytes.take(usize::from(triangles) * 3 * width)?,
            fixed: bytes.take(usize::from(fixed) * width)?,
            curves: &[],
            openings: &[],
            shapes: &[],
            shape_count,
            names: &[],
        };
        // The vertices of triangles have mirror images: they are in the middle or on the left.
        model.check_indices(model.triangles, stored)?;
        model.check_indices(model.fixed, vertices)?;
        model.curves = consumed(&mut bytes, |bytes| Curves::check(bytes, curves, &model))?;
        model.openings = consumed(&mut bytes, |bytes| Opening::check(bytes, openings, &model))?;
        model.shapes = consumed(&mut bytes, |bytes| Shapes::check(bytes, &model))?;
        model.names = bytes.take(usize::from(names) * NAME_LEN)?;
        let known = |entry: &[u8]| entry.get(4).is_some_and(|target| target & 0x3f < shape_count);
        if !bytes.0.is_empty() || !model.names.chunks_exact(NAME_LEN).all(known) {
            return Err(ModelError::Malformed);
        }
        Ok(model)
    }

    /// Walks the curves in the order in which they are drawn.
    pub fn curves(&self) -> Curves<'a> {
        Curves::new(self.curves, self.wide)
    }

    /// Walks the shapes in the order of their weights.
    pub fn shapes(&self) -> Shapes<'a> {
        Shapes::new(self.shapes, self)
    }
}

/// The bytes that `check` reads.
fn consumed<'a>(
    bytes: &mut Bytes<'a>,
    check: impl FnOnce(&mut Bytes<'a>) -> Result<(), ModelError>,
) -> Result<&'a [u8], ModelError> {
    let before = bytes.0;
    check(bytes)?;
    Ok(before.get(..before.len() - bytes.0.len()).unwrap_or(&[]))
}
