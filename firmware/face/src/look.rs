//! A face before its camera: vertices on the display, what looks away, and the lines that are left.

use crate::bytes::Bytes;
use crate::curve::Curve;
use crate::model::Model;
use crate::morph::Morph;
use heapless::Vec;
use pantin_figure::Canvas;
use pantin_figure::camera::PIXEL_BITS;
use pantin_figure::lines::Line;
use pantin_figure::rotation::{Rotation, Vector};
use pantin_figure::trig::FRACTION_BITS;

/// From where a face is seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct View {
    /// Degrees about the vertical: 0 looks the face in the eyes, 90 sees it look to the left.
    pub orbit: i16,
    /// Degrees above the horizon.
    pub tilt: i16,
}

/// A camera and what it sees.
#[derive(Clone, Debug)]
pub struct Look<const N: usize> {
    canvas: Canvas,
    /// Right, up and towards the camera, Q15.
    rows: [Vector; 3],
    /// Places times Q15 rows times this, a Q14, are sixteenths of a pixel after `shift`.
    scale: i32,
    shift: u32,
    /// What stands in the middle of the display.
    middle: Vector,
    /// Magnification a step towards the camera, Q28: at most 2^14.
    nearer: i32,
    detail: u8,
    /// Sixteenths of a pixel.
    points: Vec<[i16; 2], N>,
    /// Cosine of the angle between a vertex's normal and the way to the camera, 127 is 1.
    facing: Vec<i8, N>,
}

/// The display's height is 64 of these parts, the face's down to the end of its neck so many: that end may leave the display.
const FILLED: i32 = 65;
/// Parts above it.
const ABOVE: i32 = 1;
/// Pixels of the face's height from which on more is drawn.
const DETAILS: [i32; 3] = [96, 150, 190];
/// Brightness of the mesh and of the outline.
const MESH: u8 = 44;
const OUTLINE: u8 = 200;
/// Curves end where they turn away by more than this, in 127ths.
const GRAZING: i8 = 4;
/// The camera is so many times the face's height away, as a power of two.
const DISTANCE_BITS: u32 = 2;

impl<const N: usize> Look<N> {
    /// A camera for a display.
    pub fn new(model: &Model, canvas: Canvas, view: View) -> Self {
        let (mut low, mut high) = ([i32::MAX; 3], [i32::MIN; 3]);
        for point in model.points.as_chunks::<6>().0 {
            for ((low, high), x) in low.iter_mut().zip(&mut high).zip(crate::morph::coordinates(*point)) {
                *low = (*low).min(i32::from(x));
                *high = (*high).max(i32::from(x));
            }
        }
        let (height, width) = (high[1].wrapping_sub(low[1]).max(1), high[0].max(low[0].wrapping_neg()).wrapping_mul(2).max(1));
        let rows = (i32::from(canvas.height) << PIXEL_BITS) * FILLED / 64;
        let columns = i32::from(canvas.width) << PIXEL_BITS;
        // Sixteenths of a pixel a step, Q16, by whichever side is tighter; steps number at least 1, canvases at most 2^15 sixteenths.
        let fit = |room: i32, size: i32| ((room << 14) / size) << 2;
        let scale = fit(rows.min(1 << 16), height).min(fit(columns.min(1 << 16), width)).clamp(1, 1 << 20);
        let shift = (32 - scale.leading_zeros()).saturating_sub(15);
        let covered = ((height >> 4) * (scale >> 4)) >> (8 + PIXEL_BITS);
        let detail = DETAILS.iter().filter(|&&least| covered >= least).count() as u8;
        let middle = core::array::from_fn(|axis| if axis == 1 { high[1] - height / FILLED * (32 - ABOVE) } else { 0 });
        let nearer = ((1 << 28) / (height << DISTANCE_BITS)).min(1 << 14);
        let mut look = Look {
            canvas,
            nearer,
            rows: [[0; 3]; 3],
            scale: scale >> shift,
            shift: 16 - shift,
            middle,
            detail,
            points: Vec::new(),
            facing: Vec::new(),
        };
        look.aim(view);
        look
    }

    /// Looks from elsewhere.
    pub fn aim(&mut self, view: View) {
        let mut turned = Rotation::IDENTITY;
        turned.turn(0, of_degrees(view.tilt));
        turned.turn(1, of_degrees(-view.orbit));
        let [x, y, z] = turned.0;
        self.rows = core::array::from_fn(|row| [x[row], y[row], z[row]]);
    }

