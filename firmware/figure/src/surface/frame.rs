//! A framebuffer that knows what changed since it was last sent.

use super::{Bands, Cursor, Surface, Window};
use crate::ink::Ink;
use core::convert::Infallible;
use core::marker::PhantomData;
use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Size};

/// How a display keeps its pixels.
pub trait Layout {
    /// A unit of its memory.
    type Cell: Cell;
    /// All of its memory.
    type Cells: AsRef<[Self::Cell]> + AsMut<[Self::Cell]> + Clone;
    /// What a pixel shows.
    type Ink: Ink;
    /// A pixel's place.
    type Cursor: Cursor;
    /// Columns: at most 256.
    const WIDTH: usize;
    /// Rows: at most 320.
    const HEIGHT: usize;
    /// Columns and rows of pixels in a cell.
    const CELL: [usize; 2];
    /// All dark.
    const DARK: Self::Cells;
    /// Whether the display's driver hands over dark memory after each picture: then [`Framebuffer::clear`] need not darken it.
    const STARTS_DARK: bool = false;

    /// The place of a pixel inside.
    fn cursor(x: usize, y: usize) -> Self::Cursor;
    /// Sets a pixel. A cursor that has left the memory changes nothing.
    fn put(cells: &mut [Self::Cell], cursor: Self::Cursor, ink: Self::Ink);
    /// Sets the pixels of row `y` from column `from` to column `to`; all are inside. See [`Surface::span`].
    #[inline]
    fn span(cells: &mut [Self::Cell], y: usize, [from, to]: [usize; 2], ink: Self::Ink) {
        let mut cursor = Self::cursor(from, y);
        for _ in from..to {
            Self::put(cells, cursor, ink);
            cursor.across(true);
        }
        Self::put(cells, cursor, ink);
    }
    /// Sets a span of each row from `first` on, as far as it is inside; all rows are. See [`Surface::spans`].
    #[inline]
    fn spans(cells: &mut [Self::Cell], first: usize, spans: &[[i16; 2]], ink: Self::Ink) {
        for (span, row) in spans.iter().zip(first..) {
            if let Some(columns) = inside(span, Self::WIDTH) {
                Self::span(cells, row, columns, ink);
            }
        }
    }
    /// Sets every other pixel of row `y` from column `from` to column `to`; all are inside. See [`Surface::alternate`].
    #[inline]
    fn alternate(cells: &mut [Self::Cell], y: usize, [from, to]: [usize; 2], ink: Self::Ink) {
        let mut cursor = Self::cursor(from, y);
        for _ in 0..(to - from) / 2 {
            Self::put(cells, cursor, ink);
            cursor.across(true);
            cursor.across(true);
        }
        Self::put(cells, cursor, ink);
    }
    /// See [`Surface::blend`].
    fn blend(cells: &mut [Self::Cell], cursor: Self::Cursor, ink: Self::Ink, cover: u32);
    /// What a pixel shows.
    fn get(cells: &[Self::Cell], cursor: Self::Cursor) -> Self::Ink;
}

/// A unit of a display's memory.
pub trait Cell: Copy {
    /// The bytes in which it is sent.
    type Wire: AsRef<[u8]>;
    /// All its pixels dark.
    const DARK: Self;
    /// The bytes in the order in which a display takes them.
    fn wire(self) -> Self::Wire;
}

impl Cell for u8 {
    type Wire = [u8; 1];
    const DARK: u8 = 0;

    fn wire(self) -> [u8; 1] {
        [self]
    }
}

impl Cell for u32 {
    type Wire = [u8; 4];
    const DARK: u32 = 0;

    fn wire(self) -> [u8; 4] {
        self.to_be_bytes()
    }
}

impl Window {
    /// The window in cells: those that it touches.
    #[inline(always)]
    pub fn cells<L: Layout>(&self) -> Window {
        let ([across, down], [left, right], [top, bottom]) = (L::CELL, self.columns, self.rows);
        Window { columns: [left / across, right / across], rows: [top / down, bottom / down] }
    }
}

