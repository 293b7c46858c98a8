//! The display of 128x64 pixels and 16 greys: the same pixels as the firmware's rasterizer, with less code and in more time.

use pantin_figure::Canvas;
use pantin_figure::lines::pixel;
use pantin_web_module::{HEAD, Stroke};

/// Columns and rows of the display.
pub const DISPLAY: Canvas = Canvas { width: 128, height: 64 };
pub const PIXELS: usize = 128 * 64;

/// A grey is one byte: 17 times a level from 0 to 15.
type Greys = [u8; PIXELS];

fn put(greys: &mut Greys, [x, y]: [i32; 2], grey: u8) {
    if let (0..128, Some(place)) = (x, greys.get_mut((y * 128 + x) as usize)) {
        *place = grey;
    }
}

/// Draws a stroke.
pub fn draw(stroke: &Stroke, greys: &mut Greys) {
    let grey = (stroke.shade >> 4) * 17;
    let from = stroke.from.map(pixel);
    if stroke.what == HEAD {
        disc(greys, from, pixel(stroke.to[0].saturating_add(8)).max(1), grey);
    } else {
        thick(greys, from, stroke.to.map(pixel), stroke.width.into(), grey);
    }
}

/// Bresenham's lines side by side, across the longer way: step i of one lies i pixels along and floor((2 short i + long) / (2 long)) across,
/// from the end where the coordinate along is smallest.
fn thick(greys: &mut Greys, from: [i32; 2], to: [i32; 2], width: i32, grey: u8) {
    let steep = (to[1] - from[1]).abs() > (to[0] - from[0]).abs();
    let turned = |[x, y]: [i32; 2]| if steep { [y, x] } else { [x, y] };
    let (mut from, mut to) = (turned(from), turned(to));
    if from[0] > to[0] {
        (from, to) = (to, from);
    }
    let (long, across) = (to[0] - from[0], to[1] - from[1]);
    for step in 0..=long {
        let aside = ((2 * across.abs() * step + long) / (2 * long).max(1)) * across.signum() - width / 2;
        for aside in aside..aside + width {
            put(greys, turned([from[0] + step, from[1] + aside]), grey);
        }
    }
}

/// A dark disc with an edge: x^2 + y^2 is at most r^2 + r there, and not with either of them a pixel farther out.
fn disc(greys: &mut Greys, [x, y]: [i32; 2], radius: i32, grey: u8) {
    let radius = radius.min(128);
    let within = |x: i32, y: i32| x * x + y * y <= radius * radius + radius;
    for down in -radius..=radius {
        for right in -radius..=radius {
            if within(right, down) {
                let inside = within(right.abs() + 1, down) && within(right, down.abs() + 1);
                put(greys, [x + right, y + down], if inside { 0 } else { grey });
            }
        }
    }
}