    /// Puts the vertices on the display.
    pub fn project(&mut self, model: &Model, morph: &Morph<N>) {
        let [x, y, z] = morph.head;
        let mut head = Rotation::IDENTITY;
        for (axis, angle) in [(1, y), (0, x), (2, z)] {
            head.turn(axis, angle);
        }
        let pivot = morph.pivot.map(i32::from);
        let carried = head.apply_any(pivot);
        let offset: Vector = core::array::from_fn(|axis| pivot[axis] - carried[axis] - self.middle[axis]);
        let whole = Seen::new(self, &head, offset);
        let still = Seen::new(self, &Rotation::IDENTITY, self.middle.map(|x| -x));
        self.points.clear();
        self.facing.clear();
        // There is room: a morph holds no more vertices.
        self.points.extend(morph.places.iter().map(|&place| whole.point(place)));
        let [a, b, c] = whole.towards;
        let stored = || model.normals.as_chunks::<3>().0.iter().map(|normal| normal.map(|x| i32::from(x as i8)));
        let cosine = |x: i32, y: i32, z: i32| ((a * x + b * y + c * z) >> 15).clamp(-127, 127) as i8;
        self.facing.extend(stored().take(N).map(|[x, y, z]| cosine(x, y, z)));
        let room = N - self.facing.len();
        self.facing.extend(stored().skip(model.middles()).take(room).map(|[x, y, z]| cosine(-x, y, z)));
        let mut fixed = Bytes(model.fixed);
        while let Ok(index) = fixed.index(model.wide) {
            if let (Some(point), Some(&place)) = (self.points.get_mut(usize::from(index)), morph.places.get(usize::from(index))) {
                *point = still.point(place);
            }
        }
    }

    /// The places of the vertices on the display, in sixteenths of a pixel.
    pub fn points(&self) -> &[[i16; 2]] {
        &self.points
    }

    /// Gives the lines of the face, the brighter ones after the darker ones.
    pub fn lines(&self, model: &Model, mut out: impl FnMut(Line)) {
        if self.detail as usize >= DETAILS.len() {
            self.mesh(model, &mut out);
        }
        self.outline(model, &mut out);
        for curve in model.curves().filter(|curve| curve.detail <= self.detail) {
            self.curve(model, &curve, false, &mut out);
            if curve.mirrored {
                self.curve(model, &curve, true, &mut out);
            }
        }
    }

    #[inline(always)]
    fn end(&self, index: u16) -> End {
        let index = usize::from(index);
        End { at: self.points.get(index).copied().unwrap_or_default(), facing: self.facing.get(index).copied().unwrap_or(-127) }
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
        each_triangle(model, model.outline(), |corners| {
            let facing = corners.map(|index| self.facing.get(usize::from(index)).copied().unwrap_or(0));
            let away = facing.map(|x| x < 0);
            if away[0] == away[1] && away[1] == away[2] {
                return;
            }
            // The corner that is alone on its side.
            let apex = if away[0] == away[1] {
                2
            } else if away[0] == away[2] {
                1
            } else {
                0
            };
            let [apex, other, third] =
                [apex, (apex + 1) % 3, (apex + 2) % 3].map(|corner| self.end(corners.get(corner).copied().unwrap_or(0)));
            out(line(apex.towards(other, 0), apex.towards(third, 0), OUTLINE));
        });
    }

    fn curve(&self, model: &Model, curve: &Curve, mirrored: bool, out: &mut impl FnMut(Line)) {
        let len = curve.len();
        let end = |place: usize| {
            let index = curve.vertex(place);
            self.end(if mirrored { model.mirror(index) } else { index })
        };
        let at = |place: usize| end(if place >= len { place - len } else { place });
        let fine: &[[i32; 4]] = if curve.straight { &[] } else { FINE.get(usize::from(self.detail)).copied().unwrap_or(&[]) };
        let segments = if curve.closed { len } else { len - 1 };
        for segment in 0..segments {
            let (from, to) = (at(segment), at(segment + 1));
            if from.facing <= GRAZING && to.facing <= GRAZING {
                continue;
            }
            let before = if curve.closed { at(segment + len - 1) } else { end(segment.saturating_sub(1)) };
            let after = if curve.closed { at((segment + 2) % len) } else { end((segment + 2).min(len - 1)) };
            let mut last = from;
            for weights in fine {
                let next = from.blend([before, from, to, after], weights, to);
                visible(last, next, curve.shade, out);
                last = next;
            }
            visible(last, to, curve.shade, out);
        }
    }
}

