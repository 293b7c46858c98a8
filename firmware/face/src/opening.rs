//! An opening between two edges, an eye or the mouth, as a model stores it.

use crate::bytes::Bytes;
use crate::error::ModelError;
use crate::format::NO_SHAPE;
use crate::model::Model;

/// An opening. Its members are clipped by its edges.
pub(crate) struct Opening<'a> {
    /// Whether it has a mirror image.
    pub mirrored: bool,
    /// The shape whose weight lowers the lower edge for the members, by `drop` steps at full weight.
    pub release: u8,
    pub drop: i16,
    /// Indices of the edges' vertices, each from one corner to the other.
    pub upper: &'a [u8],
    pub lower: &'a [u8],
    pub members: &'a [u8],
}

impl<'a> Opening<'a> {
    pub fn parse(bytes: &mut Bytes<'a>, wide: bool) -> Result<Self, ModelError> {
        let [flags, release] = bytes.array()?;
        let drop = bytes.i16()?;
        let counts: [u8; 3] = bytes.array()?;
        let [upper, lower, members] = counts.map(|count| bytes.take(usize::from(count) << u32::from(wide)));
        if flags > 1 || counts[0] < 2 || counts[1] < 2 {
            return Err(ModelError::Malformed);
        }
        Ok(Opening { mirrored: flags != 0, release, drop, upper: upper?, lower: lower?, members: members? })
    }

    /// Checks `count` openings.
    pub fn check(bytes: &mut Bytes, count: u8, model: &Model) -> Result<(), ModelError> {
        for _ in 0..count {
            let opening = Opening::parse(bytes, model.wide)?;
            if opening.release != NO_SHAPE && usize::from(opening.release) >= model.shape_count() {
                return Err(ModelError::Malformed);
            }
            let mut members = Bytes(opening.members);
            while !members.0.is_empty() {
                model.check_run(members.index(model.wide)?, 1)?;
            }
            model.check_indices(opening.upper, model.vertices())?;
            model.check_indices(opening.lower, model.vertices())?;
        }
        Ok(())
    }
}
