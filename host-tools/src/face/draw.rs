//! Pictures of a face, by the device's own code.

use embedded_graphics::geometry::Point;
use embedded_graphics::primitives::{Line as Stroke, PointsIter};
use pantin_face::{Look, Model, Morph, View, Weights};
use pantin_figure::Canvas;
use pantin_figure::lines::{Line, pixel};

/// Room for models from outside too.
pub const ROOM: usize = 1 << 15;

/// A face with its camera.
pub struct Artist<'a> {
    model: Model<'a>,
    morph: Box<Morph<ROOM>>,
    look: Box<Look<ROOM>>,
    canvas: Canvas,
}

impl<'a> Artist<'a> {
    /// Sets up the camera.
    pub fn new(model: Model<'a>, canvas: Canvas, view: View) -> Artist<'a> {
        let morph = Box::new(Morph::new(&model).expect("a model has at most ROOM vertices"));
        let look = Box::new(Look::new(&model, canvas, view));
        Artist { model, morph, look, canvas }
    }

    /// Rows of pixels of the face with `weights`.
    pub fn draw(&mut self, weights: &Weights) -> Vec<u8> {
        self.morph.place(&self.model, weights);
        self.look.project(&self.model, &self.morph);
        let (width, height) = (usize::from(self.canvas.width), usize::from(self.canvas.height));
        let mut pixels = vec![0u8; width * height];
        self.look.lines(&self.model, |line| stroke(&line, width, &mut pixels));
        pixels
    }
}

/// One picture.
pub fn picture(model: &Model, weights: &Weights, canvas: Canvas, view: View) -> Vec<u8> {
    Artist::new(*model, canvas, view).draw(weights)
}

/// Where lines cross, the brighter one shows.
fn stroke(line: &Line, width: usize, pixels: &mut [u8]) {
    let [from, to] = [line.from, line.to].map(|[x, y]| Point::new(pixel(x), pixel(y)));
    for point in Stroke::new(from, to).points() {
        let inside = (0..width as i32).contains(&point.x) && point.y >= 0;
        if let Some(pixel) = pixels.get_mut(point.y.max(0) as usize * width + point.x.max(0) as usize)
            && inside
        {
            *pixel = (*pixel).max(line.shade);
        }
    }
}
