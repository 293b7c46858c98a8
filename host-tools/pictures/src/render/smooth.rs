//! Smooth pictures: anti-aliased strokes of their depth's thickness, for displays of many pixels.

use super::scene::{Disc, Scene, Stroke};
use pantin_figure::ink::BodyPart;
use pantin_images::image::Image;
use pantin_images::palette::{Palette, Rgb};
use tiny_skia::{FillRule, LineCap, Paint, PathBuilder, Pixmap, Transform};

/// Draws a scene.
pub fn draw(scene: &Scene, width: usize, height: usize, palette: &Palette) -> Image {
    // Sizes were checked where they were asked for.
    let Some(mut pixmap) = Pixmap::new(width as u32, height as u32) else { return Image::new(width, height, palette.paper()) };
    pixmap.fill(colour(palette.paper()));
    for stroke in &scene.ground {
        line(&mut pixmap, stroke, palette.ramp(stroke.body_part, stroke.shade), cap(stroke));
    }
    for dot in &scene.dots {
        fill(&mut pixmap, dot, palette.ramp(BodyPart::Ground, dot.shade));
    }
    for bone in &scene.bones {
        if let Some(gap) = bone.clearance() {
            line(&mut pixmap, &gap, palette.paper(), LineCap::Butt);
        }
        line(&mut pixmap, bone, palette.ramp(bone.body_part, bone.shade), LineCap::Round);
    }
    if let Some(head) = scene.head {
        circle(&mut pixmap, &head, palette);
    }
    for stroke in &scene.face {
        line(&mut pixmap, stroke, palette.ramp(stroke.body_part, stroke.shade), cap(stroke));
    }
    let pixels = pixmap.data().chunks_exact(4).map(|rgba| [rgba[0], rgba[1], rgba[2]]).collect();
    Image::of(width, pixels)
}

/// The lines of a face join; the ground's cross.
fn cap(stroke: &Stroke) -> LineCap {
    if stroke.body_part == BodyPart::Ground { LineCap::Butt } else { LineCap::Round }
}

fn line(pixmap: &mut Pixmap, stroke: &Stroke, ink: Rgb, line_cap: LineCap) {
    let mut path = PathBuilder::new();
    path.move_to(stroke.from[0], stroke.from[1]);
    path.line_to(stroke.to[0], stroke.to[1]);
    let style = tiny_skia::Stroke { width: stroke.width, line_cap, ..Default::default() };
    // A line without length has no path.
    if let Some(path) = path.finish() {
        pixmap.stroke_path(&path, &paint(ink), &style, Transform::identity(), None);
    }
}

fn circle(pixmap: &mut Pixmap, head: &Disc, palette: &Palette) {
    let Some(path) = PathBuilder::from_circle(head.centre[0], head.centre[1], head.radius) else { return };
    fill(pixmap, head, palette.paper());
    let style = tiny_skia::Stroke { width: head.width, ..Default::default() };
    pixmap.stroke_path(&path, &paint(palette.ramp(BodyPart::Middle, head.shade)), &style, Transform::identity(), None);
}

fn fill(pixmap: &mut Pixmap, disc: &Disc, ink: Rgb) {
    if let Some(path) = PathBuilder::from_circle(disc.centre[0], disc.centre[1], disc.radius) {
        pixmap.fill_path(&path, &paint(ink), FillRule::Winding, Transform::identity(), None);
    }
}

fn paint(ink: Rgb) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color(colour(ink));
    paint.anti_alias = true;
    paint
}

fn colour([r, g, b]: Rgb) -> tiny_skia::Color {
    tiny_skia::Color::from_rgba8(r, g, b, 255)
}
