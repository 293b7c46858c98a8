//! The lines of a face: its outline, its curves, and on large displays its mesh; what looks away is left out.

use crate::curve::Curve;
use crate::model::Model;
use pantin_figure::ink::Tone;
use pantin_figure::lines::Line;

/// Brightness of the mesh and of the outline.
const MESH: u8 = 44;
const OUTLINE: u8 = 200;
/// The mesh is drawn from this detail on.
const MESH_DETAIL: u8 = 3;
/// Curves end where they turn away by more than this, in 127ths.
const GRAZING: i8 = 4;

/// Vertices on the display.
#[derive(Clone, Copy)]
pub(crate) struct Screen<'s> {
    pub points: &'s [[i16; 2]],
    pub facing: &'s [i8],
}

/// All lines, the brighter ones after the darker ones.
#[inline]
pub(crate) fn draw(model: &Model, screen: Screen, detail: u8, out: &mut impl FnMut(Line)) {
    if detail >= MESH_DETAIL {
        screen.mesh(model, out);
    }
    screen.outline(model, out);
    for curve in model.curves().filter(|curve| curve.detail <= detail) {
        let fine = if curve.straight { &[][..] } else { FINE.get(usize::from(detail)).copied().unwrap_or(&[]) };
        for mirrored in [false, true] {
            if mirrored && !curve.mirrored {
                break;
            }
            if fine.is_empty() {
                screen.straight(model, &curve, mirrored, out);
            } else {
                screen.smooth(model, &curve, mirrored, fine, out);
            }
        }
    }
}

impl Screen<'_> {
    #[inline(always)]
    fn facing(&self, index: u16) -> i8 {
        self.facing.get(usize::from(index)).copied().unwrap_or(-127)
    }

    #[inline(always)]
    fn end(&self, index: u16) -> End {
        End { at: self.points.get(usize::from(index)).copied().unwrap_or_default(), facing: self.facing(index) }
    }

    /// Edges between triangles that look here, each once: it runs the other way in its other triangle.
    fn mesh(&self, model: &Model, out: &mut impl FnMut(Line)) {
        each_triangle(model, usize::MAX, |corners| {
            let ends = corners.map(|index| self.end(index));
            if ends.iter().all(|end| end.facing <= GRAZING) {
                return;
            }
            for (from, to) in [(0, 1), (1, 2), (2, 0)] {
                if corners[from] < corners[to] {
                    visible(ends[from], ends[to], MESH, out);
                }
            }
        });
    }

    /// Where the surface turns away: a line through each triangle with corners on both sides.
    fn outline(&self, model: &Model, out: &mut impl FnMut(Line)) {
        each_triangle(
            model,
            model.outline(),
            #[inline(always)]
            |corners| {
                let [x, y, z] = corners;
                let (first, second, third) = (self.facing(x), self.facing(y), self.facing(z));
                // Most triangles have all corners on one side: no two signs differ.
                if (first ^ second) | (first ^ third) >= 0 {
                    return;
                }
                let (a, b, c) = (first < 0, second < 0, third < 0);
                // The corner that is alone on its side comes first.
                let (apex, one, other) = if a == b {
                    (z, x, y)
                } else if a == c {
                    (y, z, x)
                } else {
                    (x, y, z)
                };
                let [from, to] = self.crossings(apex, [one, other]);
                out(line(from, to, OUTLINE));
            },
        );
    }

    /// Where the two edges at an apex turn away.
    #[inline(never)]
    fn crossings(&self, apex: u16, [one, other]: [u16; 2]) -> [[i16; 2]; 2] {
        let apex = self.end(apex);
        [apex.towards(self.end(one), 0), apex.towards(self.end(other), 0)]
    }

    /// A curve with corners at its vertices.
    fn straight(&self, model: &Model, curve: &Curve, mirrored: bool, out: &mut impl FnMut(Line)) {
        let image = model.image();
        let end = |index| self.end(if mirrored { image.of(index) } else { index });
        let first = end(curve.vertex(0));
        let mut from = first;
        curve.each_further(|index| {
            let to = end(index);
            visible(from, to, curve.shade, out);
            from = to;
        });
        if curve.closed {
            visible(from, first, curve.shade, out);
        }
    }

    /// A curve that bends: between two vertices it goes on as those before and after them say.
    fn smooth(&self, model: &Model, curve: &Curve, mirrored: bool, fine: &[[i32; 4]], out: &mut impl FnMut(Line)) {
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
                    visible(last, next, curve.shade, out);
                    last = next;
                }
                visible(last, to, curve.shade, out);
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
struct End {
    at: [i16; 2],
    facing: i8,
}

impl End {
    /// Where the way to `other`, on the other side of `level`, crosses it.
    fn towards(self, other: End, level: i8) -> [i16; 2] {
        let (from, to) = (i32::from(self.facing) - i32::from(level), i32::from(other.facing) - i32::from(level));
        // At most 2^8 times 2^15; the way is Q8.
        let way = (from.abs() * RECIPROCALS.get((from - to).unsigned_abs() as usize).map_or(0, |&x| i32::from(x))) >> 7;
        core::array::from_fn(|axis| {
            let (a, b) = (i32::from(self.at[axis]), i32::from(other.at[axis]));
            (a + (((b - a) * way) >> 8)) as i16
        })
    }
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
        table[x] = ((1 << 15) / x) as u16;
        x += 1;
    }
    table
};

/// The part of a line that looks here.
#[inline(always)]
fn visible(from: End, to: End, shade: u8, out: &mut impl FnMut(Line)) {
    match (from.facing > GRAZING, to.facing > GRAZING) {
        (true, true) => out(line(from.at, to.at, shade)),
        (true, false) => out(line(from.at, from.towards(to, GRAZING), shade)),
        (false, true) => out(line(to.at, to.towards(from, GRAZING), shade)),
        (false, false) => {}
    }
}

fn line(from: [i16; 2], to: [i16; 2], shade: u8) -> Line {
    Line { from, to, depth: 0, shade, tone: Tone::Middle, width: 1 }
}

/// The first `most` triangles of the stored half, and their mirror images.
#[inline(always)]
fn each_triangle(model: &Model, most: usize, mut visit: impl FnMut([u16; 3])) {
    let image = model.image();
    let mut both = |a: u16, b: u16, c: u16| {
        visit([a, b, c]);
        // No triangle is its own image: one in the middle would be flat.
        visit([image.of(a), image.of(c), image.of(b)]);
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
