//! Single pixels.

use crate::surface::Surface;

/// Sets pixels that are on the surface, and keeps the rectangle that they lie in.
pub struct Dots<'a, S: Surface> {
    surface: &'a mut S,
    size: [i32; 2],
    least: [i32; 2],
    most: [i32; 2],
}

impl<'a, S: Surface> Dots<'a, S> {
    /// None yet.
    #[inline(always)]
    pub fn on(surface: &'a mut S) -> Self {
        let size = surface.size();
        Dots { surface, size, least: size, most: [-1; 2] }
    }

    /// One.
    #[inline(always)]
    pub fn put(&mut self, [x, y]: [i32; 2], ink: S::Ink) {
        if (x as u32) < self.size[0] as u32 && (y as u32) < self.size[1] as u32 {
            self.least = [self.least[0].min(x), self.least[1].min(y)];
            self.most = [self.most[0].max(x), self.most[1].max(y)];
            let cursor = self.surface.cursor(x, y);
            self.surface.put(cursor, ink);
        }
    }

    /// Tells the surface where they are.
    pub fn mark(self) {
        if self.most[0] >= 0 {
            self.surface.mark(self.least, self.most);
        }
    }
}
