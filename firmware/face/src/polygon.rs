//! Fills a polygon with horizontal lines.

use crate::pen::StrokeSink;
use heapless::Vec;
use pantin_figure::camera::PIXEL_BITS;

/// Maximum number of corners; further ones are ignored.
const CORNERS: usize = 64;
/// Maximum number of edges that cross a row; further ones are ignored.
const CROSSINGS: usize = 8;
/// Half a pixel: rows are sampled in their middle.
const HALF: i32 = 1 << (PIXEL_BITS - 1);

/// Corners in sixteenths of a pixel.
pub(crate) struct Polygon(Vec<[i16; 2], CORNERS>);

impl Polygon {
    pub fn new() -> Polygon {
        Polygon(Vec::new())
    }

    pub fn add(&mut self, corner: [i16; 2]) {
        let _ = self.0.push(corner);
    }

    /// Draws the lines of all rows whose middle is inside: between the first and the second edge that crosses it, the third and the fourth, and so on.
    pub fn fill(&self, out: &mut impl StrokeSink) {
        let heights = || self.0.iter().map(|corner| i32::from(corner[1]));
        let (Some(top), Some(bottom)) = (heights().min(), heights().max()) else { return };
        // Rows beyond any display are left out: a display has fewer than 2^11.
        for row in (top >> PIXEL_BITS).max(0)..=(bottom >> PIXEL_BITS) {
            let middle = (row << PIXEL_BITS) + HALF;
            let mut crossings: Vec<i16, CROSSINGS> = Vec::new();
            let next = self.0.iter().skip(1).chain(self.0.first());
            for (&[x, y], &[to_x, to_y]) in self.0.iter().zip(next) {
                let (y, to_y) = (i32::from(y), i32::from(to_y));
                if (y <= middle) != (to_y <= middle) {
                    let across = (i32::from(to_x) - i32::from(x)) * (middle - y);
                    // The heights differ, because they are on two sides of the middle.
                    let _ = crossings.push((i32::from(x) + across.checked_div(to_y - y).unwrap_or(0)) as i16);
                    // Kept in order: nearly always there are two.
                    for last in (1..crossings.len()).rev() {
                        if let Some([a, b]) = crossings.get_mut(last - 1..=last)
                            && *a > *b
                        {
                            core::mem::swap(a, b);
                        }
                    }
                }
            }
            for pair in crossings.as_chunks::<2>().0 {
                out.line([pair[0], middle as i16], [pair[1], middle as i16]);
            }
        }
    }
}
