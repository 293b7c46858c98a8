//! Draws pictures of a face with the device's own code.

use crate::render::shades::Shades;
use pantin_face::{FaceRenderer, FaceView, Model, Morph, Weights};
use pantin_figure::Canvas;

/// Maximum number of vertices of any model.
pub const ROOM: usize = 1 << 15;

/// Returns a picture of a face: rows of grey values, 0 to 255.
pub fn picture(model: &Model, weights: &Weights, canvas: Canvas, view: FaceView) -> Vec<u8> {
    let mut morph = Box::new(Morph::<ROOM>::new(model).expect("a model has at most ROOM vertices"));
    let mut renderer = Box::new(FaceRenderer::<ROOM>::new(model, canvas, view));
    morph.apply(model, weights);
    renderer.project(model, &morph);
    let mut lines = Vec::new();
    renderer.each_line(model, |line| lines.push(line));
    let (width, height) = (usize::from(canvas.width), usize::from(canvas.height));
    let mut shades = Shades::new(width, height);
    shades.draw_lines(&lines, false);
    (0..width * height).map(|index| shades.at(index % width, index / width).shade).collect()
}
