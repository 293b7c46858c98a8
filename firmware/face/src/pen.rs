//! Strokes of a face on a surface: many short lines, of which the beginning costs more than the pixels.

use pantin_figure::draw::stroke;
use pantin_figure::ink::{Ink, Tone};
use pantin_figure::lines::{Line, pixel};
use pantin_figure::surface::Surface;

/// Takes lines, in strokes of one brightness.
pub(crate) trait Paint {
    /// A stroke begins.
    fn begin(&mut self, shade: u8);
    /// A line of it.
    fn line(&mut self, from: [i16; 2], to: [i16; 2]);
    /// The stroke ends.
    fn end(&mut self) {}
}

/// Gives each line to a function.
pub(crate) struct Each<F> {
    out: F,
    shade: u8,
}

impl<F: FnMut(Line)> Each<F> {
    pub fn new(out: F) -> Self {
        Each { out, shade: 0 }
    }
}

impl<F: FnMut(Line)> Paint for Each<F> {
    #[inline(always)]
    fn begin(&mut self, shade: u8) {
        self.shade = shade;
    }

    #[inline(always)]
    fn line(&mut self, from: [i16; 2], to: [i16; 2]) {
        (self.out)(line(from, to, self.shade));
    }
}

fn line(from: [i16; 2], to: [i16; 2], shade: u8) -> Line {
    Line { from, to, depth: 0, shade, tone: Tone::Middle, width: 1 }
}

/// Sets the pixels that [`stroke`] would, and tells the surface of a whole stroke at once.
pub(crate) struct Pen<'a, S: Surface> {
    surface: &'a mut S,
    size: [i32; 2],
    shade: u8,
    ink: S::Ink,
    least: [i32; 2],
    most: [i32; 2],
}

impl<'a, S: Surface> Pen<'a, S> {
    pub fn on(surface: &'a mut S) -> Self {
        let size = surface.size();
        Pen { surface, size, shade: 0, ink: S::Ink::DARK, least: size, most: [-1; 2] }
    }

    /// Sets the pixels of a line from the end at the left, or at the top of a steep one: `along` pixels that way.
    #[inline(always)]
    fn walk<const STEEP: bool, const BACK: bool>(&mut self, [x, y]: [i32; 2], along: i32, aside: i32) {
        let mut cursor = self.surface.cursor(x, y);
        let (mut rest, mut left) = (-along, along);
        loop {
            self.surface.put(cursor, self.ink);
            if left == 0 {
                break;
            }
            left -= 1;
            rest += 2 * aside;
            if STEEP { S::along(&mut cursor, true) } else { S::across(&mut cursor, true) }
            if rest >= 0 {
                rest -= 2 * along;
                if STEEP { S::across(&mut cursor, !BACK) } else { S::along(&mut cursor, !BACK) }
            }
        }
    }

    /// Takes a rectangle into that of the stroke.
    #[inline(always)]
    fn cover(&mut self, left: i32, top: i32, right: i32, bottom: i32) {
        self.least = [self.least[0].min(left), self.least[1].min(top)];
        self.most = [self.most[0].max(right), self.most[1].max(bottom)];
    }
}

impl<S: Surface> Paint for Pen<'_, S> {
    #[inline(always)]
    fn begin(&mut self, shade: u8) {
        (self.shade, self.ink) = (shade, S::Ink::of(Tone::Middle, shade));
    }

    #[inline(never)]
    fn line(&mut self, from: [i16; 2], to: [i16; 2]) {
        let (a, b) = ([pixel(from[0]), pixel(from[1])], [pixel(to[0]), pixel(to[1])]);
        let [columns, rows] = self.size;
        let inside = |[x, y]: [i32; 2]| (x as u32) < columns as u32 && (y as u32) < rows as u32;
        if !inside(a) || !inside(b) {
            return stroke(&line(from, to, self.shade), self.surface, false);
        }
        let (x, y) = (b[0] - a[0], b[1] - a[1]);
        let steep = y.abs() > x.abs();
        let (a, b, x, y) = if (if steep { y } else { x }) < 0 { (b, a, -x, -y) } else { (a, b, x, y) };
        match (steep, (if steep { x } else { y }) < 0) {
            (false, false) => {
                self.cover(a[0], a[1], b[0], b[1]);
                self.walk::<false, false>(a, x, y);
            }
            (false, true) => {
                self.cover(a[0], b[1], b[0], a[1]);
                self.walk::<false, true>(a, x, -y);
            }
            (true, false) => {
                self.cover(a[0], a[1], b[0], b[1]);
                self.walk::<true, false>(a, y, x);
            }
            (true, true) => {
                self.cover(b[0], a[1], a[0], b[1]);
                self.walk::<true, true>(a, y, -x);
            }
        }
    }

    #[inline(always)]
    fn end(&mut self) {
        if self.most[0] >= 0 {
            self.surface.mark(self.least, self.most);
            (self.least, self.most) = (self.size, [-1; 2]);
        }
    }
}
