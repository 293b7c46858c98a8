//! `faces.txt`: checksums of the pictures of faces, for the face in C: every frame of every emote, in every format.

use std::convert::Infallible;
use std::fmt::Write as _;

use anyhow::Result;
use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Size};
use embedded_graphics::pixelcolor::raw::{RawData, RawU16};
use embedded_graphics::pixelcolor::{BinaryColor, Gray8, GrayColor, PixelColor, Rgb565};
use pantin::{ChannelState, Clip, Player};
use pantin_face::talk::VISEMES;
use pantin_face::{
    Binding, CARTOON, EMOTES, FULL_WEIGHT, FaceRenderer, FaceView, MODEL, Model, Morph, SHAPES, SMALL, Target, Weight, Weights,
};
use pantin_figure::{Canvas, Ink};

/// The committed file's name.
pub const NAME: &str = "faces.txt";

/// Vertices of the largest model whose pictures are compared.
pub const VERTICES: usize = 1024;

/// A model, a size of picture in pixels, and from where the face is seen, in degrees.
pub type Shot = (&'static str, [u16; 2], [i16; 2]);

/// All details of models, both shapes of display, and odd sizes.
pub const SHOTS: [Shot; 8] = [
    ("cartoon", [64, 48], [0, 0]),
    ("cartoon", [128, 64], [0, 0]),
    ("cartoon", [240, 240], [0, 0]),
    ("cartoon", [171, 320], [-20, 10]),
    ("small", [84, 48], [0, 0]),
    ("face", [128, 64], [0, 0]),
    ("face", [125, 160], [40, -5]),
    ("face", [240, 240], [0, 0]),
];

/// A model by its name in [`SHOTS`].
pub fn model(name: &str) -> &'static [u8] {
    match name {
        "cartoon" => CARTOON,
        "small" => SMALL,
        _ => MODEL,
    }
}

/// A line for each shot and emote: the checksum of the checksums of its frames.
pub fn text() -> Result<String> {
    let mut text = String::new();
    for shot in SHOTS {
        let ([width, height], [orbit, tilt]) = (shot.1, shot.2);
        writeln!(text, "{} {width}x{height} {orbit} {tilt}", shot.0)?;
        for (name, clip) in EMOTES {
            let whole = frames(shot, clip)?.iter().fold(START, |hash, frame| fold(hash, &frame.to_le_bytes()));
            writeln!(text, "{name} {whole:08x}")?;
        }
    }
    Ok(text)
}

/// The checksum of every frame's picture, and of one in which the mouth shows an o and the last frame gives way by three quarters.
pub fn frames(shot: Shot, clip: &[u8]) -> Result<Vec<u32>> {
    let clip = Clip::new_checked(clip)?;
    let mut face = Face::new(model(shot.0), shot.1, shot.2)?;
    let binding = Binding::new(&clip.rig(), &face.model);
    let (mut states, mut pose) = (vec![ChannelState::default(); clip.moving()], vec![0; clip.rig().channels()]);
    let frames = clip.frames();
    let mut player = Player::new(clip, &mut states, &mut pose)?;
    let mut weights = Weights::new();
    let mut sums = Vec::new();
    for frame in 0..frames {
        player.seek(frame);
        binding.read_checked(player.pose(), &mut weights)?;
        sums.push(face.checksum(&weights));
    }
    weights.fade(&face.model, &VISEMES, (FULL_WEIGHT * 3 / 4) as u16);
    weights.add(&face.model, "viseme_o", Weight::from_bits(40_000))?;
    sums.push(face.checksum(&weights));
    Ok(sums)
}

/// Checksums of pictures with weights that no clip contains, one a line.
pub fn chaos(model: &[u8], size: [u16; 2], view: [i16; 2], pictures: u32) -> Result<String> {
    let mut face = Face::new(model, size, view)?;
    let (mut text, mut x) = (String::new(), 1u32);
    for picture in 0..pictures {
        let mut weights = Weights::new();
        for shape in 0..face.model.shape_count().min(SHAPES) {
            for side in 0..2 {
                x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                // Few shapes in one picture, all in the next.
                if picture % 2 == 0 && x >> 28 != 0 {
                    continue;
                }
                let weight = i32::from((x >> 12) as i16) >> (picture % 3);
                weights.add_to(Target::new(shape as u8, [side == 0, side == 1]), 2 * weight);
            }
        }
        writeln!(text, "{:08x}", face.checksum(&weights))?;
    }
    Ok(text)
}

