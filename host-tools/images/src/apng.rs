//! Animated PNGs: all colours, and times that are no hundredths.

use crate::animation::{Animation, Beat};
use crate::image::{Area, Image};
use anyhow::Result;
use png::{BitDepth, BlendOp, ColorType, DisposeOp, Writer};
use std::io::Write;

/// Pictures that displays show in a second.
pub const MOST_A_SECOND: f64 = 60.0;
/// Times are multiples of 1 / 10000 s.
const TICKS: u16 = 10_000;

/// An animated PNG that is being written. Its size is the first picture's.
pub struct Apng<W: Write> {
    out: Option<W>,
    writer: Option<Writer<W>>,
    pictures: u32,
    shown: Option<Image>,
    beat: Beat,
}

impl<W: Write> Apng<W> {
    /// For a number of `pictures`, `seconds` apart.
    pub fn new(out: W, pictures: u32, seconds: f64) -> Apng<W> {
        Apng { out: Some(out), writer: None, pictures, shown: None, beat: Beat::new(seconds, f64::from(TICKS)) }
    }

    fn begin(&mut self, out: W, image: &Image, ticks: u32) -> Result<Writer<W>> {
        let mut encoder = png::Encoder::new(out, image.width() as u32, image.height() as u32);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_animated(self.pictures, 0)?;
        encoder.set_frame_delay(ticks as u16, TICKS)?;
        encoder.set_blend_op(BlendOp::Source)?;
        encoder.set_dispose_op(DisposeOp::None)?;
        Ok(encoder.write_header()?)
    }
}

impl<W: Write> Animation for Apng<W> {
    fn push(&mut self, image: &Image) -> Result<()> {
        let ticks = self.beat.ticks();
        if let Some(out) = self.out.take() {
            self.writer = Some(self.begin(out, image, ticks)?);
        }
        let (Some(writer), width) = (&mut self.writer, image.width()) else { return Ok(()) };
        let mut area = Area { left: 0, top: 0, width, height: image.height() };
        if let Some(shown) = &self.shown {
            area = Area::of_change(shown.pixels(), image.pixels(), width);
            // In this order no area reaches out of the picture on the way.
            writer.reset_frame_position()?;
            writer.set_frame_dimension(area.width as u32, area.height as u32)?;
            writer.set_frame_position(area.left as u32, area.top as u32)?;
            writer.set_frame_delay(ticks as u16, TICKS)?;
        }
        writer.write_image_data(area.cut(image.pixels(), width).as_flattened())?;
        self.shown = Some(image.clone());
        Ok(())
    }
}
