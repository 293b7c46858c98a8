//! The outline: where the surface turns away, a line through each triangle with corners on both sides.

use crate::model::Model;
use crate::pen::Paint;
use crate::strokes::{Screen, between, way};
use heapless::Vec;

/// Brightness.
const SHADE: u8 = 200;
/// Most triangles that are kept from frame to frame: what is beyond is looked for in each frame.
const KEPT: usize = 48;
/// Lines after which is told what they cover: mirror images follow each other, so their rectangles are as wide as the face anyway.
const TOLD: usize = 2;

/// The triangles that make the outline, as long as the head keeps its turn.
#[derive(Clone, Debug)]
pub(crate) struct Outline {
    triangles: Vec<Crossed, KEPT>,
    overflown: bool,
}

/// A triangle that the outline crosses.
#[derive(Clone, Copy, Debug)]
struct Crossed {
    /// The corner that is alone on its side, and the two others.
    corners: [u16; 3],
    /// The part of the way to these, Q8, at which the surface turns away.
    ways: [u8; 2],
}

impl Crossed {
    #[inline]
    fn new(corners: [u16; 3], facing: &[i8]) -> Self {
        let of = |index: u16| i32::from(facing.get(usize::from(index)).copied().unwrap_or(0));
        let [apex, one, other] = corners;
        Crossed { corners, ways: [one, other].map(|index| way(of(apex), of(index)).min(255) as u8) }
    }

    #[cfg_attr(not(target_arch = "wasm32"), inline(always))]
    fn draw(&self, points: &[[i16; 2]], out: &mut impl Paint) {
        let at = |index: u16| points.get(usize::from(index)).copied().unwrap_or_default();
        let [apex, one, other] = self.corners;
        let apex = at(apex);
        out.line(between(apex, at(one), self.ways[0].into()), between(apex, at(other), self.ways[1].into()));
    }
}

impl Outline {
    /// None.
    pub const EMPTY: Outline = Outline { triangles: Vec::new(), overflown: false };

    /// Finds them.
    #[inline(never)]
    pub fn of(&mut self, model: &Model, facing: &[i8]) {
        self.triangles.clear();
        self.overflown = false;
        each_crossed(model, facing, &mut |corners| self.keep(corners, facing));
    }

    #[inline(never)]
    fn keep(&mut self, corners: [u16; 3], facing: &[i8]) {
        self.overflown |= self.triangles.push(Crossed::new(corners, facing)).is_err();
    }

    /// Whether there are more than are kept.
    pub fn overflown(&self) -> bool {
        self.overflown
    }

    /// The corners of those that are kept.
    pub fn corners(&self, mut visit: impl FnMut(u16)) {
        self.triangles.iter().flat_map(|crossed| crossed.corners).for_each(&mut visit);
    }

    /// Draws them.
    #[inline]
    pub fn lines(&self, model: &Model, screen: Screen, out: &mut impl Paint) {
        out.begin(SHADE);
        if self.overflown {
            all(model, screen, out);
        } else {
            // It goes all about the face: what it covers is told every few lines.
            for some in self.triangles.chunks(TOLD) {
                some.iter().for_each(|crossed| crossed.draw(screen.points, out));
                out.end();
            }
        }
    }
}

/// More than are kept. In a function of its own: what it needs of memory is seldom needed.
#[inline(never)]
fn all(model: &Model, screen: Screen, out: &mut impl Paint) {
    each_crossed(model, screen.facing, &mut |corners| {
        Crossed::new(corners, screen.facing).draw(screen.points, out);
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
        let [a, b, c] = [signs[usize::from(x) % SIGNS], signs[usize::from(y) % SIGNS], signs[usize::from(z) % SIGNS]];
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

/// Most stored vertices of which it is looked up whether they look away.
const SIGNS: usize = 128;

/// Which stored vertices look away (bit 0), and which of their images (bit 1); of no use for models that have more.
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

/// Of the first `most` triangles of the stored half those that are `wanted`, and their mirror images.
#[inline(always)]
pub(crate) fn each_triangle(model: &Model, most: usize, wanted: impl Fn([u16; 3]) -> bool, mut visit: impl FnMut([u16; 3])) {
    let (image, halves) = (model.image(), model.pairs() > 0);
    let mut both = |a: u16, b: u16, c: u16| {
        if !wanted([a, b, c]) {
            return;
        }
        visit([a, b, c]);
        // A model without halves has no images; otherwise no triangle is its own: one in the middle would be flat.
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