/// What becomes of damaged models: "refused", or the checksum of a picture with weights that no clip contains; one a line.
pub fn mutants(model: &[u8], count: u32) -> Result<String> {
    let (mut text, mut x) = (String::new(), 1u32);
    let mut next = |below: usize| {
        x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        ((u64::from(x) * below as u64) >> 32) as usize
    };
    for _ in 0..count {
        let mut mutant = model.to_vec();
        for _ in 0..=next(3) {
            let at = next(mutant.len());
            mutant[at] ^= 1 << next(8);
        }
        match chaos(&mutant, [61, 40], [0, 0], 2) {
            Ok(sums) => text += &sums,
            Err(_) => text += "refused\n",
        }
    }
    Ok(text)
}

/// A model, its morph and its renderer.
struct Face<'a> {
    model: Model<'a>,
    morph: Box<Morph<VERTICES>>,
    renderer: Box<FaceRenderer<VERTICES>>,
    size: [u16; 2],
}

impl<'a> Face<'a> {
    fn new(model: &'a [u8], size: [u16; 2], [orbit, tilt]: [i16; 2]) -> Result<Self> {
        let model = Model::new_checked(model)?;
        let canvas = Canvas { width: size[0], height: size[1] };
        let morph = Box::new(Morph::new(&model)?);
        let renderer = Box::new(FaceRenderer::new(&model, canvas, FaceView { orbit, tilt }));
        Ok(Face { model, morph, renderer, size })
    }

    /// The checksum of a picture in all formats of the face in C, in their order.
    fn checksum(&mut self, weights: &Weights) -> u32 {
        debug_assert!(weights.pairs().flatten().all(|weight| weight.abs() <= FULL_WEIGHT));
        self.morph.apply(&self.model, weights);
        self.renderer.project(&self.model, &self.morph);
        sum_of(&self.picture(), &self.picture(), &self.picture())
    }

    fn picture<C: Ink>(&self) -> Picture<C> {
        let mut picture = Picture::new(self.size);
        let Ok(()) = self.renderer.draw(&self.model, &mut picture);
        picture
    }
}

/// The checksum of a picture in all formats of rows in C, in their order.
pub fn sum_of(bits: &Picture<BinaryColor>, greys: &Picture<Gray8>, colours: &Picture<Rgb565>) -> u32 {
    let width = bits.width;
    let mut hash = START;
    for row in bits.pixels.chunks(width) {
        let byte = |eight: &[BinaryColor]| eight.iter().enumerate().map(|(x, pixel)| u8::from(pixel.is_on()) << (7 - x)).sum();
        hash = fold(hash, &row.chunks(8).map(byte).collect::<Vec<u8>>());
    }
    for row in bits.pixels.chunks(width) {
        let byte = |eight: &[BinaryColor]| eight.iter().enumerate().map(|(x, pixel)| u8::from(pixel.is_on()) << x).sum();
        hash = fold(hash, &row.chunks(8).map(byte).collect::<Vec<u8>>());
    }
    hash = fold(hash, &greys.pixels.iter().map(|grey| grey.luma()).collect::<Vec<_>>());
    let colours: Vec<u16> = colours.pixels.iter().map(|&colour| RawU16::from(colour).into_inner()).collect();
    hash = fold(hash, &colours.iter().flat_map(|colour| colour.to_le_bytes()).collect::<Vec<_>>());
    fold(hash, &colours.iter().flat_map(|colour| colour.to_be_bytes()).collect::<Vec<_>>())
}

/// A picture of any size in the colours of a display.
pub struct Picture<C> {
    pixels: Vec<C>,
    width: usize,
}

impl<C: Ink> Picture<C> {
    /// A dark one.
    pub fn new([width, height]: [u16; 2]) -> Self {
        Picture { pixels: vec![C::DARK; usize::from(width) * usize::from(height)], width: width.into() }
    }
}

impl<C> OriginDimensions for Picture<C> {
    fn size(&self) -> Size {
        Size::new(self.width as u32, (self.pixels.len() / self.width) as u32)
    }
}

impl<C: PixelColor> DrawTarget for Picture<C> {
    type Color = C;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<C>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(place, colour) in pixels {
            self.pixels[place.y as usize * self.width + place.x as usize] = colour;
        }
        Ok(())
    }

    fn clear(&mut self, colour: C) -> Result<(), Infallible> {
        self.pixels.fill(colour);
        Ok(())
    }
}

/// FNV-1a.
const START: u32 = 0x811c_9dc5;

fn fold(hash: u32, bytes: &[u8]) -> u32 {
    bytes.iter().fold(hash, |hash, &byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}