/// A display's memory.
#[derive(Clone, Debug)]
pub struct Framebuffer<L: Layout> {
    cells: L::Cells,
    /// Drawn since the last [`Framebuffer::clear`].
    drawn: Bands,
    /// What the display shows otherwise: drawn before that, or darkened by it.
    before: Bands,
    layout: PhantomData<L>,
}

impl<L: Layout> Framebuffer<L> {
    /// A dark picture, of which the display has seen nothing.
    pub fn new() -> Self {
        const { assert!(L::WIDTH <= 256 && L::HEIGHT <= 320) };
        Framebuffer { cells: L::DARK, drawn: Bands::CLEAN, before: Bands::all(L::WIDTH, L::HEIGHT), layout: PhantomData }
    }

    /// Darkens what was drawn.
    pub fn clear(&mut self) {
        for window in self.drawn.windows(if L::STARTS_DARK { 0 } else { L::HEIGHT }) {
            let Window { columns: [from, to], rows: [top, bottom] } = window.cells::<L>();
            let wide = L::WIDTH / L::CELL[0];
            let rows = self.cells.as_mut().get_mut(top * wide..(bottom + 1) * wide).unwrap_or_default();
            // A call takes as long as this many cells: rows in one stretch take less than their parts one by one.
            if wide - (to + 1 - from) <= CALL && bottom > top {
                fill(rows, L::Cell::DARK);
                continue;
            }
            for row in rows.chunks_exact_mut(wide) {
                fill(row.get_mut(from..=to).unwrap_or_default(), L::Cell::DARK);
            }
        }
        self.before.join(&self.drawn, L::HEIGHT);
        self.drawn = Bands::CLEAN;
    }

    /// The windows in which the picture may differ from what was sent. From here on all of it counts as sent.
    pub fn send(&mut self) -> impl Iterator<Item = Window> + use<L> {
        let mut changed = self.before;
        changed.join(&self.drawn, L::HEIGHT);
        self.before = Bands::CLEAN;
        changed.windows(L::HEIGHT)
    }

    /// The memory as the display takes it.
    pub fn cells(&self) -> &[L::Cell] {
        self.cells.as_ref()
    }

    /// The memory itself, for a display's driver that swaps it with what is shown.
    pub fn memory(&mut self) -> &mut L::Cells {
        &mut self.cells
    }

    /// The cells that a window touches, row by row.
    pub fn stretches(&self, window: Window) -> impl Iterator<Item = &[L::Cell]> {
        let Window { columns: [from, to], rows: [top, bottom] } = window.cells::<L>();
        let rows = self.cells().chunks_exact(L::WIDTH / L::CELL[0]).take(bottom + 1).skip(top);
        rows.filter_map(move |row| row.get(from..=to))
    }

    /// What a pixel inside shows.
    pub fn pixel(&self, x: usize, y: usize) -> L::Ink {
        L::get(self.cells(), L::cursor(x, y))
    }
}

/// Cells that are filled in the time that it takes to begin.
pub(super) const CALL: usize = 16;

/// Eight at a time: the library's way takes three instructions a word. A value that the compiler does not know keeps it from
/// going that way all the same.
#[inline(never)]
pub(super) fn fill<C: Cell>(cells: &mut [C], with: C) {
    let with = core::hint::black_box(with);
    let (blocks, rest) = cells.as_chunks_mut::<8>();
    for [a, b, c, d, e, f, g, h] in blocks {
        (*a, *b, *c, *d) = (with, with, with, with);
        (*e, *f, *g, *h) = (with, with, with, with);
    }
    rest.iter_mut().for_each(|cell| *cell = with);
}

impl<L: Layout> Default for Framebuffer<L> {
    fn default() -> Self {
        Framebuffer::new()
    }
}

impl<L: Layout> Surface for Framebuffer<L> {
    type Ink = L::Ink;
    type Cursor = L::Cursor;

    fn size(&self) -> [i32; 2] {
        [L::WIDTH as i32, L::HEIGHT as i32]
    }

    #[inline(always)]
    fn cursor(&self, x: i32, y: i32) -> L::Cursor {
        L::cursor(x as usize, y as usize)
    }

