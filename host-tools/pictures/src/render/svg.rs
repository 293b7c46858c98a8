//! Vector pictures: a line a bone, a circle for the head.

use super::scene::{Disc, Scene, Stroke};
use pantin_figure::ink::BodyPart;
use pantin_images::palette::{Palette, Rgb};
use pantin_images::sheet::Layout;
use std::fmt::Write;

/// Size of letters.
const LETTERS: usize = 10;

/// One picture.
pub fn picture(scene: &Scene, [width, height]: [usize; 2], palette: &Palette) -> String {
    let mut out = head([width, height]);
    let _ = writeln!(out, "<rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>", hex(palette.paper()));
    push(&mut out, scene, palette);
    out + "</svg>\n"
}

/// Labelled pictures in their places.
pub fn sheet(layout: Layout, cells: &[(String, Scene)], palette: &Palette) -> String {
    let [wide, high] = layout.size();
    let [width, height] = layout.picture;
    let mut out = head([wide, high]);
    let _ = writeln!(out, "<clipPath id=\"picture\"><rect width=\"{width}\" height=\"{height}\"/></clipPath>");
    let _ = writeln!(out, "<rect width=\"{wide}\" height=\"{high}\" fill=\"{}\"/>", hex(palette.margin()));
    for (index, (label, scene)) in cells.iter().enumerate() {
        let [left, top] = layout.corner(index);
        let _ = writeln!(out, "<g transform=\"translate({left} {top})\">");
        let _ = writeln!(out, "<g clip-path=\"url(#picture)\">");
        let _ = writeln!(out, "<rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>", hex(palette.paper()));
        push(&mut out, scene, palette);
        let (ink, below) = (hex(palette.letters()), height + LETTERS);
        let style = format!("font-family=\"monospace\" font-size=\"{LETTERS}\" fill=\"{ink}\"");
        let _ = writeln!(out, "</g>\n<text x=\"2\" y=\"{below}\" {style}>{}</text>\n</g>", escaped(label));
    }
    out + "</svg>\n"
}

fn head([width, height]: [usize; 2]) -> String {
    let size = format!("width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\"");
    format!("<svg xmlns=\"http://www.w3.org/2000/svg\" {size}>\n")
}

fn push(out: &mut String, scene: &Scene, palette: &Palette) {
    out.push_str("<g class=\"ground\">\n");
    let lines = |out: &mut String, strokes: &[Stroke]| {
        strokes.iter().for_each(|stroke| line(out, stroke, palette.ramp(stroke.body_part, stroke.shade), ""));
    };
    lines(out, &scene.ground);
    for Disc { centre: [x, y], radius, shade, .. } in &scene.dots {
        let ink = hex(palette.ramp(BodyPart::Ground, *shade));
        let _ = writeln!(out, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius}\" fill=\"{ink}\"/>");
    }
    out.push_str("</g>\n<g class=\"figure\" stroke-linecap=\"round\">\n");
    for bone in &scene.bones {
        if let Some(gap) = bone.clearance() {
            line(out, &gap, palette.paper(), " stroke-linecap=\"butt\"");
        }
        line(out, bone, palette.ramp(bone.body_part, bone.shade), "");
    }
    out.push_str("</g>\n");
    if let Some(Disc { centre: [x, y], radius, width, shade }) = scene.head {
        let (ink, paper) = (hex(palette.ramp(BodyPart::Middle, shade)), hex(palette.paper()));
        let circle = format!("cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius:.2}\"");
        let _ = writeln!(out, "<circle {circle} fill=\"{paper}\" stroke=\"{ink}\" stroke-width=\"{width:.2}\"/>");
    }
    if !scene.face.is_empty() {
        out.push_str("<g class=\"face\">\n");
        lines(out, &scene.face);
        out.push_str("</g>\n");
    }
}

fn line(out: &mut String, stroke: &Stroke, ink: Rgb, more: &str) {
    let Stroke { from: [x1, y1], to: [x2, y2], width, .. } = stroke;
    let ends = format!("x1=\"{x1:.2}\" y1=\"{y1:.2}\" x2=\"{x2:.2}\" y2=\"{y2:.2}\"");
    let _ = writeln!(out, "<line {ends} stroke=\"{}\" stroke-width=\"{width:.2}\"{more}/>", hex(ink));
}

fn hex([r, g, b]: Rgb) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Text without what means something in XML, and without control characters, which it cannot hold.
pub fn escaped(text: &str) -> String {
    let text: String =
        text.chars().filter(|&letter| !letter.is_control() && !matches!(letter, '\u{fffe}' | '\u{ffff}')).collect();
    text.replace('&', "&amp;").replace('<', "&lt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_name_leaves_a_document_whole() {
        let name: String = ('\0'..='\u{ffff}').collect();
        let document = format!("<text>{}</text>", escaped(&name));
        assert!(roxmltree::Document::parse(&document).is_ok());
        assert_eq!(escaped("a\u{fffe}<&"), "a&lt;&amp;");
    }
}
