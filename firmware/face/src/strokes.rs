//! The lines of a face: its outline, its curves, and on large displays its mesh. Parts that face away from the camera are not drawn.

use crate::crossing::{between, zero_crossing};
use crate::curve::Curve;
use crate::model::Model;
use crate::outline::{Outline, each_triangle};
use crate::pen::StrokeSink;
use crate::polygon::Polygon;
use crate::projection::NOT_DRAWN;

/// Brightness of the mesh.
const MESH: u8 = 44;
/// The lowest detail at which the mesh is drawn.
const MESH_DETAIL: u8 = 3;
/// Curves end where the cosine between normal and camera falls below this, in 127ths.
const GRAZING: i8 = 4;

/// A face on the display.
#[derive(Clone, Copy)]
pub(crate) struct ProjectedFace<'s> {
    /// Vertices in sixteenths of a pixel.
    pub points: &'s [[i16; 2]],
    pub facing: &'s [i8],
    pub outline: &'s Outline,
}

/// Draws all lines, the brighter ones after the darker ones.
#[inline]
pub(crate) fn draw(model: &Model, face: ProjectedFace, detail: u8, out: &mut impl StrokeSink) {
    if detail >= MESH_DETAIL {
        face.mesh(model, out);
    }
    face.outline.draw(model, face.points, face.facing, out);
    for curve in model.curves().filter(|curve| curve.is_drawn(detail)) {
        let fine = if curve.straight { &[][..] } else { FINE.get(usize::from(detail)).copied().unwrap_or(&[]) };
        for mirrored in [false, true] {
            if mirrored && !curve.mirrored {
                break;
            }
            out.begin(curve.shade);
            if curve.filled {
                face.filled(model, &curve, mirrored, fine, out);
            } else if fine.is_empty() {
                face.straight(model, &curve, mirrored, out);
            } else {
                face.smooth(model, &curve, mirrored, fine, out);
            }
            out.end();
        }
    }
}

/// Marks the vertices that no line needs as [`NOT_DRAWN`]. Large displays and wide models need all.
#[inline(never)]
pub(crate) fn mark_unneeded(model: &Model, detail: u8, outline: &Outline, facing: &mut [i8]) {
    if detail >= MESH_DETAIL || model.wide || outline.overflown() {
        return;
    }
    // One bit for each vertex: models that are not wide have at most 256.
    let mut needed = [0u32; 8];
    let mut need = |index: u16| needed[usize::from(index as u8 >> 5)] |= 1 << (index & 31);
    outline.each_corner(&mut need);
    for curve in model.curves().filter(|curve| curve.is_drawn(detail)) {
        for index in curve.vertices() {
            need(index);
            if curve.mirrored {
                need(model.mirror(index));
            }
        }
    }
    for (index, facing) in facing.iter_mut().enumerate() {
        if needed[(index >> 5) & 7] & 1 << (index & 31) == 0 {
            *facing = NOT_DRAWN;
        }
    }
}

