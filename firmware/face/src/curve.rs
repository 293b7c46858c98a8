//! Curves that are drawn on the face: brows, lids, lips.

use crate::bytes::{Bytes, indices};
use crate::error::ModelError;
use crate::model::Model;

/// A curve through vertices.
#[derive(Clone, Copy, Debug)]
pub struct Curve<'a> {
    /// Whether the last vertex is joined to the first.
    pub closed: bool,
    /// Whether its mirror image is drawn too.
    pub mirrored: bool,
    /// The lowest detail, 0 to 3, at which it is drawn: details 1, 2 and 3 apply to faces of at least 96, 150 and 190 pixels.
    pub detail: u8,
    /// Whether it is drawn at detail 0 only, in place of a curve with more vertices.
    pub small: bool,
    /// Whether it consists of straight lines at every detail. Other curves bend from detail 1 on.
    pub straight: bool,
    /// Whether the area inside is filled, in place of a line. The curve is closed.
    pub filled: bool,
    /// Brightness, 0 to 255.
    pub shade: u8,
    indices: &'a [u8],
    wide: bool,
}

impl<'a> Curve<'a> {
    fn parse(bytes: &mut Bytes<'a>, wide: bool) -> Result<Self, ModelError> {
        let [flags, shade, count] = bytes.array()?;
        let filled = flags & 64 != 0;
        if flags >> 7 != 0 || count < 2 || (filled && flags & 1 == 0) {
            return Err(ModelError::Malformed);
        }
        Ok(Curve {
            closed: flags & 1 != 0,
            mirrored: flags & 2 != 0,
            detail: flags >> 2 & 3,
            small: flags & 32 != 0,
            straight: flags & 16 != 0,
            filled,
            shade,
            indices: bytes.take(usize::from(count) << u32::from(wide))?,
            wide,
        })
    }

    /// Whether it is drawn at `detail`.
    #[inline(always)]
    pub(crate) fn is_drawn(&self, detail: u8) -> bool {
        self.detail <= detail && !(self.small && detail > 0)
    }

    /// Number of its vertices, at least 2.
    pub fn len(&self) -> usize {
        self.indices.len() >> u32::from(self.wide)
    }

    /// Returns `false`: a curve has at least 2 vertices.
    pub fn is_empty(&self) -> bool {
        self.indices.is_empty()
    }

    /// The index of its vertex at `position`.
    #[inline]
    pub(crate) fn vertex(&self, position: usize) -> u16 {
        if self.wide {
            self.indices.as_chunks().0.get(position).map_or(0, |&bytes| u16::from_le_bytes(bytes))
        } else {
            self.indices.get(position).map_or(0, |&byte| u16::from(byte))
        }
    }

    /// The indices of its vertices, if each takes one byte.
    #[inline(always)]
    pub(crate) fn bytes(&self) -> Option<&'a [u8]> {
        (!self.wide).then_some(self.indices)
    }

    /// Walks the indices of its vertices.
    #[inline(always)]
    pub fn vertices(&self) -> impl Iterator<Item = u16> + '_ {
        indices(self.indices, self.wide)
    }
}

/// Walks the curves of a model.
#[derive(Clone, Copy, Debug)]
pub struct Curves<'a> {
    bytes: Bytes<'a>,
    wide: bool,
}

impl<'a> Curves<'a> {
    pub(crate) fn new(bytes: &'a [u8], wide: bool) -> Self {
        Curves { bytes: Bytes(bytes), wide }
    }

    pub(crate) fn check(bytes: &mut Bytes<'a>, count: u8, model: &Model) -> Result<(), ModelError> {
        for _ in 0..count {
            let curve = Curve::parse(bytes, model.wide)?;
            for index in curve.vertices() {
                model.check_index(index)?;
                if curve.mirrored && usize::from(index) >= model.middles() + model.pairs() {
                    return Err(ModelError::Malformed);
                }
            }
        }
        Ok(())
    }
}

impl<'a> Iterator for Curves<'a> {
    type Item = Curve<'a>;

    fn next(&mut self) -> Option<Curve<'a>> {
        Curve::parse(&mut self.bytes, self.wide).ok()
    }
}
