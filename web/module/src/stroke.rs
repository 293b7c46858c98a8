//! What the page draws, in the layout that it reads.

use pantin_figure::lines::{Dot, Head, Line};

/// A line, a dot (both ends are equal), or a circle (its radius is stored as the x of `to`), in the layout that the page reads; lengths are in
/// sixteenths of a pixel.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Stroke {
    /// One end: x, y.
    pub from: [i16; 2],
    /// The other end.
    pub to: [i16; 2],
    /// Brightness: 255 is nearest.
    pub shade: u8,
    /// Body part: 0 ground, 1 middle, 2 left, 3 right, [`HEAD`] or [`DOT`].
    pub what: u8,
    /// Width in pixels.
    pub width: u8,
    padding: u8,
}

/// A circle that hides what is behind it.
pub const HEAD: u8 = 4;
const DOT: u8 = 5;

impl Stroke {
    /// No stroke: all zeros.
    pub const NONE: Stroke = Stroke { from: [0; 2], to: [0; 2], shade: 0, what: 0, width: 0, padding: 0 };
}

impl From<Line> for Stroke {
    fn from(line: Line) -> Stroke {
        Stroke { from: line.from, to: line.to, shade: line.shade, what: line.body_part as u8, width: line.width, padding: 0 }
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
