//! A frame as the page draws it: lines for its canvas, or the greys of a display.

use crate::actor::Actor;
use embedded_graphics::pixelcolor::{Gray4, GrayColor};
use pantin_figure::Canvas;
use pantin_figure::draw::stroke;
use pantin_figure::ink::{Ink, Tone};
use pantin_figure::lines::{Dot, Head, Line, pixel};
use pantin_figure::raster::disc;
use pantin_figure::surface::{Frame, Gray4Rows, Surface};

/// Columns and rows of the display.
pub const DISPLAY: Canvas = Canvas { width: 128, height: 64 };
const PIXELS: usize = 128 * 64;

/// Something to draw, as the page reads it: a line, a dot (both ends in one place), or a circle whose radius stands in place of `to`'s x; lengths in
/// sixteenths of a pixel.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Stroke {
    from: [i16; 2],
    to: [i16; 2],
    /// Brightness: 255 is nearest.
    shade: u8,
    /// What it is: 0 ground, 1 middle, 2 left, 3 right, [`HEAD`] or [`DOT`].
    what: u8,
    /// Pixels across.
    width: u8,
    padding: u8,
}

const HEAD: u8 = 4;
const DOT: u8 = 5;

impl From<Line> for Stroke {
    fn from(line: Line) -> Stroke {
        Stroke { from: line.from, to: line.to, shade: line.shade, what: line.tone as u8, width: line.width, padding: 0 }
    }
}

impl From<Head> for Stroke {
    fn from(head: Head) -> Stroke {
        Stroke { from: head.centre, to: [head.radius, 0], shade: head.shade, what: HEAD, width: 1, padding: 0 }
    }
}

impl From<Dot> for Stroke {
    fn from(dot: Dot) -> Stroke {
        Stroke { from: dot.place, to: dot.place, shade: dot.shade, what: DOT, width: 1, padding: 0 }
    }
}

/// Lines of a frame at most: a face takes 900 of them.
const STROKES: usize = 4096;

/// Both forms of the frame.
pub struct Picture {
    strokes: [Stroke; STROKES],
    count: usize,
    grey: [u8; PIXELS],
}

impl Picture {
    /// Gathers what the pose that was placed last is drawn with.
    pub fn gather(&mut self, actor: &mut Actor, pose: &[i32]) -> &[Stroke] {
        self.count = 0;
        actor.each(pose, &mut |stroke| {
            if let Some(place) = self.strokes.get_mut(self.count) {
                *place = stroke;
                self.count += 1;
            }
        });
        self.strokes.get(..self.count).unwrap_or(&[])
    }

    /// Draws that as the firmware does.
    pub fn draw(&mut self, actor: &mut Actor, pose: &[i32]) -> &[u8] {
        let mut frame = Frame::<Gray4Rows<128, 64, 1024>>::new();
        for stroke in self.gather(actor, pose) {
            stroke.draw(&mut frame);
        }
        for (index, grey) in self.grey.iter_mut().enumerate() {
            *grey = frame.pixel(index % 128, index / 128).luma() * 17;
        }
        &self.grey
    }
}

impl Stroke {
    fn draw<S: Surface<Ink = Gray4>>(&self, surface: &mut S) {
        let Stroke { from, to, shade, width, .. } = *self;
        let ink = Gray4::of(Tone::Middle, shade);
        if self.what == HEAD {
            disc(surface, from.map(pixel), pixel(to[0].saturating_add(8)).max(1), ink, Gray4::DARK);
        } else {
            // A display of greys tells no tones apart.
            stroke(&Line { from, to, depth: 0, shade, tone: Tone::Middle, width }, surface, false);
        }
    }
}