impl ProjectedFace<'_> {
    #[inline(always)]
    pub fn facing(&self, index: u16) -> i8 {
        self.facing.get(usize::from(index)).copied().unwrap_or(-127)
    }

    #[cfg_attr(not(target_arch = "wasm32"), inline(always))]
    pub fn vertex(&self, index: u16) -> ScreenVertex {
        ScreenVertex { at: self.points.get(usize::from(index)).copied().unwrap_or_default(), facing: self.facing(index) }
    }

    /// Draws the edges of triangles that face the camera. An edge is part of two triangles, in opposite directions: one of them draws it.
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    fn mesh(&self, model: &Model, out: &mut impl StrokeSink) {
        out.begin(MESH);
        each_triangle(
            model,
            usize::MAX,
            |_| true,
            |corners| {
                let ends = corners.map(|index| self.vertex(index));
                if ends.iter().all(|end| end.facing <= GRAZING) {
                    return;
                }
                for (from, to) in [(0, 1), (1, 2), (2, 0)] {
                    if corners[from] < corners[to] {
                        visible(ends[from], ends[to], out);
                    }
                }
            },
        );
        out.end();
    }

    /// Draws a curve as straight lines.
    fn straight(&self, model: &Model, curve: &Curve, mirrored: bool, out: &mut impl StrokeSink) {
        let image = model.image();
        let end = |index| self.vertex(if mirrored { image.of(index) } else { index });
        let first = end(curve.vertex(0));
        let mut from = first;
        let mut line_to = |index| {
            let to = end(index);
            visible(from, to, out);
            from = to;
        };
        // Most models are not wide: their indices need no choice for each of them.
        match curve.bytes() {
            Some(bytes) => bytes.iter().skip(1).for_each(|&index| line_to(u16::from(index))),
            None => curve.vertices().skip(1).for_each(line_to),
        }
        if curve.closed {
            visible(from, first, out);
        }
    }

    /// Fills the inside of a closed curve, if its first vertex faces the camera.
    #[inline(never)]
    fn filled(&self, model: &Model, curve: &Curve, mirrored: bool, fine: &[[i32; 4]], out: &mut impl StrokeSink) {
        let len = curve.len();
        let at = |position: usize| {
            let index = curve.vertex(if position < len { position } else { position - len });
            self.vertex(if mirrored { model.mirror(index) } else { index })
        };
        if at(0).facing <= GRAZING {
            return;
        }
        let mut corners = Polygon::new();
        if fine.is_empty() {
            let image = model.image();
            for index in curve.vertices() {
                corners.add(self.vertex(if mirrored { image.of(index) } else { index }).at);
            }
            return corners.fill(out);
        }
        let mut ends = [at(len - 1), at(0), at(1), at(2)];
        for segment in 0..len {
            corners.add(ends[1].at);
            fine.iter().for_each(|weights| corners.add(blend(ends, weights).at));
            ends = [ends[1], ends[2], ends[3], at(segment + 3)];
        }
        corners.fill(out);
    }

    /// Draws a curve that bends through its vertices. In a function of its own: what it prepares is work that straight lines do not need.
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    fn smooth(&self, model: &Model, curve: &Curve, mirrored: bool, fine: &[[i32; 4]], out: &mut impl StrokeSink) {
        let len = curve.len();
        let at = |position: usize| {
            let position = match position {
                position if position < len => position,
                position if curve.closed => position - len,
                _ => len - 1,
            };
            let index = curve.vertex(position);
            self.vertex(if mirrored { model.mirror(index) } else { index })
        };
        let mut ends = [at(if curve.closed { len - 1 } else { 0 }), at(0), at(1), at(2)];
        for segment in 0..if curve.closed { len } else { len - 1 } {
            let [_, from, to, _] = ends;
            if from.facing > GRAZING || to.facing > GRAZING {
                let mut last = from;
                for weights in fine {
                    let next = blend(ends, weights);
                    visible(last, next, out);
                    last = next;
                }
                visible(last, to, out);
            }
            ends = [from, to, ends[3], at(segment + 3)];
        }
    }
}

/// Weights (128ths) of four vertices for the points that are drawn between the second and the third of them, at details 0 to 3: a
/// Catmull-Rom spline.
const FINE: [&[[i32; 4]]; 4] = [
    &[],
    &[[-8, 72, 72, -8]],
    &[[-9, 111, 29, -3], [-8, 72, 72, -8], [-3, 29, 111, -9]],
    &[[-9, 111, 29, -3], [-8, 72, 72, -8], [-3, 29, 111, -9]],
];

/// A vertex on the display.
#[derive(Clone, Copy)]
pub(crate) struct ScreenVertex {
    at: [i16; 2],
    facing: i8,
}

impl ScreenVertex {
    /// The point where the line to `other` ends, which faces away.
    fn cut(self, other: ScreenVertex) -> [i16; 2] {
        let part = zero_crossing(i32::from(self.facing) - i32::from(GRAZING), i32::from(other.facing) - i32::from(GRAZING));
        between(self.at, other.at, part)
    }
}

/// A point between the second and the third vertex.
fn blend(ends: [ScreenVertex; 4], weights: &[i32; 4]) -> ScreenVertex {
    let at = core::array::from_fn(|axis| {
        let sum = ends.iter().zip(weights).fold(64, |sum, (end, weight)| sum + i32::from(end.at[axis]) * weight);
        (sum >> 7) as i16
    });
    let [_, from, to, _] = ends;
    let (a, b) = (i32::from(from.facing), i32::from(to.facing));
    // Linear between the two: at a quarter, half or three quarters, which the second weight shows.
    let quarters = if weights[1] > weights[2] { 1 } else { 3 - i32::from(weights[1] == weights[2]) };
    ScreenVertex { at, facing: (a + (((b - a) * quarters) >> 2)) as i8 }
}

/// Draws the part of a line that faces the camera.
#[cfg_attr(not(target_arch = "wasm32"), inline(always))]
fn visible(from: ScreenVertex, to: ScreenVertex, out: &mut impl StrokeSink) {
    match (from.facing > GRAZING, to.facing > GRAZING) {
        (true, true) => out.line(from.at, to.at),
        (true, false) => out.line(from.at, from.cut(to)),
        (false, true) => out.line(to.at, to.cut(from)),
        (false, false) => {}
    }
}
