//! How many vertices and shapes a model has, in which order its vertices are, and what is checked by these numbers.

use crate::bytes::Bytes;
use crate::error::ModelError;

/// Numbers of a model. Its vertices are ordered: those in the middle, the left ones, the mirror images of the left ones.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Counts {
    pub wide: bool,
    pub middles: u16,
    pub pairs: u16,
    pub moving: [u16; 2],
    pub shapes: u8,
}

impl Counts {
    pub fn middles(&self) -> usize {
        usize::from(self.middles)
    }

    pub fn pairs(&self) -> usize {
        usize::from(self.pairs)
    }

    pub fn vertices(&self) -> usize {
        usize::from(self.middles) + 2 * usize::from(self.pairs)
    }

    pub fn shapes(&self) -> usize {
        usize::from(self.shapes)
    }

    /// Checks that all `indices` are those of vertices.
    pub fn check_indices(&self, indices: &[u8]) -> Result<(), ModelError> {
        let mut indices = Bytes(indices);
        while !indices.0.is_empty() {
            self.check_index(indices.index(self.wide)?)?;
        }
        Ok(())
    }

    /// Checks that all `indices` are those of vertices in the middle or on the left, which are the ones that have mirror images.
    pub fn check_stored(&self, indices: &[u8]) -> Result<(), ModelError> {
        let stored = usize::from(self.middles) + usize::from(self.pairs);
        let mut indices = Bytes(indices);
        while !indices.0.is_empty() {
            if usize::from(indices.index(self.wide)?) >= stored {
                return Err(ModelError::Malformed);
            }
        }
        Ok(())
    }

    pub fn check_index(&self, index: u16) -> Result<(), ModelError> {
        if usize::from(index) < self.vertices() { Ok(()) } else { Err(ModelError::Malformed) }
    }

    /// Checks that vertices `first..first + count` may move and are all in the middle, all on the left, or all on the right.
    pub fn check_run(&self, first: u16, count: u8) -> Result<(), ModelError> {
        let (first, end) = (usize::from(first), usize::from(first) + usize::from(count));
        if count > 0 && self.moving().into_iter().any(|[from, to]| first >= from && end <= to) {
            Ok(())
        } else {
            Err(ModelError::Malformed)
        }
    }

    /// Ranges of the vertices that may move: in the middle, on the left, on the right.
    pub fn moving(&self) -> [[usize; 2]; 3] {
        let [middles, pairs] = self.moving.map(usize::from);
        let (left, right) = (self.middles(), self.middles() + self.pairs());
        [[0, middles], [left, left + pairs], [right, right + pairs]]
    }

    /// The vertex that mirrors another.
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

    /// Finds mirror images of vertices in the middle or on the left: less work than [`Counts::mirror`].
    #[inline(always)]
    pub fn image(&self) -> Image {
        Image { middles: self.middles, pairs: self.pairs }
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
