//! Draws pictures of a face with the device's own code.

use pantin_face::{FaceRenderer, FaceView, Model, Morph, Vertex, Weights};
use pantin_figure::Canvas;
use pantin_images::shades::Shades;

/// Maximum number of vertices of any model.
pub const ROOM: usize = 1 << 15;

/// A picture, and where its vertices are.
pub struct Drawn {
    /// Rows of grey values, 0 to 255.
    pub pixels: Vec<u8>,
    /// The vertices in steps of the model.
    pub vertices: Vec<Vertex>,
    /// The vertices on the display, in sixteenths of a pixel; those that no line needs are 0.
    pub points: Vec<[i16; 2]>,
}

/// Returns a picture of a face: rows of grey values, 0 to 255.
pub fn picture(model: &Model, weights: &Weights, canvas: Canvas, view: FaceView) -> Vec<u8> {
    draw(model, weights, canvas, view).pixels
}

/// Draws a face.
pub fn draw(model: &Model, weights: &Weights, canvas: Canvas, view: FaceView) -> Drawn {
    let mut morph = Box::new(Morph::<ROOM>::new(model).expect("a model has at most ROOM vertices"));
    let mut renderer = Box::new(FaceRenderer::<ROOM>::new(model, canvas, view));
    morph.apply(model, weights);
    renderer.project(model, &morph);
    let mut lines = Vec::new();
    renderer.each_line(model, |line| lines.push(line));
    let (width, height) = (usize::from(canvas.width), usize::from(canvas.height));
    let mut shades = Shades::new(width, height);
    shades.draw_lines(&lines, false);
    let pixels = (0..width * height).map(|index| shades.at(index % width, index / width).shade).collect();
    Drawn { pixels, vertices: morph.vertices().to_vec(), points: renderer.points().to_vec() }
}
