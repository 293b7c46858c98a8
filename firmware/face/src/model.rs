//! A face's bytes (MODEL.md), checked once: afterwards nothing can fail.

use crate::SHAPES;
use crate::bytes::Bytes;
use crate::curve::Curves;
use crate::shape::Shapes;
pub use pantin::names::hash;

/// The only version.
pub const VERSION: u8 = 1;
/// Flag: indices of vertices take two bytes.
pub const WIDE: u8 = 1;
/// Bytes of one entry of the name table.
pub const NAME_LEN: usize = 7;
/// Stands for no shape.
pub const NO_SHAPE: u8 = 0xff;

/// Why bytes are no model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error {
    /// They end early.
    Truncated,
    /// A version that this reader does not know.
    UnsupportedVersion(u8),
    /// They contradict themselves.
    Malformed,
    /// More vertices than there is room for.
    TooManyVertices {
        /// The room.
        most: usize,
    },
}

impl core::fmt::Display for Error {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Error::Truncated => write!(f, "the face model ends early"),
            Error::UnsupportedVersion(version) => write!(f, "face model of version {version}; this reader knows {VERSION}"),
            Error::Malformed => write!(f, "the face model contradicts itself"),
            Error::TooManyVertices { most } => write!(f, "the face model has more than {most} vertices"),
        }
    }
}

impl core::error::Error for Error {}

/// A checked model.
#[derive(Clone, Copy, Debug)]
pub struct Model<'a> {
    pub(crate) wide: bool,
    step_exponent: i8,
    middles: u16,
    pairs: u16,
    moving: [u16; 2],
    outline: u16,
    pub(crate) points: &'a [u8],
    pub(crate) normals: &'a [u8],
    pub(crate) triangles: &'a [u8],
    pub(crate) fixed: &'a [u8],
    curves: &'a [u8],
    pub(crate) apertures: &'a [u8],
    shapes: &'a [u8],
    shape_count: u8,
    names: &'a [u8],
}

impl<'a> Model<'a> {
    /// Checks `bytes`, all of them one model.
    pub fn new_checked(bytes: &'a [u8]) -> Result<Self, Error> {
        let mut bytes = Bytes(bytes);
        let version = bytes.byte()?;
        if version != VERSION {
            return Err(Error::UnsupportedVersion(version));
        }
        let flags = bytes.byte()?;
        let step_exponent = bytes.byte()? as i8;
        let [middles, pairs, moving_middles, moving_pairs] = [(); 4].map(|()| bytes.short());
        let (middles, pairs, moving) = (middles?, pairs?, [moving_middles?, moving_pairs?]);
        let [triangles, outline, names] = [(); 3].map(|()| bytes.short());
        let (triangles, outline, names) = (triangles?, outline?, names?);
        let [fixed, curves, apertures, shape_count] = bytes.array()?;
        let wide = flags & WIDE != 0;
        let vertices = usize::from(middles) + 2 * usize::from(pairs);
        let stored = usize::from(middles) + usize::from(pairs);
        if flags & !WIDE != 0 || vertices > if wide { 1 << 15 } else { 1 << 8 } || vertices == 0 || outline > triangles {
            return Err(Error::Malformed);
        }
        if moving[0] > middles || moving[1] > pairs {
            return Err(Error::Malformed);
        }
        if usize::from(shape_count) > SHAPES || !(-24..=24).contains(&step_exponent) {
            return Err(Error::Malformed);
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
            apertures: &[],
            shapes: &[],
            shape_count,
            names: &[],
        };
        model.check_stored(model.triangles)?;
        model.check_indices(model.fixed)?;
        model.curves = consumed(&mut bytes, |bytes| Curves::check(bytes, curves, &model))?;
        model.apertures = consumed(&mut bytes, |bytes| crate::aperture::check(bytes, apertures, &model))?;
        model.shapes = consumed(&mut bytes, |bytes| Shapes::check(bytes, &model))?;
        model.names = bytes.take(usize::from(names) * NAME_LEN)?;
        let known = |entry: &[u8]| entry.get(4).is_some_and(|target| target & 0x3f < shape_count);
        if !bytes.0.is_empty() || !model.names.chunks_exact(NAME_LEN).all(known) {
            return Err(Error::Malformed);
        }
        Ok(model)
    }

    fn check_indices(&self, indices: &[u8]) -> Result<(), Error> {
        let mut indices = Bytes(indices);
        while !indices.0.is_empty() {
            self.check_index(indices.index(self.wide)?)?;
        }
        Ok(())
    }

