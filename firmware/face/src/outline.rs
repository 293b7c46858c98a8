//! The outline: where the surface turns away from the camera, a line through each triangle that has corners on both sides.

use crate::crossing::{between, zero_crossing};
use crate::model::Model;
use crate::pen::StrokeSink;
use heapless::Vec;

/// Brightness.
const SHADE: u8 = 200;
/// Maximum number of triangles that are kept from frame to frame; if there are more, or the model is wide, all are searched for in every frame.
const KEPT: usize = 48;
/// Lines for which the surface is marked at once. Mirror images follow each other, so the rectangles are as wide as the face anyway.
const LINES_PER_MARK: usize = 4;

/// The triangles that make the outline while the head does not rotate.
#[derive(Clone, Debug)]
pub(crate) struct Outline {
    triangles: Vec<Crossed, KEPT>,
    overflown: bool,
}

/// A triangle that the outline crosses.
#[derive(Clone, Copy, Debug)]
struct Crossed {
    /// The corner that is alone on its side, and the two others. One byte each: the triangles of wide models are not kept.
    corners: [u8; 3],
    /// The part of the edges to these two, Q8, at which the surface turns away.
    parts: [u8; 2],
}

impl Crossed {
    #[inline]
    fn new(corners: [u16; 3], facing: &[i8]) -> Self {
        let of = |index: u16| i32::from(facing.get(usize::from(index)).copied().unwrap_or(0));
        let [apex, one, other] = corners;
        Crossed {
            corners: [apex as u8, one as u8, other as u8],
            parts: [one, other].map(|index| zero_crossing(of(apex), of(index)).min(255) as u8),
        }
    }

    #[cfg_attr(not(target_arch = "wasm32"), inline(always))]
    fn draw(&self, points: &[[i16; 2]], out: &mut impl StrokeSink) {
        let [apex, one, other] = self.corners;
        draw_between([apex.into(), one.into(), other.into()], self.parts, points, out);
    }
}

/// Draws the line through a triangle: between points on the edges from its first corner to the others.
#[cfg_attr(not(target_arch = "wasm32"), inline(always))]
fn draw_between([apex, one, other]: [u16; 3], parts: [u8; 2], points: &[[i16; 2]], out: &mut impl StrokeSink) {
    let at = |index: u16| points.get(usize::from(index)).copied().unwrap_or_default();
    let apex = at(apex);
    out.line(between(apex, at(one), parts[0].into()), between(apex, at(other), parts[1].into()));
}

impl Outline {
    /// An outline without triangles.
    pub const EMPTY: Outline = Outline { triangles: Vec::new(), overflown: false };

    /// Finds the triangles.
    #[inline(never)]
    pub fn find(&mut self, model: &Model, facing: &[i8]) {
        self.triangles.clear();
        self.overflown = model.wide;
        if model.wide {
            return;
        }
        each_crossed(model, facing, &mut |corners| self.keep(corners, facing));
    }

    #[inline(never)]
    fn keep(&mut self, corners: [u16; 3], facing: &[i8]) {
        self.overflown |= self.triangles.push(Crossed::new(corners, facing)).is_err();
    }

    /// Whether there are more triangles than are kept, or they cannot be.
    pub fn overflown(&self) -> bool {
        self.overflown
    }

    /// Visits the corners of the triangles that are kept.
    pub fn each_corner(&self, mut visit: impl FnMut(u16)) {
        self.triangles.iter().flat_map(|crossed| crossed.corners).for_each(|index| visit(u16::from(index)));
    }

    /// Draws the lines, given the vertices on the display and which of them face the camera.
    #[inline]
    pub fn draw(&self, model: &Model, points: &[[i16; 2]], facing: &[i8], out: &mut impl StrokeSink) {
        out.begin(SHADE);
        if self.overflown {
            draw_all(model, points, facing, out);
        } else {
            // The outline surrounds the face: the surface is marked every few lines.
            for some in self.triangles.chunks(LINES_PER_MARK) {
                some.iter().for_each(|crossed| crossed.draw(points, out));
                out.end();
            }
        }
    }
}

/// Draws more triangles than are kept. In a function of its own, because its stack is seldom needed.
#[inline(never)]
fn draw_all(model: &Model, points: &[[i16; 2]], facing: &[i8], out: &mut impl StrokeSink) {
    each_crossed(model, facing, &mut |corners| {
        draw_between(corners, Crossed::new(corners, facing).parts, points, out);
        out.end();
    });
}

#[cfg_attr(not(target_arch = "wasm32"), inline(always))]
fn each_crossed(model: &Model, facing: &[i8], visit: &mut dyn FnMut([u16; 3])) {
    let of = |index: u16| facing.get(usize::from(index)).copied().unwrap_or(0);
    let signs = signs(model, facing);
    let looked_up = model.middles() + model.pairs() <= signs.len();
    // Most triangles and their images have all corners on one side: no two signs differ.
    let crossed = |[x, y, z]: [u16; 3]| {
        let [a, b, c] = [x, y, z].map(|corner| signs.get(usize::from(corner)).copied().unwrap_or(0));
        !looked_up || (a ^ b) | (a ^ c) != 0
    };
    each_triangle(model, model.outline(), crossed, |[x, y, z]| {
        let (a, b, c) = (of(x), of(y), of(z));
        if (a ^ b) | (a ^ c) >= 0 {
            return;
        }
        visit(if (a ^ b) >= 0 {
            [z, x, y]
        } else if (a ^ c) >= 0 {
            [y, z, x]
        } else {
            [x, y, z]
        });
    });
}

