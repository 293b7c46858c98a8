//! Writes a picture of many labelled faces, such as the sheet of all units and emotions.

use super::Face;
use super::blueprint::Blueprint;
use super::draw::picture;
use super::pose;
use anyhow::Result;
use embedded_graphics::Drawable;
use embedded_graphics::geometry::Point;
use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_6X10};
use embedded_graphics::pixelcolor::Gray8;
use embedded_graphics::text::{Baseline, Text};
use pantin_face::{FaceView, Model};
use pantin_images::canvas::Canvas;
use std::io::Write;

const GAP: usize = 6;
const LABEL: usize = 13;
/// Brightness of the sheet and of its labels.
const SHEET: u8 = 40;
const INK: u8 = 210;
/// Width of a letter in pixels.
const LETTER: usize = 6;

/// A labelled picture.
pub struct Cell {
    /// The text below the picture.
    pub label: String,
    /// Rows of grey values.
    pub pixels: Vec<u8>,
}

/// Writes cells of one size in rows as a PNG, `columns` in each.
pub fn write(out: impl Write, cells: &[Cell], columns: usize, [width, height]: [usize; 2]) -> Result<()> {
    let rows = cells.len().div_ceil(columns).max(1);
    let (wide, high) = (width + GAP, height + GAP + LABEL);
    let mut sheet = Canvas::new(GAP + columns * wide, GAP + rows * high, SHEET);
    for (index, cell) in cells.iter().enumerate() {
        let (left, top) = (GAP + index % columns * wide, GAP + index / columns * high);
        sheet.put(left, top, width, &cell.pixels);
        let label: String = cell.label.chars().take(width / LETTER).collect();
        let style = MonoTextStyle::new(&FONT_6X10, Gray8::new(INK));
        let place = Point::new(left as i32, (top + height + 2) as i32);
        let Ok(_) = Text::with_baseline(&label, place, style, Baseline::Top).draw(&mut sheet);
    }
    sheet.write(out)
}

/// Faces per row, and their size in pixels.
const COLUMNS: usize = 8;
const SIZE: [usize; 2] = [160, 160];

/// The pictures of the sheet: label, pose, and degrees of the view's orbit. A label without a weight shows the whole unit.
const POSES: [(&str, &str, i16); 64] = [
    ("neutral", "", 0),
    ("three quarters", "", 35),
    ("profile", "", 90),
    ("joy = 2", "joy", 0),
    ("sadness = 3 + 4a", "sadness", 0),
    ("sadness = 3 + 4b", "sadness_outer", 0),
    ("surprise = 4b + 1", "surprise", 0),
    ("as printed: 3 + 1", "surprise_printed", 0),
    ("1 open the mouth", "open_mouth", 0),
    ("2 smile", "smile", 0),
    ("2 left", "smile_left", 0),
    ("3 lower the corners", "lower_corners", 0),
    ("4a brows, inner", "brow_inner_lower", 0),
    ("4b brows, outer", "brow_outer_raise", 0),
    ("5 puff the cheeks", "puff_cheeks", 0),
    ("5 left, from the side", "puff_cheeks_left", -40),
    ("blink", "blink", 0),
    ("wink_left", "wink_left", 0),
    ("widen", "widen", 0),
    ("squint", "squint", 0),
    ("look_left", "look_left", 0),
    ("2 wider smile", "wide_smile", 0),
    ("look_up", "look_up", 0),
    ("look_down", "look_down", 0),
    ("turn_left 0.7", "turn_left=0.7", 0),
    ("turn_right 0.7", "turn_right=0.7", 0),
    ("nod 0.7", "nod=0.7", 0),
    ("raise_head 0.7", "raise_head=0.7", 0),
    ("tilt_left 0.7", "tilt_left=0.7", 0),
    ("brow_inner_up", "brow_inner_up", 0),
    ("brow_lower", "brow_lower", 0),
    ("brow_raise", "brow_raise", 0),
    ("cheek_raise", "cheek_raise", 0),
    ("nose_wrinkle", "nose_wrinkle", 0),
    ("corner_up", "corner_up", 0),
    ("frown", "frown", 0),
    ("stretch", "stretch", 0),
    ("pucker", "pucker", 0),
    ("funnel", "funnel", 0),
    ("lip_press", "lip_press", 0),
    ("roll_upper", "roll_upper", 0),
    ("roll_lower", "roll_lower", 0),
    ("upper_lip_raise", "upper_lip_raise", 0),
    ("lower_lip_lower", "lower_lip_lower", 0),
    ("shrug_lower", "shrug_lower", 0),
    ("shrug_upper", "shrug_upper", 0),
    ("mouth_left", "mouth_left", 0),
    ("jaw_left", "jaw_left", 0),
    ("jaw_forward, from aside", "jaw_forward", -60),
    ("1 0.25, mouth_close 0.5", "open_mouth=0.25,mouth_close=0.5", 0),
    ("1 0.3, tongue_out", "open_mouth=0.3,tongue_out", 0),
    ("1 0.3, tongue_up", "open_mouth=0.3,tongue_up", 0),
    ("p, b, m", "viseme_pp", 0),
    ("f, v", "viseme_ff", 0),
    ("th", "viseme_th", 0),
    ("ch, sh", "viseme_ch", 0),
    ("s, z", "viseme_ss", 0),
    ("r", "viseme_rr", 0),
    ("a", "viseme_aa", 0),
    ("e", "viseme_e", 0),
    ("i", "viseme_i", 0),
    ("o", "viseme_o", 0),
    ("u", "viseme_u", 0),
    ("laugh, from aside", "corner_up=0.9,open_mouth=0.35,cheek_raise,squint=0.6", -20),
];

/// Writes a sheet of a model's own units and sums, at full weight, and of the neutral face.
pub fn of_model(out: impl Write, face: &Blueprint, bytes: &[u8]) -> Result<()> {
    let model = Model::new_checked(bytes)?;
    let canvas = pantin_figure::Canvas { width: BIG[0] as u16, height: BIG[1] as u16 };
    let mut names: Vec<&str> = vec![""];
    for drive in &face.names {
        if !names.contains(&drive.name.as_str()) {
            names.push(&drive.name);
        }
    }
    let cell = |name: &&str| {
        let weights = pose::weights(&pose::parse(face, name)?);
        let label = if name.is_empty() { "neutral" } else { name };
        Ok(Cell { label: label.into(), pixels: picture(&model, &weights, canvas, FaceView::default()) })
    };
    let cells = names.iter().take(MOST_CELLS).map(cell).collect::<Result<Vec<_>>>()?;
    write(out, &cells, 5, BIG)
}

/// The size of a picture of another mesh, which shows its triangles, and how many pictures there are at most.
const BIG: [usize; 2] = [224, 224];
const MOST_CELLS: usize = 40;

/// Writes the sheet of all units and emotions.
pub fn units(out: impl Write, face: &Face) -> Result<()> {
    let model = face.model()?;
    let canvas = pantin_figure::Canvas { width: SIZE[0] as u16, height: SIZE[1] as u16 };
    let cell = |&(label, sum, orbit): &(&str, &str, i16)| {
        let weights = pose::weights(&pose::parse(&face.blueprint, sum)?);
        Ok(Cell { label: label.into(), pixels: picture(&model, &weights, canvas, FaceView { orbit, tilt: 0 }) })
    };
    let cells = POSES.iter().map(cell).collect::<Result<Vec<_>>>()?;
    write(out, &cells, COLUMNS, SIZE)
}
