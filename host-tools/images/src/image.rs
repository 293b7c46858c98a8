//! A picture in colours: what figures, sheets and animations are made of, and its PNG.

use crate::palette::Rgb;
use anyhow::Result;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Point, Size};
use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_6X10};
use embedded_graphics::pixelcolor::{Rgb888, RgbColor};
use embedded_graphics::text::{Baseline, Text};
use embedded_graphics::{Drawable, Pixel};
use std::convert::Infallible;
use std::io::Write;

/// Width of a letter, and of a line of them.
pub const LETTER: [usize; 2] = [6, 10];

/// Pixels, row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    width: usize,
    pixels: Vec<Rgb>,
}

impl Image {
    /// A picture of one colour.
    pub fn new(width: usize, height: usize, colour: Rgb) -> Image {
        Image { width, pixels: vec![colour; width * height] }
    }

    /// A picture of rows of `width` pixels.
    pub fn of(width: usize, pixels: Vec<Rgb>) -> Image {
        assert!(pixels.len().is_multiple_of(width), "whole rows");
        Image { width, pixels }
    }

    /// Columns.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.pixels.len() / self.width
    }

    /// Its pixels, row by row.
    pub fn pixels(&self) -> &[Rgb] {
        &self.pixels
    }

    /// The same with each pixel a square of `scale`.
    pub fn enlarged(&self, scale: usize) -> Image {
        let rows = self.pixels.chunks(self.width).flat_map(|row| {
            let line: Vec<Rgb> = row.iter().flat_map(|&colour| std::iter::repeat_n(colour, scale)).collect();
            line.repeat(scale)
        });
        Image { pixels: rows.collect(), width: self.width * scale }
    }

    /// The same with the mean of each square of `side` pixels as one.
    pub fn reduced(&self, side: usize) -> Image {
        let (width, area) = (self.width / side, (side * side) as u32);
        let bands = self.pixels.chunks_exact(self.width * side);
        let pixels = bands.flat_map(|band| {
            (0..width).map(move |column| {
                let square = band.chunks_exact(self.width).flat_map(|row| &row[column * side..(column + 1) * side]);
                let sum = square.fold([0u32; 3], |sum, pixel| std::array::from_fn(|part| sum[part] + u32::from(pixel[part])));
                sum.map(|part| ((part + area / 2) / area) as u8)
            })
        });
        Image { pixels: pixels.collect(), width }
    }

    /// The upper left part of it.
    pub fn cropped(&self, width: usize, height: usize) -> Image {
        let width = width.min(self.width);
        let rows = self.pixels.chunks(self.width).take(height);
        Image { pixels: rows.flat_map(|row| &row[..width]).copied().collect(), width }
    }

    /// Paints what lies outside the largest circle in the middle.
    pub fn keep_circle(&mut self, colour: Rgb) {
        let [width, height] = [self.width, self.height()];
        let side = width.min(height);
        for (index, pixel) in self.pixels.iter_mut().enumerate() {
            // Twice the distances of the pixel's middle from that of the picture.
            let [x, y] = [(2 * (index % width) + 1).abs_diff(width), (2 * (index / width) + 1).abs_diff(height)];
            if x * x + y * y > side * side {
                *pixel = colour;
            }
        }
    }

    /// Copies a picture to a place where it is inside.
    pub fn put(&mut self, left: usize, top: usize, picture: &Image) {
        for (row, line) in picture.pixels.chunks(picture.width).enumerate() {
            let start = (top + row) * self.width + left;
            self.pixels[start..start + line.len()].copy_from_slice(line);
        }
    }

    /// Writes a line of letters, as many as there is room for.
    pub fn write_text(&mut self, left: usize, top: usize, text: &str, [r, g, b]: Rgb) {
        let style = MonoTextStyle::new(&FONT_6X10, Rgb888::new(r, g, b));
        let Ok(_) = Text::with_baseline(text, Point::new(left as i32, top as i32), style, Baseline::Top).draw(self);
    }

    /// Writes the picture as a PNG.
    pub fn write_png(&self, out: impl Write) -> Result<()> {
        let mut encoder = png::Encoder::new(out, self.width as u32, self.height() as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.write_header()?.write_image_data(self.pixels.as_flattened())?;
        Ok(())
    }
}

impl OriginDimensions for Image {
    fn size(&self) -> Size {
        Size::new(self.width as u32, self.height() as u32)
    }
}

impl DrawTarget for Image {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb888>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(place, colour) in pixels {
            let inside = (0..self.width as i32).contains(&place.x) && (0..self.height() as i32).contains(&place.y);
            if inside {
                self.pixels[place.y as usize * self.width + place.x as usize] = [colour.r(), colour.g(), colour.b()];
            }
        }
        Ok(())
    }
}

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Area {
    /// First column.
    pub left: usize,
    /// First row.
    pub top: usize,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

impl Area {
    /// The least area outside of which two pictures of rows of `width` pixels are equal; a pixel if they are equal all over.
    pub fn of_change<T: PartialEq>(before: &[T], after: &[T], width: usize) -> Area {
        let (mut left, mut right, mut top, mut bottom) = (width, 0, usize::MAX, 0);
        for (row, (before, after)) in before.chunks(width).zip(after.chunks(width)).enumerate() {
            let differs = |column: &usize| before[*column] != after[*column];
            let Some(first) = (0..width).find(differs) else { continue };
            left = left.min(first);
            right = right.max((0..width).rfind(differs).unwrap_or(first));
            top = top.min(row);
            bottom = row;
        }
        match top {
            usize::MAX => Area { left: 0, top: 0, width: 1, height: 1 },
            _ => Area { left, top, width: right + 1 - left, height: bottom + 1 - top },
        }
    }

    /// The area's part of a picture of rows of `width` pixels.
    pub fn cut<T: Copy>(&self, pixels: &[T], width: usize) -> Vec<T> {
        let rows = pixels.chunks(width).skip(self.top).take(self.height);
        rows.flat_map(|row| &row[self.left..self.left + self.width]).copied().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_area_holds_every_change_and_no_more() {
        let before = vec![0; 5 * 4];
        let mut after = before.clone();
        assert_eq!(Area::of_change(&before, &after, 5), Area { left: 0, top: 0, width: 1, height: 1 });
        after[5 + 3] = 1;
        after[2 * 5 + 1] = 2;
        let area = Area::of_change(&before, &after, 5);
        assert_eq!(area, Area { left: 1, top: 1, width: 3, height: 2 });
        assert_eq!(area.cut(&after, 5), [0, 0, 1, 2, 0, 0]);
    }

    #[test]
    fn a_circle_keeps_the_middle_of_each_side_and_no_corner() {
        let mut image = Image::new(12, 8, [9; 3]);
        image.keep_circle([1; 3]);
        let row =
            |y: usize| image.pixels()[12 * y..12 * y + 12].iter().map(|pixel| usize::from(pixel[0] == 9)).collect::<Vec<_>>();
        assert_eq!(row(0), [0, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0]);
        assert_eq!(row(3), [0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0]);
        assert_eq!(row(0), row(7));
    }

    #[test]
    fn letters_that_have_no_room_are_left_out() {
        let mut image = Image::new(8, 8, [0; 3]);
        image.write_text(4, 0, "frame 7", [9, 8, 7]);
        assert!(image.pixels().contains(&[9, 8, 7]));
    }
}
