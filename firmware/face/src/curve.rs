//! Curves on the face that are drawn: brows, lids, lips.

use crate::bytes::{Bytes, indices};
use crate::model::{Error, Model};

/// A curve through vertices.
#[derive(Clone, Copy, Debug)]
pub struct Curve<'a> {
    /// Whether the last vertex is joined to the first.
    pub closed: bool,
    /// Whether its mirror image is drawn too.
    pub mirrored: bool,
    /// From which size on it is drawn: 0 always.
    pub detail: u8,
    /// Whether the smallest displays alone draw it: in place of one with more vertices.
    pub small: bool,
    /// Whether it has corners at its vertices on displays of any size.
    pub straight: bool,
    /// Brightness.
    pub shade: u8,
    indices: &'a [u8],
    wide: bool,
}

impl<'a> Curve<'a> {
    fn parse(bytes: &mut Bytes<'a>, wide: bool) -> Result<Self, Error> {
        let [flags, shade, count] = bytes.array()?;
        if flags >> 6 != 0 || count < 2 {
            return Err(Error::Malformed);
        }
        Ok(Curve {
            closed: flags & 1 != 0,
            mirrored: flags & 2 != 0,
            detail: flags >> 2 & 3,
            small: flags & 32 != 0,
            straight: flags & 16 != 0,
            shade,
            indices: bytes.take(usize::from(count) << u32::from(wide))?,
            wide,
        })
    }

    /// Whether it is drawn on displays of some detail.
    #[inline(always)]
    pub(crate) fn drawn(&self, detail: u8) -> bool {
        self.detail <= detail && !(self.small && detail > 0)
    }

    /// Number of its vertices, at least 2.
    pub fn len(&self) -> usize {
        self.indices.len() >> u32::from(self.wide)
    }

    /// Never.
    pub fn is_empty(&self) -> bool {
        self.indices.is_empty()
    }

    /// A vertex of it.
    #[inline]
    pub(crate) fn vertex(&self, place: usize) -> u16 {
        if self.wide {
            self.indices.as_chunks().0.get(place).map_or(0, |&bytes| u16::from_le_bytes(bytes))
        } else {
            self.indices.get(place).map_or(0, |&byte| u16::from(byte))
        }
    }

    /// Its vertices.
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

    pub(crate) fn check(bytes: &mut Bytes<'a>, count: u8, model: &Model) -> Result<(), Error> {
        for _ in 0..count {
            let curve = Curve::parse(bytes, model.wide)?;
            for index in curve.vertices() {
                model.check_index(index)?;
                if curve.mirrored && usize::from(index) >= model.middles() + model.pairs() {
                    return Err(Error::Malformed);
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
