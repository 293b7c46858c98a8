//! Room for clips.

/// Room for so many: what the clips that are built in take, but no more than the board has. A clip that takes more is refused when it is
/// opened.
pub const fn fitted(taken: usize, most: usize) -> usize {
    if taken < most { taken } else { most }
}
