//! Rows from the top, two pixels of 16 greys a byte, the left one in the high half: SSD0323, SSD1322, SSD1327.

use super::frame::inside;
use super::{Cursor, Layout};
use embedded_graphics::pixelcolor::{Gray4, GrayColor};

/// The layout of a display of `WIDTH` x `HEIGHT`; `WORDS` is an eighth of their product.
///
/// Eight pixels are a word, the left one in its highest half byte: that clears four times as fast as bytes.
#[derive(Clone, Copy, Debug)]
pub struct Gray4Rows<const WIDTH: usize, const HEIGHT: usize, const WORDS: usize>;

/// A word of rows of `WIDTH` pixels, and the bits of the pixel in it.
#[derive(Clone, Copy, Debug)]
pub struct Nibble<const WIDTH: usize> {
    word: usize,
    mask: u32,
}

/// The left and the right pixel of a word.
const LEFT: u32 = 15 << 28;
const RIGHT: u32 = 15;

impl<const WIDTH: usize> Cursor for Nibble<WIDTH> {
    #[inline(always)]
    fn across(&mut self, right: bool) {
        if right {
            self.mask = self.mask.rotate_right(4);
            if self.mask == LEFT {
                self.word = self.word.wrapping_add(1);
            }
        } else {
            self.mask = self.mask.rotate_left(4);
            if self.mask == RIGHT {
                self.word = self.word.wrapping_sub(1);
            }
        }
    }

    #[inline(always)]
    fn along(&mut self, down: bool) {
        self.word = if down { self.word.wrapping_add(WIDTH / 8) } else { self.word.wrapping_sub(WIDTH / 8) };
    }
}

/// The same grey in all pixels of a word.
#[inline(always)]
fn everywhere(ink: Gray4) -> u32 {
    u32::from(ink.luma()) * 0x1111_1111
}

impl<const WIDTH: usize, const HEIGHT: usize, const WORDS: usize> Layout for Gray4Rows<WIDTH, HEIGHT, WORDS> {
    type Cell = u32;
    type Cells = [u32; WORDS];
    type Ink = Gray4;
    type Cursor = Nibble<WIDTH>;
    const WIDTH: usize = WIDTH;
    const HEIGHT: usize = HEIGHT;
    const CELL: [usize; 2] = [8, 1];
    const DARK: [u32; WORDS] = {
        assert!(WORDS * 8 == WIDTH * HEIGHT && WIDTH.is_multiple_of(8));
        [0; WORDS]
    };

    #[inline(always)]
    fn cursor(x: usize, y: usize) -> Nibble<WIDTH> {
        Nibble { word: (y * WIDTH + x) / 8, mask: LEFT >> (x % 8 * 4) }
    }

    #[inline(always)]
    fn put(cells: &mut [u32], cursor: Nibble<WIDTH>, ink: Gray4) {
        let Some(cell) = cells.get_mut(cursor.word) else { return };
        *cell ^= (*cell ^ everywhere(ink)) & cursor.mask;
    }

    /// Whole words, and parts of the first and the last one.
    #[inline(always)]
    fn span(cells: &mut [u32], y: usize, [from, to]: [usize; 2], ink: Gray4) {
        let (first, last) = ((y * WIDTH + from) / 8, (y * WIDTH + to) / 8);
        let (head, tail) = (u32::MAX >> (from % 8 * 4), u32::MAX << (28 - to % 8 * 4));
        let grey = everywhere(ink);
        match cells.get_mut(first..last.wrapping_add(1)).unwrap_or_default() {
            [] => {}
            [only] => *only ^= (*only ^ grey) & head & tail,
            [left, middle @ .., right] => {
                *left ^= (*left ^ grey) & head;
                middle.iter_mut().for_each(|cell| *cell = grey);
                *right ^= (*right ^ grey) & tail;
            }
        }
    }

    /// Parts of the first and the last word, and what lies between them.
    #[inline(always)]
    fn spans(cells: &mut [u32], first: usize, spans: &[[i16; 2]], ink: Gray4) {
        let grey = everywhere(ink);
        let rows = cells.get_mut(first * (WIDTH / 8)..).unwrap_or_default().chunks_exact_mut(WIDTH / 8);
        for (row, span) in rows.zip(spans) {
            let Some([low, high]) = inside(span, WIDTH) else { continue };
            let (head, tail) = (u32::MAX >> (low % 8 * 4), u32::MAX << (28 - high % 8 * 4));
            let (from, to) = (low / 8, high / 8);
            let Some(left) = row.get_mut(from) else { continue };
            if from == to {
                *left ^= (*left ^ grey) & head & tail;
                continue;
            }
            *left ^= (*left ^ grey) & head;
            if to - from > 1 {
                row.get_mut(from + 1..to).unwrap_or_default().iter_mut().for_each(|cell| *cell = grey);
            }
            if let Some(right) = row.get_mut(to) {
                *right ^= (*right ^ grey) & tail;
            }
        }
    }

    #[inline(always)]
    fn blend(cells: &mut [u32], cursor: Nibble<WIDTH>, ink: Gray4, cover: u32) {
        let was = Self::get(cells, cursor).luma();
        let luma = ((u32::from(ink.luma()) * cover + 8) >> 4) as u8;
        Self::put(cells, cursor, Gray4::new(was.max(luma)));
    }

    #[inline(always)]
    fn get(cells: &[u32], cursor: Nibble<WIDTH>) -> Gray4 {
        let cell = cells.get(cursor.word).copied().unwrap_or(0);
        Gray4::new(((cell & cursor.mask) >> cursor.mask.trailing_zeros()) as u8)
    }
}
