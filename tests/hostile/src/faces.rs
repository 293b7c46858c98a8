//! Models of faces: an error, or a face that is drawn within its display.

use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Size};
use embedded_graphics::pixelcolor::BinaryColor;
use pantin_face::{FaceRenderer, FaceView, MODEL, Model, Morph, Weight, Weights};
use pantin_figure::Canvas;

use crate::noise::Noise;

/// Vertices that the faces have memory for.
const VERTICES: usize = 512;
const CANVAS: Canvas = Canvas { width: 64, height: 64 };
/// Pictures of one model.
const PICTURES: usize = 3;

/// Pantin's own face.
pub fn models() -> Vec<Vec<u8>> {
    vec![MODEL.to_vec()]
}

/// Counts pixels, and refuses those outside.
struct Display {
    pixels: usize,
}

impl OriginDimensions for Display {
    fn size(&self) -> Size {
        Size::new(CANVAS.width.into(), CANVAS.height.into())
    }
}

impl DrawTarget for Display {
    type Color = BinaryColor;
    type Error = &'static str;

    fn draw_iter<I: IntoIterator<Item = Pixel<BinaryColor>>>(&mut self, pixels: I) -> Result<(), Self::Error> {
        for Pixel(point, _) in pixels {
            let inside = |value: i32, size: u16| (0..i32::from(size)).contains(&value);
            if !inside(point.x, CANVAS.width) || !inside(point.y, CANVAS.height) {
                return Err("a pixel outside of the display");
            }
            self.pixels += 1;
        }
        Ok(())
    }
}

/// Opens a model, walks it and draws it with several weights. Returns whether it opened.
pub fn face_model(bytes: &[u8]) -> bool {
    let Ok(model) = Model::new_checked(bytes) else { return false };
    let vertices = model.vertices();
    assert!(vertices > 0);
    for curve in model.curves() {
        assert!(curve.vertices().all(|vertex| usize::from(vertex) < vertices));
    }
    assert_eq!(model.shapes().count(), model.shape_count());
    let mut entries: Vec<_> = model.name_entries().collect();
    entries.truncate(64);
    let Ok(mut morph) = Morph::<VERTICES>::new(&model) else { return true };
    let mut renderer = FaceRenderer::<VERTICES>::new(&model, CANVAS, FaceView::default());
    let mut noise = Noise::new(bytes.len() as u64);
    let mut weights = Weights::new();
    for _ in 0..PICTURES {
        morph.apply(&model, &weights);
        renderer.project(&model, &morph);
        renderer.draw(&model, &mut Display { pixels: 0 }).expect("lines are clipped");
        for entry in &entries {
            weights.add_to(entry.target, noise.between(-1 << 16, 1 << 16));
        }
        let _ = weights.set(&model, "jawOpen", Weight::ONE);
    }
    true
}