/// Weights (128ths) of four vertices at the places between the second and the third of them that are drawn too.
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
        // Q15 times at most 2^8; the way is Q8.
        let way = (from.abs() * RECIPROCALS.get((from - to).unsigned_abs() as usize).map_or(0, |&x| i32::from(x))) >> 7;
        core::array::from_fn(|axis| {
            let (a, b) = (i32::from(self.at[axis]), i32::from(other.at[axis]));
            (a + (((b - a) * way) >> 8)) as i16
        })
    }

    fn blend(self, ends: [End; 4], weights: &[i32; 4], to: End) -> End {
        let at = core::array::from_fn(|axis| {
            let sum = ends.iter().zip(weights).fold(64, |sum, (end, weight)| sum + i32::from(end.at[axis]) * weight);
            (sum >> 7) as i16
        });
        let facing = (i32::from(self.facing) * weights[1] + i32::from(to.facing) * weights[2]) / (weights[1] + weights[2]);
        End { at, facing: facing as i8 }
    }
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
fn visible(from: End, to: End, shade: u8, out: &mut impl FnMut(Line)) {
    match (from.facing > GRAZING, to.facing > GRAZING) {
        (true, true) => out(line(from.at, to.at, shade)),
        (true, false) => out(line(from.at, from.towards(to, GRAZING), shade)),
        (false, true) => out(line(to.at, to.towards(from, GRAZING), shade)),
        (false, false) => {}
    }
}

fn line(from: [i16; 2], to: [i16; 2], shade: u8) -> Line {
    Line { from, to, depth: 0, shade }
}

/// The first `most` triangles of the stored half, and their mirror images.
fn each_triangle(model: &Model, most: usize, mut visit: impl FnMut([u16; 3])) {
    let mut bytes = Bytes(model.triangles);
    for _ in 0..most {
        let corners = [(); 3].map(|()| bytes.index(model.wide));
        let [Ok(a), Ok(b), Ok(c)] = corners else { return };
        visit([a, b, c]);
        let image = [a, c, b].map(|index| model.mirror(index));
        if image[0] != a || image[1] != c || image[2] != b {
            visit(image);
        }
    }
}

/// Places in one orientation, before the camera.
struct Seen {
    /// Right, down: sixteenths of a pixel after `shift`.
    across: [Vector; 2],
    /// Of the display's middle, in sixteenths, and of what stands there.
    centre: [i32; 2],
    offset: [i32; 2],
    shift: u32,
    /// Towards the camera, Q15.
    towards: Vector,
    /// Magnification a step towards the camera, Q28.
    nearer: i32,
}

impl Seen {
    /// `offset` is added to places after `head` has turned them.
    fn new<const N: usize>(look: &Look<N>, head: &Rotation, offset: Vector) -> Seen {
        let [right, up, towards] = look.rows;
        let rows = [right, up.map(|x| -x)];
        // A row of length 1 in Q15 times a scale below 2^15.
        let scaled = |row: Vector| row.map(|x| (x * look.scale + (1 << 14)) >> 15);
        let moved = |row: Vector| {
            let along = scaled(row).into_iter().zip(offset).fold(0i32, |sum, (a, b)| sum.wrapping_add(a.wrapping_mul(b)));
            along.wrapping_add((1 << look.shift) >> 1)
        };
        Seen {
            across: rows.map(|row| scaled(row_times(row, head))),
            centre: [look.canvas.width, look.canvas.height].map(|pixels| i32::from(pixels) << PIXEL_BITS >> 1),
            offset: rows.map(moved),
            shift: look.shift,
            towards: row_times(towards, head),
            nearer: look.nearer,
        }
    }

    /// Rows are no longer than 2^15, places no farther than 2^15.8: sums stay below 2^31.
    #[inline(always)]
    fn point(&self, place: [i16; 3]) -> [i16; 2] {
        let [x, y, z] = place.map(i32::from);
        let along = |row: &Vector| row[0] * x + row[1] * y + row[2] * z;
        // Perspective, to the first order: 1 / (1 - z / d) is taken for 1 + z / d.
        let magnification = (1 << 12) + (((along(&self.towards) >> FRACTION_BITS) * self.nearer) >> 16);
        let on = |axis: usize| {
            let flat = along(&self.across[axis]).wrapping_add(self.offset[axis]) >> self.shift;
            (((sixteen_bits(flat) * magnification) >> 12) + self.centre[axis]) as i16
        };
        [on(0), on(1)]
    }
}

fn sixteen_bits(x: i32) -> i32 {
    x.clamp(i32::from(i16::MIN), i32::from(i16::MAX))
}

/// A row vector times a rotation.
fn row_times(row: Vector, rotation: &Rotation) -> Vector {
    rotation.0.map(|column| (row[0] * column[0] + row[1] * column[1] + row[2] * column[2] + (1 << 14)) >> 15)
}

/// Degrees in 2^-32 turns.
fn of_degrees(degrees: i16) -> i32 {
    i32::from(degrees).wrapping_mul(11_930_465)
}
