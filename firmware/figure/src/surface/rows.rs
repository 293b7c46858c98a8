//! Places in memory that holds rows from the top.

use super::Cursor;

/// A pixel's number, row by row of `WIDTH`.
#[derive(Clone, Copy, Debug)]
pub struct InRows<const WIDTH: usize>(pub usize);

impl<const WIDTH: usize> InRows<WIDTH> {
    /// Of a pixel inside.
    #[inline(always)]
    pub fn at(x: usize, y: usize) -> Self {
        InRows(y * WIDTH + x)
    }
}

impl<const WIDTH: usize> Cursor for InRows<WIDTH> {
    #[inline(always)]
    fn across(&mut self, right: bool) {
        self.0 = if right { self.0.wrapping_add(1) } else { self.0.wrapping_sub(1) };
    }

    #[inline(always)]
    fn along(&mut self, down: bool) {
        self.0 = if down { self.0.wrapping_add(WIDTH) } else { self.0.wrapping_sub(WIDTH) };
    }
}
