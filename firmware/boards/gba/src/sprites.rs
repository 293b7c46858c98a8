//! Text by sprites: a letter is a sprite of 8x16 pixels, over the picture, at no cost for a frame.
#![allow(unsafe_code)]

use crate::registers::{lcd, set_colour, sprites};
use board_drivers::indexed::Indexed;
use core::convert::Infallible;
use core::ptr::{self, with_exposed_provenance_mut};
use embedded_graphics::Drawable;
use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Point, Size};
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle, ascii::FONT_6X10};
use embedded_graphics::pixelcolor::BinaryColor;
use embedded_graphics::text::{Baseline, Text as Letters};
use pantin_figure::ink::{BodyPart, Ink};

const FONT: &MonoFont = &FONT_6X10;
const LETTER: [u16; 2] = [6, 10];
/// The first letter that has tiles, and the number of those that do: ASCII.
const FIRST: u8 = b' ';
const LETTERS: u8 = 95;

/// Letters in a line.
const LINE: usize = 32;
/// Rows of the display.
const ROWS: u16 = 160;

/// The first attribute: a tall sprite at a row, or none.
const TALL: u16 = 2 << 14;
const HIDDEN: u16 = 1 << 9;
/// The mode's pages take the first half of the tiles.
const FIRST_TILE: u16 = 512;

/// Two lines of text, at the top and the bottom of the display.
#[derive(Debug)]
pub struct Text {
    shown: [[u8; LINE]; 2],
    next: [[u8; LINE]; 2],
}

impl Text {
    /// Draws the letters' tiles and hides all sprites.
    pub fn start() -> Self {
        set_colour(lcd::PALETTE + 512, 1, Indexed::of(BodyPart::Middle, 200).rgb());
        let style = MonoTextStyle::new(FONT, BinaryColor::On);
        for letter in 0..LETTERS {
            let mut tiles = Tiles([0; 16]);
            let mut bytes = [0; 4];
            let text = char::from(FIRST + letter).encode_utf8(&mut bytes);
            let _ = Letters::with_baseline(text, Point::zero(), style, Baseline::Top).draw(&mut tiles);
            for (row, pixels) in tiles.0.into_iter().enumerate() {
                write(sprites::TILES + 64 * usize::from(letter) + 4 * row, pixels);
            }
        }
        for index in 0..128 {
            attribute(index, 0, HIDDEN);
        }
        for index in 0..2 * LINE {
            attribute(index, 1, (index % LINE) as u16 * LETTER[0]);
        }
        Text { shown: [[FIRST; LINE]; 2], next: [[FIRST; LINE]; 2] }
    }

    /// Sets the lines. What is longer than a line is cut off.
    pub fn set(&mut self, lines: [&str; 2]) {
        for (next, line) in self.next.iter_mut().zip(lines) {
            next.fill(FIRST);
            next.iter_mut().zip(line.bytes()).for_each(|(to, letter)| *to = letter);
        }
    }

    /// Shows the lines that were set last, in a vertical blank.
    pub fn show(&mut self) {
        let places = self.shown.iter_mut().flatten().zip(self.next.iter().flatten());
        for (index, (shown, next)) in places.enumerate() {
            if shown != next {
                *shown = *next;
                let row = if index < LINE { 0 } else { ROWS - LETTER[1] };
                let letter = next.wrapping_sub(FIRST);
                let visible = letter > 0 && letter < LETTERS;
                attribute(index, 2, FIRST_TILE + 2 * u16::from(letter));
                attribute(index, 0, if visible { TALL | row } else { HIDDEN });
            }
        }
    }
}

/// Sets an attribute of a sprite.
fn attribute(sprite: usize, number: usize, value: u16) {
    // Safety: the attributes are memory of 128 sprites, 8 bytes each.
    unsafe { ptr::write_volatile(with_exposed_provenance_mut(sprites::ATTRIBUTES + 8 * sprite + 2 * number), value) };
}

fn write(address: usize, pixels: u32) {
    // Safety: the tiles are memory, of which the letters take less than all.
    unsafe { ptr::write_volatile(with_exposed_provenance_mut(address), pixels) };
}

/// Two tiles of 8x8 pixels, one above the other; a row is eight pixels of four bits, the left one lowest.
struct Tiles([u32; 16]);

impl OriginDimensions for Tiles {
    fn size(&self) -> Size {
        Size::new(8, 16)
    }
}

impl DrawTarget for Tiles {
    type Color = BinaryColor;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<BinaryColor>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(place, ink) in pixels {
            if let Some(row) = self.0.get_mut(place.y as usize)
                && ink.is_on()
                && (0..8).contains(&place.x)
            {
                *row |= 1 << (4 * place.x);
            }
        }
        Ok(())
    }
}
