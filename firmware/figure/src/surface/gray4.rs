//! Rows from the top, two pixels of 16 greys a byte, the left one in the high half: SSD0323, SSD1322, SSD1327.

use super::{InRows, Layout};
use embedded_graphics::pixelcolor::{Gray4, GrayColor};

/// The layout of a display of `WIDTH` x `HEIGHT`; `WORDS` is an eighth of their product.
///
/// Eight pixels are a word, whose bytes go to the display with the least first: that clears four times as fast as bytes.
#[derive(Clone, Copy, Debug)]
pub struct Gray4Rows<const WIDTH: usize, const HEIGHT: usize, const WORDS: usize>;

/// Where a pixel lies in its word: the left one of a byte is its high half.
#[inline(always)]
fn shift(number: usize) -> u32 {
    ((number as u32 ^ 1) & 7) * 4
}

impl<const WIDTH: usize, const HEIGHT: usize, const WORDS: usize> Layout for Gray4Rows<WIDTH, HEIGHT, WORDS> {
    type Cell = u32;
    type Cells = [u32; WORDS];
    type Ink = Gray4;
    type Cursor = InRows<WIDTH>;
    const WIDTH: usize = WIDTH;
    const HEIGHT: usize = HEIGHT;
    const CELL: [usize; 2] = [8, 1];
    const DARK: [u32; WORDS] = {
        assert!(WORDS * 8 == WIDTH * HEIGHT && WIDTH.is_multiple_of(8));
        [0; WORDS]
    };

    #[inline(always)]
    fn cursor(x: usize, y: usize) -> InRows<WIDTH> {
        InRows::at(x, y)
    }

    #[inline(always)]
    fn put(cells: &mut [u32], cursor: InRows<WIDTH>, ink: Gray4) {
        let Some(cell) = cells.get_mut(cursor.0 >> 3) else { return };
        let shift = shift(cursor.0);
        *cell = *cell & !(15 << shift) | u32::from(ink.luma()) << shift;
    }

    #[inline(always)]
    fn blend(cells: &mut [u32], cursor: InRows<WIDTH>, ink: Gray4, cover: u32) {
        let was = Self::get(cells, cursor).luma();
        let luma = ((u32::from(ink.luma()) * cover + 8) >> 4) as u8;
        Self::put(cells, cursor, Gray4::new(was.max(luma)));
    }

    #[inline(always)]
    fn get(cells: &[u32], cursor: InRows<WIDTH>) -> Gray4 {
        let cell = cells.get(cursor.0 >> 3).copied().unwrap_or(0);
        Gray4::new((cell >> shift(cursor.0)) as u8 & 15)
    }
}
