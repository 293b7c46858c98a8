//! Framebuffers in the layouts that displays take, and what the rasterizer asks of any of them.

mod bands;
mod frame;
mod gray4;
mod mono;
mod on_target;
mod rgb565;
mod rows;

pub use bands::{BAND, Bands, Window};
pub use frame::{Cell, Framebuffer, Layout};
pub use gray4::Gray4Rows;
pub use mono::MonoPages;
pub use on_target::OnTarget;
pub use rgb565::{Pair, Rgb565Rows};
pub use rows::InRows;

use crate::ink::Ink;

/// A pixel's place in the terms of what it lies on. Whoever moves it keeps it there.
pub trait Cursor: Copy {
    /// Moves it a column to the right, or to the left.
    fn across(&mut self, right: bool);

    /// Moves it a row down, or up.
    fn along(&mut self, down: bool);
}

/// What lines and discs are drawn on.
pub trait Surface {
    /// What a pixel shows.
    type Ink: Ink;
    /// A place on the surface.
    type Cursor: Cursor;

    /// Columns and rows.
    fn size(&self) -> [i32; 2];

    /// The cursor of a pixel inside.
    fn cursor(&self, x: i32, y: i32) -> Self::Cursor;

    /// Sets a pixel.
    fn put(&mut self, cursor: Self::Cursor, ink: Self::Ink);

    /// Sets the pixels of row `y` from column `from` to column `to`, which belongs to them. All are inside, and `from` is at most `to`.
    #[inline]
    fn span(&mut self, y: i32, [from, to]: [i32; 2], ink: Self::Ink) {
        let mut cursor = self.cursor(from, y);
        for _ in from..to {
            self.put(cursor, ink);
            cursor.across(true);
        }
        self.put(cursor, ink);
    }

    /// Sets a span of each row from `first` on, as far as it is inside; where its first column is greater than its last one there is none. Pixels
    /// of `hollow`, which has a span for each of those rows, or none at all, may be left out: they are drawn afterwards.
    #[inline]
    fn spans(&mut self, first: i32, spans: &[[i16; 2]], hollow: &[[i16; 2]], ink: Self::Ink) {
        let most = self.size()[0] - 1;
        for (index, (span, row)) in spans.iter().zip(first..).enumerate() {
            let (mut low, high) = (i32::from(span[0]).max(0), i32::from(span[1]).min(most));
            if let Some(&[from, to]) = hollow.get(index)
                && i32::from(to) - i32::from(from) >= NARROW
            {
                let end = high.min(i32::from(from) - 1);
                if low <= end {
                    self.span(row, [low, end], ink);
                }
                low = low.max(i32::from(to) + 1);
            }
            if low <= high {
                self.span(row, [low, high], ink);
            }
        }
    }

    /// Sets every other pixel of row `y` from column `from` to column `to`, `from` first. All are inside, and `from` is at most `to`.
    #[inline]
    fn alternate(&mut self, y: i32, [from, to]: [i32; 2], ink: Self::Ink) {
        let mut cursor = self.cursor(from, y);
        for _ in 0..(to - from) / 2 {
            self.put(cursor, ink);
            cursor.across(true);
            cursor.across(true);
        }
        self.put(cursor, ink);
    }

    /// Brightens a pixel towards the ink: `cover` of 16 parts of it, and never darker than it was.
    fn blend(&mut self, cursor: Self::Cursor, ink: Self::Ink, cover: u32);

    /// Notes that pixels of a rectangle inside may have changed; ends belong to it.
    fn mark(&mut self, from: [i32; 2], to: [i32; 2]);
}

/// Spans of at most this many pixels are drawn over: two spans beside them would take longer.
const NARROW: i32 = 8;
