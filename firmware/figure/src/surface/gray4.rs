//! Rows from the top, two pixels of 16 greys a byte, the left one in the high half: SSD0323, SSD1322, SSD1327.

use super::Layout;
use embedded_graphics::pixelcolor::{Gray4, GrayColor};

/// The layout of a display of `WIDTH` x `HEIGHT`; `BYTES` is half their product.
#[derive(Clone, Copy, Debug)]
pub struct Gray4Rows<const WIDTH: usize, const HEIGHT: usize, const BYTES: usize>;

impl<const WIDTH: usize, const HEIGHT: usize, const BYTES: usize> Layout for Gray4Rows<WIDTH, HEIGHT, BYTES> {
    type Cell = u8;
    type Cells = [u8; BYTES];
    type Ink = Gray4;
    /// The pixel's number, row by row.
    type Cursor = usize;
    const WIDTH: usize = WIDTH;
    const HEIGHT: usize = HEIGHT;
    const CELL: [usize; 2] = [2, 1];
    const DARK: [u8; BYTES] = {
        assert!(BYTES * 2 == WIDTH * HEIGHT && WIDTH % 2 == 0);
        [0; BYTES]
    };

    #[inline(always)]
    fn cursor(x: usize, y: usize) -> usize {
        y * WIDTH + x
    }

    #[inline(always)]
    fn across(cursor: &mut usize, right: bool) {
        *cursor = if right { cursor.wrapping_add(1) } else { cursor.wrapping_sub(1) };
    }

    #[inline(always)]
    fn along(cursor: &mut usize, down: bool) {
        *cursor = if down { cursor.wrapping_add(WIDTH) } else { cursor.wrapping_sub(WIDTH) };
    }

    #[inline(always)]
    fn put(cells: &mut [u8], cursor: usize, ink: Gray4) {
        let Some(cell) = cells.get_mut(cursor >> 1) else { return };
        let luma = ink.luma();
        *cell = if cursor & 1 == 0 { *cell & 0x0f | luma << 4 } else { *cell & 0xf0 | luma };
    }

    #[inline(always)]
    fn blend(cells: &mut [u8], cursor: usize, ink: Gray4, cover: u32) {
        let was = Self::get(cells, cursor).luma();
        let luma = ((u32::from(ink.luma()) * cover + 8) >> 4) as u8;
        Self::put(cells, cursor, Gray4::new(was.max(luma)));
    }

    #[inline(always)]
    fn get(cells: &[u8], cursor: usize) -> Gray4 {
        let cell = cells.get(cursor >> 1).copied().unwrap_or(0);
        Gray4::new(if cursor & 1 == 0 { cell >> 4 } else { cell & 0x0f })
    }
}
