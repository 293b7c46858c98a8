//! Rows from the top, 16 bits a pixel, red in the highest five: ST7789, ILI9341 (high byte first on the wire), OMAP's LCD.

use super::frame::{CALL, fill, inside};
use super::{Cell, InRows, Layout};
use core::hint::black_box;
use embedded_graphics::pixelcolor::raw::{RawData, RawU16};
use embedded_graphics::pixelcolor::{Rgb565, RgbColor};

/// The layout of a display of `WIDTH` x `HEIGHT`; `PAIRS` is half their product.
#[derive(Clone, Copy, Debug)]
pub struct Rgb565Rows<const WIDTH: usize, const HEIGHT: usize, const PAIRS: usize>;

/// Two pixels in a word: a picture is cleared and copied by words, and drawn by halves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C, align(4))]
pub struct Pair(pub [u16; 2]);

impl Cell for Pair {
    type Wire = [u8; 4];
    const DARK: Pair = Pair([0; 2]);

    fn wire(self) -> [u8; 4] {
        let [[a, b], [c, d]] = self.0.map(u16::to_be_bytes);
        [a, b, c, d]
    }
}

/// Red and blue of a colour, and green, apart: each has room above it.
const RED_BLUE: u32 = 0xf81f;
const GREEN: u32 = 0x07e0;

/// Draws pixels of a row: whole pairs, four at a time, and halves of the first and the last one.
#[inline(always)]
fn line(row: &mut [Pair], [low, high]: [usize; 2], both: Pair) {
    let Pair([colour, _]) = both;
    if low % 2 == 1
        && let Some(Pair([_, right])) = row.get_mut(low / 2)
    {
        *right = colour;
    }
    if high.is_multiple_of(2)
        && let Some(Pair([left, _])) = row.get_mut(high / 2)
    {
        *left = colour;
    }
    let whole = row.get_mut(low.div_ceil(2)..high.div_ceil(2)).unwrap_or_default();
    let (blocks, single) = whole.as_chunks_mut::<4>();
    for [a, b, c, d] in blocks {
        (*a, *b, *c, *d) = (both, both, both, both);
    }
    single.iter_mut().for_each(|pair| *pair = both);
}

impl<const WIDTH: usize, const HEIGHT: usize, const PAIRS: usize> Layout for Rgb565Rows<WIDTH, HEIGHT, PAIRS> {
    type Cell = Pair;
    type Cells = [Pair; PAIRS];
    type Ink = Rgb565;
    type Cursor = InRows<WIDTH>;
    const WIDTH: usize = WIDTH;
    const HEIGHT: usize = HEIGHT;
    const CELL: [usize; 2] = [2, 1];
    const DARK: [Pair; PAIRS] = {
        assert!(PAIRS * 2 == WIDTH * HEIGHT && WIDTH.is_multiple_of(2));
        [Pair([0; 2]); PAIRS]
    };

    #[inline(always)]
    fn cursor(x: usize, y: usize) -> InRows<WIDTH> {
        InRows::at(x, y)
    }

    #[inline(always)]
    fn put(cells: &mut [Pair], cursor: InRows<WIDTH>, ink: Rgb565) {
        if let Some(Pair(pixels)) = cells.get_mut(cursor.0 >> 1) {
            pixels[cursor.0 & 1] = RawU16::from(ink).into_inner();
        }
    }

    /// Whole pairs, and halves of the first and the last one.
    #[inline(always)]
    fn span(cells: &mut [Pair], y: usize, [from, to]: [usize; 2], ink: Rgb565) {
        let colour = RawU16::from(ink).into_inner();
        let (first, last) = (y * WIDTH + from, y * WIDTH + to);
        if first % 2 == 1
            && let Some(Pair([_, right])) = cells.get_mut(first / 2)
        {
            *right = colour;
        }
        if last.is_multiple_of(2)
            && let Some(Pair([left, _])) = cells.get_mut(last / 2)
        {
            *left = colour;
        }
        let whole = cells.get_mut(first.div_ceil(2)..last.div_ceil(2)).unwrap_or_default();
        if whole.len() < CALL {
            // As a word: the compiler would write the same half twice.
            let both = black_box(Pair([colour; 2]));
            whole.iter_mut().for_each(|pair| *pair = both);
        } else {
            fill(whole, Pair([colour; 2]));
        }
    }

    #[inline(always)]
    fn spans(cells: &mut [Pair], first: usize, spans: &[[i16; 2]], ink: Rgb565) {
        let colour = RawU16::from(ink).into_inner();
        let both = black_box(Pair([colour; 2]));
        let rows = cells.get_mut(first * (WIDTH / 2)..).unwrap_or_default().chunks_exact_mut(WIDTH / 2);
        for (row, span) in rows.zip(spans) {
            if let Some(columns) = inside(span, WIDTH) {
                line(row, columns, both);
            }
        }
    }

    #[inline(always)]
    fn blend(cells: &mut [Pair], cursor: InRows<WIDTH>, ink: Rgb565, cover: u32) {
        let was = Self::get(cells, cursor);
        let full = u32::from(RawU16::from(ink).into_inner());
        let scaled = ((((full & RED_BLUE) * cover) >> 4) & RED_BLUE) | ((((full & GREEN) * cover) >> 4) & GREEN);
        let scaled = Rgb565::from(RawU16::new(scaled as u16));
        let brighter = Rgb565::new(was.r().max(scaled.r()), was.g().max(scaled.g()), was.b().max(scaled.b()));
        Self::put(cells, cursor, brighter);
    }

    #[inline(always)]
    fn get(cells: &[Pair], cursor: InRows<WIDTH>) -> Rgb565 {
        RawU16::new(cells.get(cursor.0 >> 1).map_or(0, |pair| pair.0[cursor.0 & 1])).into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Small = Rgb565Rows<48, 2, 48>;

    #[test]
    fn a_span_is_its_pixels() {
        let ink = Rgb565::new(3, 40, 29);
        for (from, to) in (0..48).flat_map(|from| (from..48).map(move |to| (from, to))) {
            let (mut spans, mut pixels) = (Small::DARK, Small::DARK);
            Small::span(&mut spans, 1, [from, to], ink);
            (from..=to).for_each(|x| Small::put(&mut pixels, Small::cursor(x, 1), ink));
            assert_eq!(spans, pixels, "{from} {to}");
        }
    }
}
