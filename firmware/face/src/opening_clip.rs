//! Clips what lies behind lids and lips: irises, teeth and the tongue are drawn no farther than the edges of their opening.

use crate::bytes::{Bytes, each_index, indices};
use crate::model::Model;
use crate::opening::Opening;
use crate::vertex::Vertex;
use crate::weights::Weights;
use heapless::Vec;

/// Moves the members of all openings between the edges of their opening.
#[inline(never)]
pub(crate) fn clip_members(model: &Model, vertices: &mut [Vertex], weights: &Weights) {
    let mut bytes = Bytes(model.openings);
    let wide = model.wide;
    while let Ok(opening) = Opening::parse(&mut bytes, wide) {
        let released = weights.get(usize::from(opening.release))[0].max(0);
        let drop = (i32::from(opening.drop) * released) >> 15;
        for mirrored in [false, true] {
            if mirrored && !opening.mirrored {
                break;
            }
            let image = |index| usize::from(if mirrored { model.mirror(index) } else { index });
            let (mut upper, mut lower) = (Edge::EMPTY, Edge::EMPTY);
            each_index(opening.upper, wide, |index| upper.add(vertices, image(index)));
            each_index(opening.lower, wide, |index| lower.add(vertices, image(index)));
            let (above, below) = (upper.inner(), lower.inner());
            let [least, most] = upper.ends(&above);
            indices(opening.members, wide).for_each(|index| {
                let Some(vertex) = vertices.get_mut(image(index)) else { return };
                let (x, mut y) = (i32::from(vertex[0]).max(least).min(most), i32::from(vertex[1]));
                if !above.holds(x) || y > above.lowest {
                    y = y.min(upper.height(x));
                }
                if !below.holds(x) || y < below.highest {
                    y = y.max(lower.height(x) - drop);
                }
                *vertex = [x as i16, y as i16, vertex[2]];
            });
        }
    }
}

/// Maximum number of vertices of an edge; further ones are ignored.
const EDGE: usize = 10;

/// A row of vertices from one corner to the other.
struct Edge {
    vertices: Vec<[i16; 2], EDGE>,
}

impl Edge {
    const EMPTY: Edge = Edge { vertices: Vec::new() };

    #[cfg_attr(not(target_arch = "wasm32"), inline(always))]
    fn add(&mut self, vertices: &[Vertex], index: usize) {
        let Some(&[x, y, _]) = vertices.get(index) else { return };
        let _ = self.vertices.push([x, y]);
    }

    /// The least and the greatest x of all vertices, given the extent of those between the corners.
    #[inline(always)]
    fn ends(&self, inner: &Inner) -> [i32; 2] {
        let corners = [self.vertices.first(), self.vertices.last()];
        let corners = corners.into_iter().flatten().map(|corner| i32::from(corner[0]));
        corners.fold([inner.least, inner.most], |[least, most], x| [least.min(x), most.max(x)])
    }

    /// The extent of the vertices between the corners.
    #[cfg_attr(not(target_arch = "wasm32"), inline(always))]
    fn inner(&self) -> Inner {
        let mut inner = Inner { least: i32::MAX, most: i32::MIN, lowest: i32::MAX, highest: i32::MIN };
        let corners = self.vertices.len().saturating_sub(1);
        for &[x, y] in self.vertices.get(1..corners).unwrap_or(&[]) {
            let (x, y) = (i32::from(x), i32::from(y));
            inner = Inner {
                least: inner.least.min(x),
                most: inner.most.max(x),
                lowest: inner.lowest.min(y),
                highest: inner.highest.max(y),
            };
        }
        inner
    }

    /// The edge's height at `x`, which lies between the corners.
    fn height(&self, x: i32) -> i32 {
        for pair in self.vertices.windows(2) {
            let &[from, to] = pair else { continue };
            if i32::from(from[0].min(to[0])) <= x && x <= i32::from(from[0].max(to[0])) {
                return height_between(from, to, x);
            }
        }
        self.vertices.last().map_or(0, |last| last[1].into())
    }
}

/// The extent of an edge's vertices between its corners. A member within it that lies on the inner side of all of them does not need the
/// edge's height.
struct Inner {
    least: i32,
    most: i32,
    lowest: i32,
    highest: i32,
}

impl Inner {
    #[inline(always)]
    fn holds(&self, x: i32) -> bool {
        self.least <= x && x <= self.most
    }
}

/// The height at `x` between two vertices, by bisection: within 1/32 of the distance between them.
#[inline(always)]
fn height_between(from: [i16; 2], to: [i16; 2], x: i32) -> i32 {
    let (from, to) = if from[0] <= to[0] { (from, to) } else { (to, from) };
    let (from, to) = ([i32::from(from[0]), i32::from(from[1])], [i32::from(to[0]), i32::from(to[1])]);
    let [[_, a], [_, b]] = bisect(bisect(bisect(bisect([from, to], x), x), x), x);
    (a + b) >> 1
}

/// The half that includes `x`.
#[inline(always)]
fn bisect([from, to]: [[i32; 2]; 2], x: i32) -> [[i32; 2]; 2] {
    let middle = [(from[0] + to[0]) >> 1, (from[1] + to[1]) >> 1];
    if x <= middle[0] { [from, middle] } else { [middle, to] }
}
