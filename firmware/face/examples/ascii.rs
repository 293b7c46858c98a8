//! Prints a face as text: `cargo run -p pantin-face --example ascii -- jawOpen=0.4 smile=1 blink_left=1`

use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Size};
use embedded_graphics::pixelcolor::BinaryColor;
use pantin_face::{FaceRenderer, FaceView, MODEL, Model, Morph, NAMES, VERTICES, Weight, Weights};
use pantin_figure::Canvas;

const CANVAS: Canvas = Canvas { width: 80, height: 64 };

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = Model::new_checked(MODEL)?;
    let mut weights = Weights::new();
    for argument in std::env::args().skip(1) {
        let (name, weight) = argument.split_once('=').unwrap_or((&argument, "1"));
        let weight = weight.parse::<Weight>()?;
        weights.set(&model, name, weight).map_err(|error| format!("{name}: {error}; the names are:\n{NAMES}"))?;
    }
    let mut morph = Morph::<VERTICES>::new(&model)?;
    let mut renderer = FaceRenderer::<VERTICES>::new(&model, CANVAS, FaceView::default());
    morph.apply(&model, &weights);
    renderer.project(&model, &morph);

    let mut page = Page([[' '; CANVAS.width as usize]; CANVAS.height as usize]);
    renderer.draw(&model, &mut page)?;
    for row in page.0 {
        println!("{}", String::from_iter(row).trim_end());
    }
    Ok(())
}

/// A display of letters.
struct Page([[char; CANVAS.width as usize]; CANVAS.height as usize]);

impl OriginDimensions for Page {
    fn size(&self) -> Size {
        Size::new(CANVAS.width.into(), CANVAS.height.into())
    }
}

impl DrawTarget for Page {
    type Color = BinaryColor;
    type Error = std::convert::Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<BinaryColor>>>(&mut self, pixels: I) -> Result<(), Self::Error> {
        for Pixel(point, color) in pixels {
            if let Some(cell) = self.0.get_mut(point.y as usize).and_then(|row| row.get_mut(point.x as usize)) {
                *cell = if color.is_on() { '#' } else { ' ' };
            }
        }
        Ok(())
    }
}
