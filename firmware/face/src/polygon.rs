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

    /// Draws the parts of all rows whose middle is inside: between the first and the second edge that crosses it, the third and the fourth, and so on.
    pub fn fill(&self, out: &mut impl StrokeSink) {
        let heights = || self.0.iter().map(|corner| i32::from(corner[1]));
        let (Some(top), Some(bottom)) = (heights().min(), heights().max()) else { return };
        // Rows beyond any display are left out: a display has fewer than 2^11.
        let (mut row, last) = ((top >> PIXEL_BITS).max(0), bottom >> PIXEL_BITS);
        let mut edges = Vec::new();
        while row <= last {
            // Until the middle of a row passes the next corner, the same edges cross it.
            let until = self.crossed(middle_of(row), &mut edges);
            while row <= last && middle_of(row) < until {
                fill_row(row, &edges, out);
                row += 1;
            }
        }
    }

    /// Finds the edges that a height crosses, and returns the height of the next corner below it.
    #[inline(always)]
    fn crossed(&self, height: i32, edges: &mut Vec<Edge, CROSSINGS>) -> i32 {
        edges.clear();
        let mut until = i32::MAX;
        let Some((&first, rest)) = self.0.split_first() else { return until };
        let is_above = |corner: [i16; 2]| i32::from(corner[1]) <= height;
        let (mut from, mut from_above) = (first, true);
        if !is_above(first) {
            (from_above, until) = (false, first[1].into());
        }
        for &to in rest {
            let above = is_above(to);
            if above != from_above {
                let _ = edges.push([from, to]);
            }
            if !above {
                until = until.min(to[1].into());
            }
            (from, from_above) = (to, above);
        }
        if from_above != is_above(first) {
            let _ = edges.push([from, first]);
        }
        until
    }
}

/// An edge of a polygon that crosses a row.
type Edge = [[i16; 2]; 2];

/// The height of the middle of a row.
const fn middle_of(row: i32) -> i32 {
    (row << PIXEL_BITS) + HALF
}

/// Draws the parts of a row between the edges that cross it.
fn fill_row(row: i32, edges: &[Edge], out: &mut impl StrokeSink) {
    let crossing = |&[[x, y], [to_x, to_y]]: &Edge| {
        let (x, y) = (i32::from(x), i32::from(y));
        let across = (i32::from(to_x) - x) * (middle_of(row) - y);
        // The heights differ, because they are on two sides of the middle.
        (x + across.checked_div(i32::from(to_y) - y).unwrap_or(0)) as i16
    };
    if let [a, b] = edges {
        let (a, b) = (crossing(a), crossing(b));
        return out.span(row, [a.min(b), a.max(b)]);
    }
    let mut crossings: Vec<i16, CROSSINGS> = Vec::new();
    for edge in edges {
        let _ = crossings.push(crossing(edge));
        for last in (1..crossings.len()).rev() {
            if let Some([a, b]) = crossings.get_mut(last - 1..=last)
                && *a > *b
            {
                core::mem::swap(a, b);
            }
        }
    }
    crossings.as_chunks::<2>().0.iter().for_each(|&pair| out.span(row, pair));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pen::Pen;
    use pantin_figure::surface::{Framebuffer, Gray4Rows, Layout, MonoPages, Rgb565Rows};

    /// Draws every row by a line between crossings that are found again for it.
    fn fill_by_lines(corners: &[[i16; 2]], out: &mut impl StrokeSink) {
        let heights = || corners.iter().map(|corner| i32::from(corner[1]));
        let (Some(top), Some(bottom)) = (heights().min(), heights().max()) else { return };
        for row in (top >> PIXEL_BITS).max(0)..=(bottom >> PIXEL_BITS) {
            let middle = middle_of(row);
            let edges = (0..corners.len()).map(|index| (corners[index], corners[(index + 1) % corners.len()]));
            let crossing = edges.filter(|(a, b)| (i32::from(a[1]) <= middle) != (i32::from(b[1]) <= middle));
            let at = |([x, y], [to_x, to_y]): ([i16; 2], [i16; 2])| {
                let across = (i32::from(to_x) - i32::from(x)) * (middle - i32::from(y));
                (i32::from(x) + across / (i32::from(to_y) - i32::from(y))) as i16
            };
            let mut places: std::vec::Vec<i16> = crossing.take(CROSSINGS).map(at).collect();
            places.sort_unstable();
            for pair in places.chunks_exact(2) {
                out.line([pair[0], middle as i16], [pair[1], middle as i16]);
            }
        }
    }

    /// Fills shapes of every kind both ways on a display of this layout.
    fn compare<L: Layout + Clone>(seed: u64)
    where
        L::Cell: PartialEq,
    {
        let mut random = fastrand::Rng::with_seed(seed);
        let mut next = |least: i32, most: i32| random.i32(least..=most) as i16;
        for series in 0..120 {
            let (mut by_rows, mut by_lines) = (Framebuffer::<L>::new(), Framebuffer::<L>::new());
            let [width, height] = [L::WIDTH, L::HEIGHT].map(|pixels| (pixels << PIXEL_BITS) as i32);
            for picture in 0..150 {
                by_rows.clear();
                by_lines.clear();
                by_rows.send().count();
                // Inside, beyond the edges, and far outside.
                let beyond = [0, 200, 20_000][series % 3];
                let corners: std::vec::Vec<_> =
                    (0..next(1, 12)).map(|_| [next(-beyond, width + beyond), next(-beyond / 4, height + beyond / 4)]).collect();
                let mut polygon = Polygon::new();
                corners.iter().for_each(|&corner| polygon.add(corner));
                for shade in [200, 0] {
                    let mut pen = Pen::on(&mut by_rows);
                    pen.begin(shade);
                    polygon.fill(&mut pen);
                    pen.end();
                    let mut pen = Pen::on(&mut by_lines);
                    pen.begin(shade);
                    fill_by_lines(&corners, &mut pen);
                    pen.end();
                    assert!(
                        by_rows.cells() == by_lines.cells(),
                        "series {series}, picture {picture}, brightness {shade}: {corners:?}"
                    );
                    if shade == 0 {
                        continue;
                    }
                    let mut cleared = by_rows.clone();
                    cleared.clear();
                    assert!(cleared.cells().iter().all(|cell| *cell == cleared.cells()[0]), "series {series}: not all is marked");
                }
            }
        }
    }

    #[test]
    fn rows_of_a_shape_are_the_lines_between_its_edges_on_every_layout() {
        compare::<Gray4Rows<128, 64, 1024>>(1);
        compare::<MonoPages<128, 64, 1024>>(2);
        compare::<Rgb565Rows<80, 60, 2400>>(3);
    }
}
