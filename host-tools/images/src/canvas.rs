//! A grey picture that texts and lines are drawn on, and its PNG.

use anyhow::Result;
use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Size};
use embedded_graphics::pixelcolor::{Gray8, GrayColor};
use std::convert::Infallible;
use std::io::Write;

/// Pixels of 256 greys.
pub struct Canvas {
    width: usize,
    pixels: Vec<u8>,
}

impl Canvas {
    /// An empty picture of one grey.
    pub fn new(width: usize, height: usize, paper: u8) -> Canvas {
        Canvas { width, pixels: vec![paper; width * height] }
    }

    /// Rows of its pixels.
    pub fn pixels(&self) -> &[u8] {
        &self.pixels
    }

    fn height(&self) -> usize {
        self.pixels.len() / self.width
    }

    /// Copies a picture of rows of `width` pixels to a place where it is inside.
    pub fn put(&mut self, left: usize, top: usize, width: usize, picture: &[u8]) {
        for (row, line) in picture.chunks(width).enumerate() {
            let start = (top + row) * self.width + left;
            self.pixels[start..start + line.len()].copy_from_slice(line);
        }
    }

    /// Writes the picture as a PNG.
    pub fn write(&self, out: impl Write) -> Result<()> {
        let mut encoder = png::Encoder::new(out, self.width as u32, self.height() as u32);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.write_header()?.write_image_data(&self.pixels)?;
        Ok(())
    }
}

impl OriginDimensions for Canvas {
    fn size(&self) -> Size {
        Size::new(self.width as u32, self.height() as u32)
    }
}

impl DrawTarget for Canvas {
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
