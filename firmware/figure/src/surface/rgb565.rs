//! Rows from the top, 16 bits a pixel, red in the highest five: ST7789, ILI9341 (high byte first on the wire), OMAP's LCD.

use super::Layout;
use embedded_graphics::pixelcolor::raw::{RawData, RawU16};
use embedded_graphics::pixelcolor::{Rgb565, RgbColor};

/// The layout of a display of `WIDTH` x `HEIGHT`; `PIXELS` is their product.
#[derive(Clone, Copy, Debug)]
pub struct Rgb565Rows<const WIDTH: usize, const HEIGHT: usize, const PIXELS: usize>;

/// Red and blue of two pixel's colours, and green, apart: each has room above it.
const RED_BLUE: u32 = 0xf81f;
const GREEN: u32 = 0x07e0;

impl<const WIDTH: usize, const HEIGHT: usize, const PIXELS: usize> Layout for Rgb565Rows<WIDTH, HEIGHT, PIXELS> {
    type Cell = u16;
    type Cells = [u16; PIXELS];
    type Ink = Rgb565;
    /// The pixel's number, row by row.
    type Cursor = usize;
    const WIDTH: usize = WIDTH;
    const HEIGHT: usize = HEIGHT;
    const CELL: [usize; 2] = [1, 1];
    const DARK: [u16; PIXELS] = {
        assert!(PIXELS == WIDTH * HEIGHT);
        [0; PIXELS]
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
    fn put(cells: &mut [u16], cursor: usize, ink: Rgb565) {
        if let Some(cell) = cells.get_mut(cursor) {
            *cell = RawU16::from(ink).into_inner();
        }
    }

    #[inline(always)]
    fn blend(cells: &mut [u16], cursor: usize, ink: Rgb565, cover: u32) {
        let Some(cell) = cells.get_mut(cursor) else { return };
        let was = Rgb565::from(RawU16::new(*cell));
        let full = u32::from(RawU16::from(ink).into_inner());
        let scaled = ((full & RED_BLUE) * cover >> 4 & RED_BLUE) | ((full & GREEN) * cover >> 4 & GREEN);
        let scaled = Rgb565::from(RawU16::new(scaled as u16));
        let brighter = Rgb565::new(was.r().max(scaled.r()), was.g().max(scaled.g()), was.b().max(scaled.b()));
        *cell = RawU16::from(brighter).into_inner();
    }

    #[inline(always)]
    fn get(cells: &[u16], cursor: usize) -> Rgb565 {
        RawU16::new(cells.get(cursor).copied().unwrap_or(0)).into()
    }
}