/// Maximum number of stored vertices for which a table says which side of the outline they are on.
const SIGNS: usize = 144;

/// Which stored vertices face away (bit 0), and which of their images (bit 1). Not usable for models with more than [`SIGNS`] stored vertices.
#[inline(always)]
fn signs(model: &Model, facing: &[i8]) -> [u8; SIGNS] {
    let mut signs = [0; SIGNS];
    let (middles, left) = facing.split_at_checked(model.middles()).unwrap_or((facing, &[]));
    let right = left.get(model.pairs()..).unwrap_or(&[]);
    for (sign, &own) in signs.iter_mut().zip(middles) {
        *sign = (own as u8 >> 7) * 3;
    }
    let rest = signs.get_mut(model.middles()..).unwrap_or_default();
    for ((sign, &own), &image) in rest.iter_mut().zip(left).zip(right) {
        *sign = own as u8 >> 7 | (image as u8 >> 7) << 1;
    }
    signs
}

/// Visits those of the first `most` stored triangles that are `wanted`, each with its mirror image.
#[inline(always)]
pub(crate) fn each_triangle(model: &Model, most: usize, wanted: impl Fn([u16; 3]) -> bool, mut visit: impl FnMut([u16; 3])) {
    let (image, halves) = (model.image(), model.pairs() > 0);
    let mut both = |a: u16, b: u16, c: u16| {
        if !wanted([a, b, c]) {
            return;
        }
        visit([a, b, c]);
        // A model without pairs has no images. Otherwise no triangle is its own image: one in the middle would be flat.
        if halves {
            visit([image.of(a), image.of(c), image.of(b)]);
        }
    };
    if model.wide {
        for &[a, b, c, d, e, f] in model.triangles.as_chunks::<6>().0.iter().take(most) {
            both(u16::from_le_bytes([a, b]), u16::from_le_bytes([c, d]), u16::from_le_bytes([e, f]));
        }
    } else {
        for &[a, b, c] in model.triangles.as_chunks::<3>().0.iter().take(most) {
            both(u16::from(a), u16::from(b), u16::from(c));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Camera, FaceView};
    use crate::pen::EachLine;
    use crate::projection::{facing, towards};
    use crate::{MODEL, VERTICES};
    use pantin_figure::lines::Line;

    /// What is slower by a fifth for larger models is not needed for our own.
    #[test]
    fn our_own_face_has_room_in_the_tables() {
        let model = Model::new_checked(MODEL).unwrap();
        assert!(model.middles() + model.pairs() <= SIGNS, "{} stored vertices", model.middles() + model.pairs());
        let mut most = 0;
        for orbit in (-45..=45).step_by(5) {
            for tilt in (-30..=30).step_by(5) {
                let mut camera = Camera::EMPTY;
                camera.aim(FaceView { orbit, tilt });
                let mut cosines = [0; VERTICES];
                facing(&model, towards(&camera, [0; 3]), &mut cosines);
                let mut outline = Outline::EMPTY;
                outline.find(&model, &cosines);
                assert!(!outline.overflown(), "{orbit} and {tilt} degrees");
                most = most.max(outline.triangles.len());
            }
        }
        assert!(most > KEPT / 2, "{most} triangles at most");
    }

    /// The lines of an outline, as they are drawn.
    fn lines(outline: &Outline, model: &Model, points: &[[i16; 2]], cosines: &[i8]) -> std::vec::Vec<Line> {
        let mut lines = std::vec::Vec::new();
        outline.draw(model, points, cosines, &mut EachLine::new(|line| lines.push(line)));
        lines
    }

    #[test]
    fn an_outline_that_is_not_kept_is_the_same() {
        let model = Model::new_checked(MODEL).unwrap();
        let points: [[i16; 2]; VERTICES] = core::array::from_fn(|index| [(index * 37 % 2048) as i16, (index * 91 % 1024) as i16]);
        for orbit in (-180..180).step_by(15) {
            let mut camera = Camera::EMPTY;
            camera.aim(FaceView { orbit, tilt: orbit / 6 });
            let mut cosines = [0; VERTICES];
            facing(&model, towards(&camera, [0; 3]), &mut cosines);
            let mut outline = Outline::EMPTY;
            outline.find(&model, &cosines);
            let kept = lines(&outline, &model, &points, &cosines);
            assert!(kept.len() > 10 && !outline.overflown(), "{orbit} degrees");
            outline.overflown = true;
            assert_eq!(kept, lines(&outline, &model, &points, &cosines), "{orbit} degrees");
        }
        let mut outline = Outline::EMPTY;
        outline.find(&Model { wide: true, ..model }, &[0; VERTICES]);
        assert!(outline.overflown() && outline.triangles.is_empty());
    }
}
