//! Animated GIFs.

use crate::animation::{Animation, Beat};
use crate::image::{Area, Image};
use crate::palette::Rgb;
use anyhow::Result;
use gif::{DisposalMethod, Encoder, Frame, Repeat};
use std::borrow::Cow;
use std::collections::HashMap;
use std::io::Write;

/// GIF times are hundredths of a second, and viewers slow down what is shorter than two.
pub const MOST_A_SECOND: f64 = 50.0;
const TICKS: f64 = 100.0;

/// A GIF that is being written. Its size is the first picture's.
pub struct Gif<W: Write> {
    out: Option<W>,
    encoder: Option<Encoder<W>>,
    colours: Vec<Rgb>,
    indices: HashMap<Rgb, u8>,
    shown: Vec<u8>,
    beat: Beat,
}

impl<W: Write> Gif<W> {
    /// A GIF of pictures `seconds` apart. It has these at most 256 colours; others take the nearest one.
    pub fn new(out: W, colours: &[Rgb], seconds: f64) -> Gif<W> {
        let colours = colours[..colours.len().min(256)].to_vec();
        let beat = Beat::new(seconds, TICKS);
        Gif { out: Some(out), encoder: None, colours, indices: HashMap::new(), shown: Vec::new(), beat }
    }

    fn index(&mut self, colour: Rgb) -> u8 {
        let apart = |other: &Rgb| -> u32 { (0..3).map(|i| u32::from(colour[i].abs_diff(other[i])).pow(2)).sum() };
        let nearest = || (0..self.colours.len()).min_by_key(|&index| apart(&self.colours[index])).unwrap_or(0) as u8;
        *self.indices.entry(colour).or_insert_with(nearest)
    }

    fn indexed(&mut self, image: &Image) -> Vec<u8> {
        let mut last = (image.pixels()[0], self.index(image.pixels()[0]));
        let index = |&colour: &Rgb| {
            if colour != last.0 {
                last = (colour, self.index(colour));
            }
            last.1
        };
        image.pixels().iter().map(index).collect()
    }
}

impl<W: Write> Animation for Gif<W> {
    fn push(&mut self, image: &Image) -> Result<()> {
        let (width, height) = (image.width(), image.height());
        let pixels = self.indexed(image);
        if let Some(out) = self.out.take() {
            let mut encoder = Encoder::new(out, width as u16, height as u16, self.colours.as_flattened())?;
            encoder.set_repeat(Repeat::Infinite)?;
            self.encoder = Some(encoder);
        }
        let area = match self.shown.len() == pixels.len() {
            true => Area::of_change(&self.shown, &pixels, width),
            false => Area { left: 0, top: 0, width, height },
        };
        let frame = Frame {
            left: area.left as u16,
            top: area.top as u16,
            width: area.width as u16,
            height: area.height as u16,
            delay: self.beat.ticks() as u16,
            dispose: DisposalMethod::Keep,
            buffer: Cow::Owned(area.cut(&pixels, width)),
            ..Frame::default()
        };
        self.shown = pixels;
        self.encoder.as_mut().map_or(Ok(()), |encoder| Ok(encoder.write_frame(&frame)?))
    }
}
