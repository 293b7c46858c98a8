//! Any `embedded-graphics` target as a surface: the same pixels, one by one.

use super::{Cursor, Surface};
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

/// A point as a cursor.
#[derive(Clone, Copy, Debug)]
pub struct Place(Point);

impl Cursor for Place {
    fn across(&mut self, right: bool) {
        self.0.x += if right { 1 } else { -1 };
    }

    fn along(&mut self, down: bool) {
        self.0.y += if down { 1 } else { -1 };
    }
}

impl<D: DrawTarget> Surface for OnTarget<'_, D>
where
    D::Color: Ink,
{
    type Ink = D::Color;
    type Cursor = Place;

    fn size(&self) -> [i32; 2] {
        self.size
    }

    fn cursor(&self, x: i32, y: i32) -> Place {
        Place(Point::new(x, y))
    }

    fn put(&mut self, cursor: Place, ink: D::Color) {
        if self.outcome.is_ok() {
            self.outcome = self.target.draw_iter([Pixel(cursor.0, ink)]);
        }
    }

    /// A target's pixels cannot be read: those that are covered by half or more are set.
    fn blend(&mut self, cursor: Place, ink: D::Color, cover: u32) {
        if cover >= 8 {
            self.put(cursor, ink);
        }
    }

    fn mark(&mut self, _from: [i32; 2], _to: [i32; 2]) {}
}
