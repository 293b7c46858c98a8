//! Any `embedded-graphics` target as a surface: the same pixels, one by one.

use super::Surface;
use crate::ink::Ink;
use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::Point;

/// Draws on the target, and keeps its first error.
pub struct OnTarget<'a, D: DrawTarget> {
    target: &'a mut D,
    size: [i32; 2],
    outcome: Result<(), D::Error>,
}

impl<'a, D: DrawTarget> OnTarget<'a, D> {
    /// Over the whole target.
    pub fn new(target: &'a mut D) -> Self {
        let area = target.bounding_box();
        let end = area.top_left + area.size;
        OnTarget { target, size: [end.x, end.y], outcome: Ok(()) }
    }

    /// What became of it.
    pub fn outcome(self) -> Result<(), D::Error> {
        self.outcome
    }
}

impl<D: DrawTarget> Surface for OnTarget<'_, D>
where
    D::Color: Ink,
{
    type Ink = D::Color;
    type Cursor = Point;

    fn size(&self) -> [i32; 2] {
        self.size
    }

    fn cursor(&self, x: i32, y: i32) -> Point {
        Point::new(x, y)
    }

    fn across(cursor: &mut Point, right: bool) {
        cursor.x += if right { 1 } else { -1 };
    }

    fn along(cursor: &mut Point, down: bool) {
        cursor.y += if down { 1 } else { -1 };
    }

    fn put(&mut self, cursor: Point, ink: D::Color) {
        if self.outcome.is_ok() {
            self.outcome = self.target.draw_iter([Pixel(cursor, ink)]);
        }
    }

    /// A target's pixels cannot be read: those that are covered by half or more are set.
    fn blend(&mut self, cursor: Point, ink: D::Color, cover: u32) {
        if cover >= 8 {
            self.put(cursor, ink);
        }
    }

    fn mark(&mut self, _from: [i32; 2], _to: [i32; 2]) {}
}
