//! Contact sheets: pictures of the display in rows, each with its frame number.

use super::screen::{HEIGHT, Picture, WIDTH};
use anyhow::Result;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Point, Size};
use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_6X10};
use embedded_graphics::pixelcolor::{Gray8, GrayColor};
use embedded_graphics::text::{Baseline, Text};
use embedded_graphics::{Drawable, Pixel};
use std::convert::Infallible;
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
    let mut sheet = Sheet::for_pictures(pictures.len());
    for (index, (frame, picture)) in pictures.iter().enumerate() {
        let left = GAP + index % COLUMNS * (WIDTH * SCALE + GAP);
        let top = GAP + index / COLUMNS * (HEIGHT * SCALE + GAP + LABEL);
        sheet.put(left, top, &picture.enlarged(SCALE));
        let place = Point::new(left as i32, (top + HEIGHT * SCALE + 2) as i32);
        let style = MonoTextStyle::new(&FONT_6X10, Gray8::new(INK));
        let Ok(_) = Text::with_baseline(&format!("frame {frame}"), place, style, Baseline::Top).draw(&mut sheet);
    }
    let mut encoder = png::Encoder::new(out, sheet.width as u32, sheet.height() as u32);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header()?.write_image_data(&sheet.pixels)?;
    Ok(())
}

struct Sheet {
    width: usize,
    pixels: Vec<u8>,
}

impl Sheet {
    fn for_pictures(count: usize) -> Sheet {
        let (columns, rows) = (count.clamp(1, COLUMNS), count.div_ceil(COLUMNS).max(1));
        let width = GAP + columns * (WIDTH * SCALE + GAP);
        let height = GAP + rows * (HEIGHT * SCALE + GAP + LABEL);
        Sheet { width, pixels: vec![PAPER; width * height] }
    }

    fn height(&self) -> usize {
        self.pixels.len() / self.width
    }

    fn put(&mut self, left: usize, top: usize, picture: &[u8]) {
        for (row, line) in picture.chunks(WIDTH * SCALE).enumerate() {
            let start = (top + row) * self.width + left;
            self.pixels[start..start + line.len()].copy_from_slice(line);
        }
    }
}

impl OriginDimensions for Sheet {
    fn size(&self) -> Size {
        Size::new(self.width as u32, self.height() as u32)
    }
}

impl DrawTarget for Sheet {
    type Color = Gray8;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Gray8>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(place, grey) in pixels {
            let inside = (0..self.width as i32).contains(&place.x) && (0..self.height() as i32).contains(&place.y);
            if inside {
                self.pixels[place.y as usize * self.width + place.x as usize] = grey.luma();
            }
        }
        Ok(())
    }
}
