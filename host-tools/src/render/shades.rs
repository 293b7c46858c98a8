//! A display of any size and 256 steps of brightness, drawn on by the firmware's own code.

use super::image::Image;
use super::palette::Palette;
use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Size};
use embedded_graphics::pixelcolor::{Gray8, GrayColor};
use std::convert::Infallible;

/// Brightness of each pixel, row by row.
#[derive(Clone, Debug)]
pub struct Shades {
    width: usize,
    shades: Vec<u8>,
}

impl Shades {
    /// A dark display.
    pub fn new(width: usize, height: usize) -> Shades {
        Shades { width, shades: vec![0; width * height] }
    }

    /// Columns.
    pub fn width(&self) -> usize {
        self.width
    }

    /// The brightness of a pixel; of one outside, none.
    pub fn at(&self, x: usize, y: usize) -> u8 {
        if x < self.width { self.shades.get(y * self.width + x).copied().unwrap_or(0) } else { 0 }
    }

    /// Turns off what is darker than `least`.
    pub fn darken_below(&mut self, least: u8) {
        self.shades.iter_mut().filter(|shade| **shade < least).for_each(|shade| *shade = 0);
    }

    /// What it looks like.
    pub fn image(&self, palette: &Palette) -> Image {
        Image::of(self.width, self.shades.iter().map(|&shade| palette.pixel(shade)).collect())
    }
}

impl OriginDimensions for Shades {
    fn size(&self) -> Size {
        Size::new(self.width as u32, (self.shades.len() / self.width) as u32)
    }
}

impl DrawTarget for Shades {
    type Color = Gray8;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Gray8>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        let size = self.size();
        for Pixel(place, grey) in pixels {
            let inside = (0..size.width as i32).contains(&place.x) && (0..size.height as i32).contains(&place.y);
            if inside {
                self.shades[place.y as usize * self.width + place.x as usize] = grey.luma();
            }
        }
        Ok(())
    }

    fn clear(&mut self, grey: Gray8) -> Result<(), Infallible> {
        self.shades.fill(grey.luma());
        Ok(())
    }
}
