//! The lines of a face: its outline, its curves, and on large displays its mesh; what looks away is left out.

use crate::curve::Curve;
use crate::model::Model;
use crate::outline::{Outline, each_triangle};
use crate::pen::Paint;
use crate::projection::UNSEEN;
use pantin_figure::trig::WORKED_OUT;

/// Brightness of the mesh.
const MESH: u8 = 44;
/// The mesh is drawn from this detail on.
const MESH_DETAIL: u8 = 3;
/// Curves end where they turn away by more than this, in 127ths.
const GRAZING: i8 = 4;

/// Vertices on the display.
#[derive(Clone, Copy)]
pub(crate) struct Screen<'s> {
    pub points: &'s [[i16; 2]],
    pub facing: &'s [i8],
    pub outline: &'s Outline,
}

/// All lines, the brighter ones after the darker ones.
#[inline]
pub(crate) fn draw(model: &Model, screen: Screen, detail: u8, out: &mut impl Paint) {
    if detail >= MESH_DETAIL {
        screen.mesh(model, out);
    }
    screen.outline.lines(model, screen, out);
    for curve in model.curves().filter(|curve| curve.drawn(detail)) {
        let fine = if curve.straight { &[][..] } else { FINE.get(usize::from(detail)).copied().unwrap_or(&[]) };
        for mirrored in [false, true] {
            if mirrored && !curve.mirrored {
                break;
            }
            out.begin(curve.shade);
            if fine.is_empty() {
                screen.straight(model, &curve, mirrored, out);
            } else {
                screen.smooth(model, &curve, mirrored, fine, out);
            }
            out.end();
        }
    }
}

/// Marks the vertices that no line needs, before the head turns on. Of large displays and wide models all are needed.
#[inline(never)]
pub(crate) fn leave_out(model: &Model, detail: u8, outline: &Outline, facing: &mut [i8]) {
    if detail >= MESH_DETAIL || model.wide || outline.overflown() {
        return;
    }
    // A bit a vertex: narrow models have at most 256.
    let mut needed = [0u32; 8];
    let mut need = |index: u16| needed[usize::from(index as u8 >> 5)] |= 1 << (index & 31);
    outline.corners(&mut need);
    for curve in model.curves().filter(|curve| curve.drawn(detail)) {
        for index in curve.vertices() {
            need(index);
            if curve.mirrored {
                need(model.mirror(index));
            }
        }
    }
    for (index, facing) in facing.iter_mut().enumerate() {
        if needed[(index >> 5) & 7] & 1 << (index & 31) == 0 {
            *facing = UNSEEN;
        }
    }
}

