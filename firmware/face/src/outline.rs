//! The outline: where the surface turns away, a line through each triangle with corners on both sides.

use crate::model::Model;
use crate::strokes::{Screen, line};
use heapless::Vec;
use pantin_figure::lines::Line;

/// Brightness.
const SHADE: u8 = 200;
/// Most triangles that are kept from frame to frame: what is beyond is looked for in each frame.
const KEPT: usize = 96;

/// The triangles that make the outline, as long as the head keeps its turn.
#[derive(Clone, Debug, Default)]
pub(crate) struct Outline {
    /// The corner that is alone on its side, and the two others.
    triangles: Vec<[u16; 3], KEPT>,
    overflown: bool,
}

impl Outline {
    /// Finds them.
    #[inline(never)]
    pub fn of(&mut self, model: &Model, facing: &[i8]) {
        self.triangles.clear();
        self.overflown = false;
        each_crossed(model, facing, |corners| self.overflown |= self.triangles.push(corners).is_err());
    }

    /// Draws them.
    #[inline]
    pub fn lines(&self, model: &Model, screen: Screen, out: &mut impl FnMut(Line)) {
        let mut draw = |[apex, one, other]: [u16; 3]| {
            let [from, to] = screen.crossings(apex, [one, other]);
            out(line(from, to, SHADE));
        };
        if self.overflown {
            each_crossed(model, screen.facing, draw);
        } else {
            self.triangles.iter().for_each(|&corners| draw(corners));
        }
    }
}

#[inline(always)]
fn each_crossed(model: &Model, facing: &[i8], mut visit: impl FnMut([u16; 3])) {
    let of = |index: u16| facing.get(usize::from(index)).copied().unwrap_or(0);
    each_triangle(model, model.outline(), |[x, y, z]| {
        let (a, b, c) = (of(x), of(y), of(z));
        // Most triangles have all corners on one side: no two signs differ.
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

/// The first `most` triangles of the stored half, and their mirror images.
#[inline(always)]
pub(crate) fn each_triangle(model: &Model, most: usize, mut visit: impl FnMut([u16; 3])) {
    let (image, halves) = (model.image(), model.pairs() > 0);
    let mut both = |a: u16, b: u16, c: u16| {
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
