//! A vertex of a face.

/// The coordinates of a vertex in steps of [`Model::step_exponent`](crate::Model::step_exponent): x points to the face's own left, y up, z ahead.
pub type Vertex = [i16; 3];

/// The vertex that a model stores as these bytes.
#[inline(always)]
pub(crate) fn of_bytes([a, b, c, d, e, f]: [u8; 6]) -> Vertex {
    [i16::from_le_bytes([a, b]), i16::from_le_bytes([c, d]), i16::from_le_bytes([e, f])]
}