    #[inline(always)]
    fn put(&mut self, cursor: L::Cursor, ink: L::Ink) {
        L::put(self.cells.as_mut(), cursor, ink);
    }

    #[inline(always)]
    fn span(&mut self, y: i32, columns: [i32; 2], ink: L::Ink) {
        L::span(self.cells.as_mut(), y as usize, columns.map(|x| x as usize), ink);
    }

    /// What is hollow, too: a second span in a row takes as long as 40 pixels.
    #[inline(never)]
    fn spans(&mut self, first: i32, spans: &[[i16; 2]], _hollow: &[[i16; 2]], ink: L::Ink) {
        L::spans(self.cells.as_mut(), first as usize, spans, ink);
    }

    #[inline(always)]
    fn alternate(&mut self, y: i32, columns: [i32; 2], ink: L::Ink) {
        L::alternate(self.cells.as_mut(), y as usize, columns.map(|x| x as usize), ink);
    }

    #[inline(always)]
    fn blend(&mut self, cursor: L::Cursor, ink: L::Ink, cover: u32) {
        L::blend(self.cells.as_mut(), cursor, ink, cover);
    }

    fn mark(&mut self, from: [i32; 2], to: [i32; 2]) {
        self.drawn.mark(from, to);
    }
}

impl<L: Layout> OriginDimensions for Framebuffer<L> {
    fn size(&self) -> Size {
        Size::new(L::WIDTH as u32, L::HEIGHT as u32)
    }
}

/// For text and whatever else `embedded-graphics` draws.
impl<L: Layout> DrawTarget for Framebuffer<L> {
    type Color = L::Ink;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<L::Ink>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(place, ink) in pixels {
            let inside = (0..L::WIDTH as i32).contains(&place.x) && (0..L::HEIGHT as i32).contains(&place.y);
            if inside {
                self.mark([place.x, place.y], [place.x, place.y]);
                L::put(self.cells.as_mut(), L::cursor(place.x as usize, place.y as usize), ink);
            }
        }
        Ok(())
    }
}

/// The columns of a span that are on a surface of `width` columns; `None` if there are none.
#[inline(always)]
pub(super) fn inside(&[low, high]: &[i16; 2], width: usize) -> Option<[usize; 2]> {
    let (low, high) = (i32::from(low).max(0), i32::from(high).min(width as i32 - 1));
    (low <= high).then_some([low as usize, high as usize])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{Gray4Rows, MonoPages, Rgb565Rows};
    use embedded_graphics::pixelcolor::{BinaryColor, Gray4, Rgb565};

    fn spans_are_their_pixels<L: Layout<Ink: PartialEq + core::fmt::Debug>>(ink: L::Ink) {
        let mut random = fastrand::Rng::with_seed(5);
        for _ in 0..300 {
            let (mut spans, mut pixels) = (Framebuffer::<L>::new(), Framebuffer::<L>::new());
            let first = random.i32(0..16);
            let rows: Vec<[i16; 2]> = (first..16).map(|_| [random.i16(-9..40), random.i16(-9..40)]).collect();
            Surface::spans(&mut spans, first, &rows, &[], ink);
            for (&[low, high], y) in rows.iter().zip(first..) {
                for x in i32::from(low).max(0)..=i32::from(high).min(L::WIDTH as i32 - 1) {
                    let cursor = pixels.cursor(x, y);
                    Surface::put(&mut pixels, cursor, ink);
                }
            }
            for (x, y) in (0..L::WIDTH).flat_map(|x| (0..L::HEIGHT).map(move |y| (x, y))) {
                assert_eq!(spans.pixel(x, y), pixels.pixel(x, y), "{x} {y}: {rows:?} from {first}");
            }
        }
    }

    #[test]
    fn spans_are_their_pixels_as_far_as_they_are_inside() {
        spans_are_their_pixels::<Gray4Rows<32, 16, 64>>(Gray4::new(9));
        spans_are_their_pixels::<MonoPages<32, 16, 64>>(BinaryColor::On);
        spans_are_their_pixels::<Rgb565Rows<32, 16, 256>>(Rgb565::new(3, 40, 29));
    }
}