    /// What is mirrored lies in the middle or left.
    fn check_stored(&self, indices: &[u8]) -> Result<(), Error> {
        let stored = usize::from(self.middles) + usize::from(self.pairs);
        let mut indices = Bytes(indices);
        while !indices.0.is_empty() {
            if usize::from(indices.index(self.wide)?) >= stored {
                return Err(Error::Malformed);
            }
        }
        Ok(())
    }

    pub(crate) fn check_index(&self, index: u16) -> Result<(), Error> {
        if usize::from(index) < self.vertices() { Ok(()) } else { Err(Error::Malformed) }
    }

    /// Vertices `first..first + count`, which are all in the middle, all left, or all right, and of those that may move.
    pub(crate) fn check_run(&self, first: u16, count: u8) -> Result<(), Error> {
        let (first, end) = (usize::from(first), usize::from(first) + usize::from(count));
        if count > 0 && self.moving().into_iter().any(|[from, to]| first >= from && end <= to) {
            Ok(())
        } else {
            Err(Error::Malformed)
        }
    }

    /// The vertices that may move, from one index to another: in the middle, left, right.
    pub(crate) fn moving(&self) -> [[usize; 2]; 3] {
        let [middles, pairs] = self.moving.map(usize::from);
        let (left, right) = (self.middles(), self.middles() + self.pairs());
        [[0, middles], [left, left + pairs], [right, right + pairs]]
    }

    /// Number of vertices: those in the middle, then the left ones, then their mirror images.
    pub fn vertices(&self) -> usize {
        usize::from(self.middles) + 2 * usize::from(self.pairs)
    }

    /// Number of vertices in the middle, which are their own mirror images.
    pub fn middles(&self) -> usize {
        usize::from(self.middles)
    }

    /// Number of vertices of the left half.
    pub fn pairs(&self) -> usize {
        usize::from(self.pairs)
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

    /// What makes vertices in the middle or left into their mirror images.
    #[inline(always)]
    pub(crate) fn image(&self) -> Image {
        Image { middles: self.middles, pairs: self.pairs }
    }

    /// One step of a vertex is 2^`step_exponent` of the model's units (millimetres of Pantin's own face).
    pub fn step_exponent(&self) -> i8 {
        self.step_exponent
    }

    /// Triangles of the stored half whose silhouette makes the outline; those behind them only make the mesh.
    pub(crate) fn outline(&self) -> usize {
        usize::from(self.outline)
    }

    /// Curves that are drawn.
    pub fn curves(&self) -> Curves<'a> {
        Curves::new(self.curves, self.wide)
    }

    /// Shapes, in the order of their weights.
    pub fn shapes(&self) -> Shapes<'a> {
        Shapes::new(self.shapes, self.shape_count, self.wide)
    }

    /// Number of shapes.
    pub fn shape_count(&self) -> usize {
        usize::from(self.shape_count)
    }

    /// Names that drive shapes: each a hash, and what it drives.
    pub fn names(&self) -> impl Iterator<Item = Name> {
        self.names.chunks_exact(NAME_LEN).filter_map(Name::parse)
    }
}

/// Mirror images of vertices in the middle or left.
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

/// What `check` reads off the front.
fn consumed<'a>(bytes: &mut Bytes<'a>, check: impl FnOnce(&mut Bytes<'a>) -> Result<(), Error>) -> Result<&'a [u8], Error> {
    let before = bytes.0;
    check(bytes)?;
    Ok(before.get(..before.len() - bytes.0.len()).unwrap_or(&[]))
}

/// A channel's name, and what a channel so called drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Name {
    /// FNV-1a of the name, 32 bits.
    pub hash: u32,
    /// What it drives.
    pub target: Target,
    /// A value of 1 is a weight of mantissa * 2^exponent.
    pub mantissa: i8,
    /// See [`Name::mantissa`].
    pub exponent: i8,
}

impl Name {
    fn parse(entry: &[u8]) -> Option<Name> {
        let &[a, b, c, d, target, mantissa, exponent] = entry else { return None };
        let hash = u32::from_le_bytes([a, b, c, d]);
        Some(Name { hash, target: Target(target), mantissa: mantissa as i8, exponent: exponent as i8 })
    }
}

/// A shape's weights: of one of its sides, or both.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Target(u8);

impl Target {
    /// Of a shape below 64.
    pub fn of(shape: u8, sides: [bool; 2]) -> Target {
        Target(shape & 0x3f | u8::from(sides[0]) << 6 | u8::from(sides[1]) << 7)
    }

    /// Index of the shape.
    #[inline(always)]
    pub fn shape(self) -> usize {
        usize::from(self.0 & 0x3f)
    }

    /// Whether it is the shape as it is stored (the left side), and its mirror image.
    #[inline(always)]
    pub fn sides(self) -> [bool; 2] {
        [self.0 & 0x40 != 0, self.0 & 0x80 != 0]
    }
}
