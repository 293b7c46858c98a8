//! Between the axes of a pose and those of the world.

use crate::root::{Heading, Placement};

/// How a figure stands. A point of the world is its two horizontal coordinates, in the order of [`Placement::place`], and its height.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    place: [i64; 2],
    there: Heading,
    back: Heading,
    up: usize,
}

impl Frame {
    pub(super) fn new(placement: Placement, up: usize) -> Frame {
        let there = Heading::new(placement.heading);
        Frame { place: placement.place, there, back: there.reverse(), up }
    }

    /// A point of the pose in the world.
    pub(super) fn to_world(self, point: [i32; 3]) -> [i64; 3] {
        let [flat, height] = [[(self.up + 1) % 3, (self.up + 2) % 3], [self.up; 2]]
            .map(|axes| axes.map(|axis| point.get(axis).copied().unwrap_or(0)));
        let ([a, b], [x, y]) = (self.there.rotate(flat), self.place);
        let [height, _] = height;
        [x.wrapping_add(a), y.wrapping_add(b), height.into()]
    }

    /// A way in the world, in the axes of the pose.
    pub(super) fn to_pose(self, [a, b, height]: [i32; 3]) -> [i32; 3] {
        let [a, b] = self.back.rotate([a, b]).map(|x| x as i32);
        let mut way = [0; 3];
        for (axis, value) in [(self.up + 1, a), (self.up + 2, b), (self.up, height)] {
            if let Some(own) = way.get_mut(axis % 3) {
                *own = value;
            }
        }
        way
    }
}
