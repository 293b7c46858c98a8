//! Pages of eight rows, a byte a column with the top row in its lowest bit: SSD1306, SH1106, PCD8544.

use super::frame::inside;
use super::{BAND, Cursor, Layout};
use embedded_graphics::pixelcolor::BinaryColor;

/// The layout of a display of `WIDTH` x `HEIGHT`; `BYTES` is an eighth of their product.
#[derive(Clone, Copy, Debug)]
pub struct MonoPages<const WIDTH: usize, const HEIGHT: usize, const BYTES: usize>;

/// A byte and the bit in it, in pages of `WIDTH` bytes.
#[derive(Clone, Copy, Debug)]
pub struct Bit<const WIDTH: usize> {
    byte: usize,
    mask: u32,
}

impl<const WIDTH: usize> Cursor for Bit<WIDTH> {
    #[inline(always)]
    fn across(&mut self, right: bool) {
        self.byte = if right { self.byte.wrapping_add(1) } else { self.byte.wrapping_sub(1) };
    }

    #[inline(always)]
    fn along(&mut self, down: bool) {
        if down {
            self.mask <<= 1;
            if self.mask == 1 << BAND {
                *self = Bit { byte: self.byte.wrapping_add(WIDTH), mask: 1 };
            }
        } else {
            self.mask >>= 1;
            if self.mask == 0 {
                *self = Bit { byte: self.byte.wrapping_sub(WIDTH), mask: 1 << (BAND - 1) };
            }
        }
    }
}

/// Sets or clears a bit of consecutive bytes.
#[inline(always)]
fn line(cells: &mut [u8], mask: u8, on: bool) {
    let (blocks, rest) = cells.as_chunks_mut::<4>();
    if on {
        for [a, b, c, d] in blocks {
            (*a, *b, *c, *d) = (*a | mask, *b | mask, *c | mask, *d | mask);
        }
        rest.iter_mut().for_each(|cell| *cell |= mask);
    } else {
        for [a, b, c, d] in blocks {
            (*a, *b, *c, *d) = (*a & !mask, *b & !mask, *c & !mask, *d & !mask);
        }
        rest.iter_mut().for_each(|cell| *cell &= !mask);
    }
}

impl<const WIDTH: usize, const HEIGHT: usize, const BYTES: usize> Layout for MonoPages<WIDTH, HEIGHT, BYTES> {
    type Cell = u8;
    type Cells = [u8; BYTES];
    type Ink = BinaryColor;
    type Cursor = Bit<WIDTH>;
    const WIDTH: usize = WIDTH;
    const HEIGHT: usize = HEIGHT;
    const CELL: [usize; 2] = [1, BAND];
    const DARK: [u8; BYTES] = {
        assert!(BYTES * 8 == WIDTH * HEIGHT && HEIGHT.is_multiple_of(BAND));
        [0; BYTES]
    };

    #[inline(always)]
    fn cursor(x: usize, y: usize) -> Bit<WIDTH> {
        Bit { byte: y / BAND * WIDTH + x, mask: 1 << (y % BAND) }
    }

    #[inline(always)]
    fn put(cells: &mut [u8], cursor: Bit<WIDTH>, ink: BinaryColor) {
        let Some(cell) = cells.get_mut(cursor.byte) else { return };
        *cell = if ink.is_on() { *cell | cursor.mask as u8 } else { *cell & !cursor.mask as u8 };
    }

    /// Writes one bit of consecutive bytes.
    #[inline(always)]
    fn span(cells: &mut [u8], y: usize, [from, to]: [usize; 2], ink: BinaryColor) {
        let (row, mask) = (y / BAND * WIDTH, 1u8 << (y % BAND));
        let cells = cells.get_mut(row + from..(row + to).wrapping_add(1)).unwrap_or_default();
        if ink.is_on() {
            cells.iter_mut().for_each(|cell| *cell |= mask);
        } else {
            cells.iter_mut().for_each(|cell| *cell &= !mask);
        }
    }

    /// Writes one bit of consecutive bytes in each row, four bytes at a time.
    #[inline(always)]
    fn spans(cells: &mut [u8], first: usize, mut spans: &[[i16; 2]], ink: BinaryColor) {
        let on = ink.is_on();
        let mut mask = 1u32 << (first % BAND);
        for page in cells.as_chunks_mut::<WIDTH>().0.iter_mut().skip(first / BAND) {
            if spans.is_empty() {
                return;
            }
            while let Some((span, rest)) = spans.split_first() {
                if mask == 1 << BAND {
                    break;
                }
                if let Some([low, high]) = inside(span, WIDTH) {
                    line(page.get_mut(low..=high).unwrap_or_default(), mask as u8, on);
                }
                mask <<= 1;
                spans = rest;
            }
            mask = 1;
        }
    }

    /// Writes one bit of every second byte.
    #[inline(always)]
    fn alternate(cells: &mut [u8], y: usize, [from, to]: [usize; 2], ink: BinaryColor) {
        let (row, mask) = (y / BAND * WIDTH, 1u8 << (y % BAND));
        let (set, kept) = (if ink.is_on() { mask } else { 0 }, !mask);
        let cells = cells.get_mut(row + from..(row + to).wrapping_add(1)).unwrap_or_default();
        cells.chunks_mut(2).filter_map(|pair| pair.first_mut()).for_each(|cell| *cell = *cell & kept | set);
    }

    /// More than half of a pixel lights it.
    #[inline(always)]
    fn blend(cells: &mut [u8], cursor: Bit<WIDTH>, ink: BinaryColor, cover: u32) {
        if cover >= 8 && ink.is_on() {
            Self::put(cells, cursor, ink);
        }
    }

    #[inline(always)]
    fn get(cells: &[u8], cursor: Bit<WIDTH>) -> BinaryColor {
        BinaryColor::from(cells.get(cursor.byte).is_some_and(|cell| u32::from(*cell) & cursor.mask != 0))
    }
}
