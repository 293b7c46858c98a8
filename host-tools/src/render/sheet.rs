//! Contact sheets: pictures of the display in rows, each with its frame number.

use super::canvas::Canvas;
use super::screen::{HEIGHT, Picture, WIDTH};
use anyhow::Result;
use embedded_graphics::Drawable;
use embedded_graphics::geometry::Point;
use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_6X10};
use embedded_graphics::pixelcolor::Gray8;
use embedded_graphics::text::{Baseline, Text};
use std::io::Write;

/// Pictures in a row.
const COLUMNS: usize = 3;
/// Display pixels are squares of this many pixels.
const SCALE: usize = 2;
/// Between pictures; the lower edge holds the frame number.
const GAP: usize = 6;
const LABEL: usize = 12;
/// Brightness of the sheet and of its labels.
const PAPER: u8 = 48;
const INK: u8 = 200;

/// Writes pictures with their frame numbers as a PNG.
pub fn write(out: impl Write, pictures: &[(u32, Picture)]) -> Result<()> {
    let mut sheet = empty(pictures.len());
    for (index, (frame, picture)) in pictures.iter().enumerate() {
        let left = GAP + index % COLUMNS * (WIDTH * SCALE + GAP);
        let top = GAP + index / COLUMNS * (HEIGHT * SCALE + GAP + LABEL);
        sheet.put(left, top, WIDTH * SCALE, &picture.enlarged(SCALE));
        let place = Point::new(left as i32, (top + HEIGHT * SCALE + 2) as i32);
        let style = MonoTextStyle::new(&FONT_6X10, Gray8::new(INK));
        let Ok(_) = Text::with_baseline(&format!("frame {frame}"), place, style, Baseline::Top).draw(&mut sheet);
    }
    sheet.write(out)
}

fn empty(pictures: usize) -> Canvas {
    let (columns, rows) = (pictures.clamp(1, COLUMNS), pictures.div_ceil(COLUMNS).max(1));
    Canvas::new(GAP + columns * (WIDTH * SCALE + GAP), GAP + rows * (HEIGHT * SCALE + GAP + LABEL), PAPER)
}
