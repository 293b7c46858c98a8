//! Draws the strokes of a face on a surface: many short lines, whose set-up costs more than their pixels.

use pantin_figure::camera::PIXEL_BITS;
use pantin_figure::draw::stroke;
use pantin_figure::ink::{BodyPart, Ink};
use pantin_figure::lines::{Line, pixel};
use pantin_figure::raster::{Pace, walk};
use pantin_figure::surface::Surface;

/// Takes lines, grouped in strokes of one brightness.
pub(crate) trait StrokeSink {
    /// Begins a stroke.
    fn begin(&mut self, shade: u8);
    /// Adds a line; ends are in sixteenths of a pixel.
    fn line(&mut self, from: [i16; 2], to: [i16; 2]);
    /// Adds the part of a row of pixels from one column to another, which is not to the left of it; columns are in sixteenths of a pixel, `row` is
    /// one that a display can have.
    fn span(&mut self, row: i32, columns: [i16; 2]);
    /// Ends the stroke.
    fn end(&mut self) {}
}

/// Passes each line to a function.
pub(crate) struct EachLine<F> {
    out: F,
    shade: u8,
}

impl<F: FnMut(Line)> EachLine<F> {
    pub fn new(out: F) -> Self {
        EachLine { out, shade: 0 }
    }
}

impl<F: FnMut(Line)> StrokeSink for EachLine<F> {
    #[inline(always)]
    fn begin(&mut self, shade: u8) {
        self.shade = shade;
    }

    #[inline(always)]
    fn line(&mut self, from: [i16; 2], to: [i16; 2]) {
        (self.out)(line(from, to, self.shade));
    }

    #[inline(always)]
    fn span(&mut self, row: i32, [from, to]: [i16; 2]) {
        let middle = ((row << PIXEL_BITS) + (1 << (PIXEL_BITS - 1))) as i16;
        self.line([from, middle], [to, middle]);
    }
}

fn line(from: [i16; 2], to: [i16; 2], shade: u8) -> Line {
    Line { from, to, depth: 0, shade, body_part: BodyPart::Middle, width: 1 }
}

/// Sets the same pixels as [`stroke`], and marks the surface once for each stroke.
pub(crate) struct Pen<'a, S: Surface> {
    surface: &'a mut S,
    shade: u8,
    ink: S::Ink,
    /// The pixel where the previous line ended: it is set already.
    at: [i32; 2],
    least: [i32; 2],
    most: [i32; 2],
}

/// A pixel of no line.
const NOWHERE: [i32; 2] = [i32::MAX; 2];

impl<'a, S: Surface> Pen<'a, S> {
    pub fn on(surface: &'a mut S) -> Self {
        Pen { surface, shade: 0, ink: S::Ink::DARK, at: NOWHERE, least: NOWHERE, most: [-1; 2] }
    }

    /// Extends the rectangle of the stroke by a pixel.
    #[inline(always)]
    fn cover(&mut self, [x, y]: [i32; 2]) {
        self.least = [self.least[0].min(x), self.least[1].min(y)];
        self.most = [self.most[0].max(x), self.most[1].max(y)];
    }

    /// Whether a pixel lies on the surface.
    #[inline(always)]
    fn holds(&self, [x, y]: [i32; 2]) -> bool {
        let [columns, rows] = self.surface.size();
        (x as u32) < columns as u32 && (y as u32) < rows as u32
    }

    /// Draws a line that may leave the surface.
    #[inline(never)]
    fn cut(&mut self, from: [i16; 2], to: [i16; 2]) {
        self.at = NOWHERE;
        stroke(&line(from, to, self.shade), self.surface, false);
    }
}

impl<S: Surface> StrokeSink for Pen<'_, S> {
    #[inline(always)]
    fn begin(&mut self, shade: u8) {
        (self.shade, self.ink, self.at) = (shade, S::Ink::of(BodyPart::Middle, shade), NOWHERE);
    }

    #[inline(never)]
    fn line(&mut self, from: [i16; 2], to: [i16; 2]) {
        let (a, b) = ([pixel(from[0]), pixel(from[1])], [pixel(to[0]), pixel(to[1])]);
        // Where the previous line ended is on the surface.
        let goes_on = a == self.at;
        if !(goes_on || self.holds(a)) || !self.holds(b) {
            return self.cut(from, to);
        }
        if !goes_on {
            self.cover(a);
        }
        self.cover(b);
        self.at = b;
        let (x, y) = (b[0] - a[0], b[1] - a[1]);
        if goes_on && x.abs().max(y.abs()) <= 1 {
            let cursor = self.surface.cursor(b[0], b[1]);
            return self.surface.put(cursor, self.ink);
        }
        let steep = y.abs() > x.abs();
        let (along, aside) = if steep { (y, x) } else { (x, y) };
        let reversed = along < 0;
        // The last pixel is omitted where the previous line has set it.
        let (start, along, aside, count) =
            if reversed { (b, -along, -aside, -along - i32::from(goes_on)) } else { (a, along, aside, along) };
        let cursor = self.surface.cursor(start[0], start[1]);
        let pace = Pace::new(steep, aside < 0, along, aside.abs());
        walk(self.surface, cursor, pace, count, self.ink);
    }

    #[inline(always)]
    fn span(&mut self, row: i32, [from, to]: [i16; 2]) {
        let [columns, rows] = self.surface.size();
        let (from, to) = (pixel(from).max(0), pixel(to).min(columns - 1));
        if row < rows && from <= to {
            self.cover([from, row]);
            self.cover([to, row]);
            self.surface.span(row, [from, to], self.ink);
        }
    }

    #[inline(always)]
    fn end(&mut self) {
        if self.most[0] >= 0 {
            self.surface.mark(self.least, self.most);
            (self.least, self.most) = (NOWHERE, [-1; 2]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pantin_figure::surface::{Framebuffer, Gray4Rows};

    type Small = Framebuffer<Gray4Rows<32, 24, 96>>;

    #[test]
    fn a_pen_sets_what_strokes_do_and_marks_what_it_sets() {
        let mut random = fastrand::Rng::with_seed(7);
        let mut next = |least: i16, most: i16| random.i16(least..=most);
        for round in 0..20_000 {
            let (mut by_pen, mut by_strokes) = (Small::new(), Small::new());
            by_pen.send().count();
            let mut pen = Pen::on(&mut by_pen);
            // Strokes of short and long lines, most of them on the surface, some with a gap.
            let reach = if round % 2 == 0 { 40 } else { 400 };
            let mut at = [next(-50, 550), next(-50, 420)];
            for shade in [80, 240] {
                pen.begin(shade);
                for _ in 0..4 {
                    let to = [at[0].saturating_add(next(-reach, reach)), at[1].saturating_add(next(-reach, reach))];
                    pen.line(at, to);
                    stroke(&line(at, to, shade), &mut by_strokes, false);
                    at = if next(0, 5) == 0 { [next(-50, 550), next(-50, 420)] } else { to };
                }
                pen.end();
            }
            assert_eq!(by_pen.cells(), by_strokes.cells(), "round {round}");
            by_pen.clear();
            assert!(by_pen.cells().iter().all(|&cell| cell == 0), "round {round}: not all is cleared");
        }
    }
}
