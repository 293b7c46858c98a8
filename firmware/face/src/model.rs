//! A face model's bytes ([MODEL.md](https://docs.rs/crate/pantin-face/latest/source/MODEL.md)), checked once: afterwards no operation can fail.

use crate::bytes::Bytes;
use crate::target::Target;
use crate::vertex::{self, Vertex};

pub use crate::error::ModelError;
pub use crate::format::{NAME_LEN, NO_SHAPE, SHAPES, VERSION, WIDE};
pub use pantin::names::hash;

/// A checked model: vertices, curves, shapes and the hashes of the names that drive the shapes.
#[derive(Clone, Copy, Debug)]
pub struct Model<'a> {
    pub(crate) wide: bool,
    pub(crate) step_exponent: i8,
    pub(crate) middles: u16,
    pub(crate) pairs: u16,
    pub(crate) moving: [u16; 2],
    pub(crate) outline: u16,
    pub(crate) points: &'a [u8],
    pub(crate) normals: &'a [u8],
    pub(crate) triangles: &'a [u8],
    pub(crate) fixed: &'a [u8],
    pub(crate) curves: &'a [u8],
    pub(crate) openings: &'a [u8],
    pub(crate) shapes: &'a [u8],
    pub(crate) shape_count: u8,
    pub(crate) names: &'a [u8],
}

impl<'a> Model<'a> {
    /// Checks that all `indices` are below a limit.
    #[inline(never)]
    pub(crate) fn check_indices(&self, indices: &[u8], below: usize) -> Result<(), ModelError> {
        let mut indices = Bytes(indices);
        while !indices.0.is_empty() {
            if usize::from(indices.index(self.wide)?) >= below {
                return Err(ModelError::Malformed);
            }
        }
        Ok(())
    }

    pub(crate) fn check_index(&self, index: u16) -> Result<(), ModelError> {
        if usize::from(index) < self.vertices() { Ok(()) } else { Err(ModelError::Malformed) }
    }

    /// Checks that vertices `first..first + count` may move and are all in the middle, all on the left, or all on the right.
    #[inline(never)]
    pub(crate) fn check_run(&self, first: u16, count: u8) -> Result<(), ModelError> {
        let (first, end) = (usize::from(first), usize::from(first) + usize::from(count));
        if count > 0 && self.moving().into_iter().any(|[from, to]| first >= from && end <= to) {
            Ok(())
        } else {
            Err(ModelError::Malformed)
        }
    }

    /// Ranges of the vertices that may move: in the middle, on the left, on the right.
    pub(crate) fn moving(&self) -> [[usize; 2]; 3] {
        let [middles, pairs] = self.moving.map(usize::from);
        let (left, right) = (self.middles(), self.middles() + self.pairs());
        [[0, middles], [left, left + pairs], [right, right + pairs]]
    }

    /// Number of vertices: those in the middle, those on the left, and their mirror images, in this order.
    pub fn vertices(&self) -> usize {
        usize::from(self.middles) + 2 * usize::from(self.pairs)
    }

    /// Number of vertices in the middle, which are their own mirror images.
    pub fn middles(&self) -> usize {
        usize::from(self.middles)
    }

    /// Number of vertices on the left, which is the number of pairs of a vertex and its mirror image.
    pub fn pairs(&self) -> usize {
        usize::from(self.pairs)
    }

    /// The index of the vertex that mirrors the one with index `index`.
    #[inline(always)]
    pub fn mirror(&self, index: u16) -> u16 {
        if index < self.middles {
            index
        } else if index < self.middles.wrapping_add(self.pairs) {
            index.wrapping_add(self.pairs)
        } else {
            index.wrapping_sub(self.pairs)
        }
    }

    /// Finds mirror images of vertices in the middle or on the left: less work than [`Model::mirror`].
    #[inline(always)]
    pub(crate) fn image(&self) -> Image {
        Image { middles: self.middles, pairs: self.pairs }
    }

    /// The neutral position of a vertex.
    pub(crate) fn neutral(&self, index: u16) -> Vertex {
        let stored = if usize::from(index) < self.middles() + self.pairs() { index } else { self.mirror(index) };
        let [x, y, z] = self.points.as_chunks::<6>().0.get(usize::from(stored)).map_or([0; 3], |&point| vertex::of_bytes(point));
        [if stored == index { x } else { x.wrapping_neg() }, y, z]
    }

    /// Exponent of a step: a coordinate of 1 is 2^exponent of the model's unit of length (millimetres for Pantin's own face).
    pub fn step_exponent(&self) -> i8 {
        self.step_exponent
    }

    /// Number of the first stored triangles, whose silhouette is the outline. The others are part of the mesh only.
    pub(crate) fn outline(&self) -> usize {
        usize::from(self.outline)
    }

    /// Number of shapes, at most [`SHAPES`].
    pub fn shape_count(&self) -> usize {
        usize::from(self.shape_count)
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

/// Finds mirror images of vertices in the middle or on the left.
#[derive(Clone, Copy)]
pub(crate) struct Image {
    middles: u16,
    pairs: u16,
}

impl Image {
    #[inline(always)]
    pub fn of(self, index: u16) -> u16 {
        if index < self.middles { index } else { index.wrapping_add(self.pairs) }
    }
}

/// Longer names are not looked up with a capital first letter.
const LONGEST_NAME: usize = 32;

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
