//! Framebuffers in the layouts that displays take, and what the rasterizer asks of any of them.

mod bands;
mod frame;
mod gray4;
mod mono;
mod on_target;
mod rgb565;

pub use bands::{BAND, Bands, Window};
pub use frame::{Cell, Frame, Layout};
pub use gray4::Gray4Rows;
pub use mono::MonoPages;
pub use on_target::OnTarget;
pub use rgb565::{Pair, Rgb565Rows};

use crate::ink::Ink;

/// What lines and discs are drawn on. A cursor is a pixel's place in the layout's own terms; whoever moves it keeps it on
/// the surface.
pub trait Surface {
    /// What a pixel shows.
    type Ink: Ink;
    /// A place on the surface.
    type Cursor: Copy;

    /// Columns and rows.
    fn size(&self) -> [i32; 2];

    /// The cursor of a pixel inside.
    fn cursor(&self, x: i32, y: i32) -> Self::Cursor;

    /// Moves it a column to the right, or to the left.
    fn across(cursor: &mut Self::Cursor, right: bool);

    /// Moves it a row down, or up.
    fn along(cursor: &mut Self::Cursor, down: bool);

    /// Sets a pixel.
    fn put(&mut self, cursor: Self::Cursor, ink: Self::Ink);

    /// Sets so many pixels from a place to the right.
    #[inline]
    fn span(&mut self, mut cursor: Self::Cursor, count: usize, ink: Self::Ink) {
        for _ in 0..count {
            self.put(cursor, ink);
            Self::across(&mut cursor, true);
        }
    }

    /// Brightens a pixel towards the ink: `cover` of 16 parts of it, and never darker than it was.
    fn blend(&mut self, cursor: Self::Cursor, ink: Self::Ink, cover: u32);

    /// Notes that pixels of a rectangle inside may have changed; ends belong to it.
    fn mark(&mut self, from: [i32; 2], to: [i32; 2]);
}
