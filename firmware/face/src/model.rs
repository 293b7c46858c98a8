//! A face model's bytes ([MODEL.md](https://docs.rs/crate/pantin-face/latest/source/MODEL.md)), checked once: afterwards no operation can fail.

use crate::bytes::Bytes;
use crate::counts::{Counts, Image};
use crate::curve::Curves;
use crate::opening::Opening;
use crate::shape::Shapes;
use crate::target::Target;

pub use crate::error::ModelError;
pub use crate::format::{NAME_LEN, NO_SHAPE, SHAPES, VERSION, WIDE};
pub use pantin::names::hash;

/// A checked model: vertices, curves, shapes and the hashes of the names that drive the shapes.
#[derive(Clone, Copy, Debug)]
pub struct Model<'a> {
    pub(crate) counts: Counts,
    step_exponent: i8,
    outline: u16,
    pub(crate) points: &'a [u8],
    pub(crate) normals: &'a [u8],
    pub(crate) triangles: &'a [u8],
    pub(crate) fixed: &'a [u8],
    curves: &'a [u8],
    pub(crate) openings: &'a [u8],
    shapes: &'a [u8],
    names: &'a [u8],
}

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
        let [fixed, curves, openings, shapes] = bytes.array()?;
        let counts = Counts { wide: flags & WIDE != 0, middles, pairs, moving, shapes };
        let wide = counts.wide;
        let vertices = counts.vertices();
        let stored = usize::from(middles) + usize::from(pairs);
        if flags & !WIDE != 0 || vertices > if wide { 1 << 15 } else { 1 << 8 } || vertices == 0 || outline > triangles {
            return Err(ModelError::Malformed);
        }
        if moving[0] > middles || moving[1] > pairs {
            return Err(ModelError::Malformed);
        }
        if usize::from(shapes) > SHAPES || !(-24..=24).contains(&step_exponent) {
            return Err(ModelError::Malformed);
        }
        let width = 1 + usize::from(wide);
        let mut model = Model {
            counts,
            step_exponent,
            outline,
            points: bytes.take(stored * 6)?,
            normals: bytes.take(stored * 3)?,
            triangles: bytes.take(usize::from(triangles) * 3 * width)?,
            fixed: bytes.take(usize::from(fixed) * width)?,
            curves: &[],
            openings: &[],
            shapes: &[],
            names: &[],
        };
        counts.check_stored(model.triangles)?;
        counts.check_indices(model.fixed)?;
        model.curves = consumed(&mut bytes, |bytes| Curves::check(bytes, curves, &counts))?;
        model.openings = consumed(&mut bytes, |bytes| Opening::check(bytes, openings, &counts))?;
        model.shapes = consumed(&mut bytes, |bytes| Shapes::check(bytes, &counts))?;
        model.names = bytes.take(usize::from(names) * NAME_LEN)?;
        let known = |entry: &[u8]| entry.get(4).is_some_and(|target| target & 0x3f < shapes);
        if !bytes.0.is_empty() || !model.names.chunks_exact(NAME_LEN).all(known) {
            return Err(ModelError::Malformed);
        }
        Ok(model)
    }

    /// Number of vertices: those in the middle, those on the left, and their mirror images, in this order.
    pub fn vertices(&self) -> usize {
        self.counts.vertices()
    }

    /// Number of vertices in the middle, which are their own mirror images.
    pub fn middles(&self) -> usize {
        self.counts.middles()
    }

    /// Number of vertices on the left, which is the number of pairs of a vertex and its mirror image.
    pub fn pairs(&self) -> usize {
        self.counts.pairs()
    }

    /// The index of the vertex that mirrors the one with index `index`.
    #[inline(always)]
    pub fn mirror(&self, index: u16) -> u16 {
        self.counts.mirror(index)
    }

    #[inline(always)]
    pub(crate) fn image(&self) -> Image {
        self.counts.image()
    }

    /// Exponent of a step: a coordinate of 1 is 2^exponent of the model's unit of length (millimetres for Pantin's own face).
    pub fn step_exponent(&self) -> i8 {
        self.step_exponent
    }

    /// Number of the first stored triangles, whose silhouette is the outline. The others are part of the mesh only.
    pub(crate) fn outline(&self) -> usize {
        usize::from(self.outline)
    }

    /// Walks the curves in the order in which they are drawn.
    pub fn curves(&self) -> Curves<'a> {
        Curves::new(self.curves, self.counts.wide)
    }

    /// Walks the shapes in the order of their weights.
    pub fn shapes(&self) -> Shapes<'a> {
        Shapes::new(self.shapes, &self.counts)
    }

    /// Number of shapes, at most [`SHAPES`].
    pub fn shape_count(&self) -> usize {
        self.counts.shapes()
    }

    /// Walks the table of names. A name has an entry for each shape that it drives. The model stores hashes of the names, not the names;
    /// [`NAMES`](crate::NAMES) has those of Pantin's own face.
    pub fn name_entries(&self) -> impl Iterator<Item = NameEntry> {
        self.names.chunks_exact(NAME_LEN).filter_map(NameEntry::parse)
    }

    /// The hash under which the model has `name`: as given, or else with a capital first letter.
    pub(crate) fn find(&self, name: &str) -> Option<u32> {
        let known = |hash: u32| self.name_entries().any(|entry| entry.hash == hash).then_some(hash);
        known(hash(name.as_bytes())).or_else(|| {
            let mut capital = [0; LONGEST_NAME];
            let capital = capital.get_mut(..name.len())?;
            capital.copy_from_slice(name.as_bytes());
            capital.first_mut()?.make_ascii_uppercase();
            known(hash(capital))
        })
    }
}

/// Longer names are not looked up with a capital first letter.
const LONGEST_NAME: usize = 32;

/// The bytes that `check` reads.
fn consumed<'a>(
    bytes: &mut Bytes<'a>,
    check: impl FnOnce(&mut Bytes<'a>) -> Result<(), ModelError>,
) -> Result<&'a [u8], ModelError> {
    let before = bytes.0;
    check(bytes)?;
    Ok(before.get(..before.len() - bytes.0.len()).unwrap_or(&[]))
}

/// A channel's name, and a shape that a channel with this name drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NameEntry {
    /// [`hash`] of the name.
    pub hash: u32,
    /// The sides of the shape.
    pub target: Target,
    /// A value of 1 is a weight of mantissa * 2^exponent.
    pub mantissa: i8,
    /// See [`NameEntry::mantissa`].
    pub exponent: i8,
}

impl NameEntry {
    fn parse(entry: &[u8]) -> Option<NameEntry> {
        let &[a, b, c, d, target, mantissa, exponent] = entry else { return None };
        let hash = u32::from_le_bytes([a, b, c, d]);
        Some(NameEntry { hash, target: Target::of_byte(target), mantissa: mantissa as i8, exponent: exponent as i8 })
    }
}
