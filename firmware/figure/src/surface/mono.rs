//! Pages of eight rows, a byte a column with the top row in its lowest bit: SSD1306, SH1106, PCD8544.

use super::{BAND, Layout};
use embedded_graphics::pixelcolor::BinaryColor;

/// The layout of a display of `WIDTH` x `HEIGHT`; `BYTES` is an eighth of their product.
#[derive(Clone, Copy, Debug)]
pub struct MonoPages<const WIDTH: usize, const HEIGHT: usize, const BYTES: usize>;

/// A byte and the bit in it.
#[derive(Clone, Copy, Debug)]
pub struct Bit {
    byte: usize,
    mask: u32,
}

impl<const WIDTH: usize, const HEIGHT: usize, const BYTES: usize> Layout for MonoPages<WIDTH, HEIGHT, BYTES> {
    type Cell = u8;
    type Cells = [u8; BYTES];
    type Ink = BinaryColor;
    type Cursor = Bit;
    const WIDTH: usize = WIDTH;
    const HEIGHT: usize = HEIGHT;
    const CELL: [usize; 2] = [1, BAND];
    const DARK: [u8; BYTES] = {
        assert!(BYTES * 8 == WIDTH * HEIGHT && HEIGHT.is_multiple_of(BAND));
        [0; BYTES]
    };

    #[inline(always)]
    fn cursor(x: usize, y: usize) -> Bit {
        Bit { byte: y / BAND * WIDTH + x, mask: 1 << (y % BAND) }
    }

    #[inline(always)]
    fn across(cursor: &mut Bit, right: bool) {
        cursor.byte = if right { cursor.byte.wrapping_add(1) } else { cursor.byte.wrapping_sub(1) };
    }

    #[inline(always)]
    fn along(cursor: &mut Bit, down: bool) {
        if down {
            cursor.mask <<= 1;
            if cursor.mask == 1 << BAND {
                *cursor = Bit { byte: cursor.byte.wrapping_add(WIDTH), mask: 1 };
            }
        } else {
            cursor.mask >>= 1;
            if cursor.mask == 0 {
                *cursor = Bit { byte: cursor.byte.wrapping_sub(WIDTH), mask: 1 << (BAND - 1) };
            }
        }
    }

    #[inline(always)]
    fn put(cells: &mut [u8], cursor: Bit, ink: BinaryColor) {
        let Some(cell) = cells.get_mut(cursor.byte) else { return };
        *cell = if ink.is_on() { *cell | cursor.mask as u8 } else { *cell & !cursor.mask as u8 };
    }

    /// More than half of a pixel lights it.
    #[inline(always)]
    fn blend(cells: &mut [u8], cursor: Bit, ink: BinaryColor, cover: u32) {
        if cover >= 8 && ink.is_on() {
            Self::put(cells, cursor, ink);
        }
    }

    #[inline(always)]
    fn get(cells: &[u8], cursor: Bit) -> BinaryColor {
        BinaryColor::from(cells.get(cursor.byte).is_some_and(|cell| u32::from(*cell) & cursor.mask != 0))
    }
}
