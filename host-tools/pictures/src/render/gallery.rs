//! One sheet of many clips: a labelled cell each, two pictures of a figure or a chart of the channels that move most.

use super::screen::{HEIGHT, WIDTH, pictures};
use anyhow::Result;
use embedded_graphics::Drawable;
use embedded_graphics::geometry::Point;
use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_6X10};
use embedded_graphics::pixelcolor::Gray8;
use embedded_graphics::primitives::{Polyline, Primitive, PrimitiveStyle};
use embedded_graphics::text::{Baseline, Text};
use pantin::Clip;
use pantin_convert::expand::expand;
use pantin_convert::motion::Motion;
use pantin_figure::View;
use pantin_images::canvas::Canvas;
use std::io::Write;

/// Cells in a row.
const COLUMNS: usize = 3;
/// Display pixels are squares of this many pixels.
const SCALE: usize = 2;
/// Where in a clip its two pictures are, as parts of it.
const TIMES: [f64; 2] = [0.3, 0.7];
const PICTURE: [usize; 2] = [WIDTH * SCALE, HEIGHT * SCALE];
const INSIDE: usize = PICTURE[0] * TIMES.len() + 2;
const GAP: usize = 6;
const LABEL: usize = 12;
/// Joints one below the other that make a limb; what has no limb is no figure, and shown as a chart.
const LIMB: usize = 3;
/// Strips of a chart, and the letters of their names.
const STRIPS: usize = 8;
const LETTERS: usize = 20;
const NAMES: usize = LETTERS * 6 + 6;

const SHEET: u8 = 48;
const PAPER: u8 = 0;
const INK: u8 = 220;

/// A clip's part of the sheet.
pub struct Cell {
    /// What is written below it.
    pub label: String,
    /// Rows of its pixels.
    pixels: Vec<u8>,
}

impl Cell {
    /// Draws `clip`.
    pub fn of(clip: &Clip, label: String) -> Result<Cell> {
        let rig = clip.rig();
        let mut depths: Vec<usize> = Vec::new();
        for joint in rig.joints() {
            let above = joint.parent.and_then(|parent| depths.get(usize::from(parent))).copied().unwrap_or(0);
            depths.push(above + 1);
        }
        // The root is where a figure stands, and no part of a limb.
        let pixels = if depths.iter().any(|&depth| depth > LIMB) { figure(clip)? } else { chart(&expand(clip)?) };
        Ok(Cell { label, pixels })
    }

    /// A cell that says why there is no picture.
    pub fn without(label: String) -> Cell {
        Cell { label, pixels: vec![PAPER; INSIDE * PICTURE[1]] }
    }
}

fn figure(clip: &Clip) -> Result<Vec<u8>> {
    let view = View::default();
    let frames = TIMES.map(|part| (f64::from(clip.frames() - 1) * part) as u32);
    let shown: Vec<Vec<u8>> = pictures(clip, view, frames)?.iter().map(|picture| picture.enlarged(SCALE)).collect();
    let row = |row: usize| {
        let lines: Vec<&[u8]> = shown.iter().map(|picture| &picture[row * PICTURE[0]..(row + 1) * PICTURE[0]]).collect();
        lines.join(&[SHEET, SHEET][..])
    };
    Ok((0..PICTURE[1]).flat_map(row).collect())
}

/// The channels whose values move by the greatest part of their scale, each in its own range.
fn chart(motion: &Motion) -> Vec<u8> {
    let first = motion.rig.joint_channels();
    let range = |channel: usize| {
        let values = &motion.values[channel];
        let (least, most) = values.iter().fold((f64::MAX, f64::MIN), |(least, most), x| (least.min(*x), most.max(*x)));
        let full = channel.checked_sub(first).map_or(1.0, |scalar| motion.rig.scalars[scalar].full_scale);
        (channel, least, most, (most - least) / full)
    };
    let mut moving: Vec<_> = (0..motion.values.len()).map(range).filter(|range| range.3 > 0.0).collect();
    moving.sort_by(|a, b| b.3.total_cmp(&a.3));
    moving.truncate(STRIPS);
    let mut canvas = Canvas::new(INSIDE, PICTURE[1], PAPER);
    let pitch = PICTURE[1] / STRIPS;
    for (strip, &(channel, least, most, _)) in moving.iter().enumerate() {
        let name: String = motion.rig.channel_name(channel).chars().take(LETTERS).collect();
        text(&mut canvas, &name, 2, strip * pitch + 3);
        let wide = INSIDE - NAMES - 4;
        let point = |pixel: usize| {
            let value = motion.values[channel][pixel * (motion.frames - 1) / (wide - 1)];
            let height = (most - value) / (most - least) * (pitch - 4) as f64;
            Point::new((NAMES + pixel) as i32, (strip * pitch + 2) as i32 + height.round() as i32)
        };
        let places: Vec<Point> = (0..wide).map(point).collect();
        let Ok(()) = Polyline::new(&places).into_styled(PrimitiveStyle::with_stroke(Gray8::new(INK), 1)).draw(&mut canvas);
    }
    canvas.pixels().to_vec()
}

/// Writes the cells in rows as a PNG.
pub fn write(out: impl Write, cells: &[Cell]) -> Result<()> {
    let (columns, rows) = (cells.len().clamp(1, COLUMNS), cells.len().div_ceil(COLUMNS).max(1));
    let (wide, high) = (INSIDE + GAP, PICTURE[1] + GAP + LABEL);
    let mut sheet = Canvas::new(GAP + columns * wide, GAP + rows * high, SHEET);
    for (index, cell) in cells.iter().enumerate() {
        let (left, top) = (GAP + index % COLUMNS * wide, GAP + index / COLUMNS * high);
        sheet.put(left, top, INSIDE, &cell.pixels);
        let label: String = cell.label.chars().take(INSIDE / 6).collect();
        text(&mut sheet, &label, left, top + PICTURE[1] + 2);
    }
    sheet.write(out)
}

fn text(canvas: &mut Canvas, text: &str, left: usize, top: usize) {
    let style = MonoTextStyle::new(&FONT_6X10, Gray8::new(INK));
    let place = Point::new(left as i32, top as i32);
    let Ok(_) = Text::with_baseline(text, place, style, Baseline::Top).draw(canvas);
}