impl Screen<'_> {
    #[inline(always)]
    pub fn facing(&self, index: u16) -> i8 {
        self.facing.get(usize::from(index)).copied().unwrap_or(-127)
    }

    #[cfg_attr(not(target_arch = "wasm32"), inline(always))]
    pub fn end(&self, index: u16) -> End {
        End { at: self.points.get(usize::from(index)).copied().unwrap_or_default(), facing: self.facing(index) }
    }

    /// Edges between triangles that look here, each once: it runs the other way in its other triangle.
    fn mesh(&self, model: &Model, out: &mut impl Paint) {
        out.begin(MESH);
        each_triangle(
            model,
            usize::MAX,
            |_| true,
            |corners| {
                let ends = corners.map(|index| self.end(index));
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

    /// A curve with corners at its vertices.
    fn straight(&self, model: &Model, curve: &Curve, mirrored: bool, out: &mut impl Paint) {
        let image = model.image();
        let end = |index| self.end(if mirrored { image.of(index) } else { index });
        let first = end(curve.vertex(0));
        let mut from = first;
        for index in curve.vertices().skip(1) {
            let to = end(index);
            visible(from, to, out);
            from = to;
        }
        if curve.closed {
            visible(from, first, out);
        }
    }

    /// A curve that bends: between two vertices it goes on as those before and after them say.
    fn smooth(&self, model: &Model, curve: &Curve, mirrored: bool, fine: &[[i32; 4]], out: &mut impl Paint) {
        let len = curve.len();
        let at = |place: usize| {
            let place = match place {
                place if place < len => place,
                place if curve.closed => place - len,
                _ => len - 1,
            };
            let index = curve.vertex(place);
            self.end(if mirrored { model.mirror(index) } else { index })
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

/// Weights (128ths) of four vertices at the places between the second and the third of them that are drawn too: the cubic through
/// these two that leaves each along the way from its one neighbour to its other.
const FINE: [&[[i32; 4]]; 4] = [
    &[],
    &[[-8, 72, 72, -8]],
    &[[-9, 111, 29, -3], [-8, 72, 72, -8], [-3, 29, 111, -9]],
    &[[-9, 111, 29, -3], [-8, 72, 72, -8], [-3, 29, 111, -9]],
];

/// A vertex on the display.
#[derive(Clone, Copy)]
pub(crate) struct End {
    at: [i16; 2],
    facing: i8,
}

impl End {
    /// Where the way to `other`, on the other side of where curves end, crosses it.
    fn towards(self, other: End) -> [i16; 2] {
        between(self.at, other.at, way(i32::from(self.facing) - i32::from(GRAZING), i32::from(other.facing) - i32::from(GRAZING)))
    }
}

/// The part of the way, Q8, at which what is `from` here and `to` at its end passes 0: their signs differ, both are below 2^8.
#[inline]
pub(crate) fn way(from: i32, to: i32) -> i32 {
    let whole = (from - to).unsigned_abs() as usize;
    let reciprocal = if WORKED_OUT { reciprocal(whole) } else { RECIPROCALS.get(whole).copied().unwrap_or(0) };
    (from.abs() * i32::from(reciprocal)) >> 7
}

/// A place on the way from one to another, Q8.
#[inline(always)]
pub(crate) fn between(from: [i16; 2], to: [i16; 2], way: i32) -> [i16; 2] {
    let (x, y) = (i32::from(from[0]), i32::from(from[1]));
    let (across, down) = (i32::from(to[0]) - x, i32::from(to[1]) - y);
    [(x + ((across * way) >> 8)) as i16, (y + ((down * way) >> 8)) as i16]
}

/// A vertex between the second and the third; it looks where the nearer of them does.
fn blend(ends: [End; 4], weights: &[i32; 4]) -> End {
    let at = core::array::from_fn(|axis| {
        let sum = ends.iter().zip(weights).fold(64, |sum, (end, weight)| sum + i32::from(end.at[axis]) * weight);
        (sum >> 7) as i16
    });
    let [_, from, to, _] = ends;
    let (a, b) = (i32::from(from.facing), i32::from(to.facing));
    // In proportion to the way: a quarter, half or three quarters of it, which the second weight tells.
    let way = if weights[1] > weights[2] { 1 } else { 3 - i32::from(weights[1] == weights[2]) };
    End { at, facing: (a + (((b - a) * way) >> 2)) as i8 }
}

/// 2^15 over 1 to 255, and nothing over 0.
static RECIPROCALS: [u16; 256] = {
    let mut table = [0; 256];
    let mut x = 1;
    while x < 256 {
        table[x] = reciprocal(x);
        x += 1;
    }
    table
};

const fn reciprocal(x: usize) -> u16 {
    match (1usize << 15).checked_div(x) {
        Some(reciprocal) => reciprocal as u16,
        None => 0,
    }
}

/// The part of a line that looks here.
#[cfg_attr(not(target_arch = "wasm32"), inline(always))]
fn visible(from: End, to: End, out: &mut impl Paint) {
    match (from.facing > GRAZING, to.facing > GRAZING) {
        (true, true) => out.line(from.at, to.at),
        (true, false) => out.line(from.at, from.towards(to)),
        (false, true) => out.line(to.at, to.towards(from)),
        (false, false) => {}
    }
}
