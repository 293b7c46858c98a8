//! The figure of one frame as lines on the display, in the order in which they are drawn.

use crate::camera::{Camera, PIXEL_BITS, Projected};
use crate::kinematics::Kinematics;
use crate::rotation::Vector;
use crate::skeleton::{Part, Skeleton};
use heapless::Vec;

/// A line on the display, in sixteenths of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line {
    /// One end: x, y.
    pub from: [i16; 2],
    /// The other end.
    pub to: [i16; 2],
    /// Depth of its middle, in 2^-15 of the camera's distance.
    pub depth: i16,
    /// Brightness: 255 is nearest.
    pub shade: u8,
}

/// The head: a circle, in sixteenths of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Head {
    /// Its middle: x, y.
    pub centre: [i16; 2],
    /// Its radius.
    pub radius: i16,
    /// Brightness.
    pub shade: u8,
}

/// Everything that is drawn for a frame.
#[derive(Clone, Debug, Default)]
pub struct Lines<const N: usize> {
    /// The ground.
    pub ground: Vec<Line, GROUND_LINES>,
    /// Bones, in no order.
    pub bones: Vec<Line, N>,
    /// Indices of the bones, the farthest first.
    pub order: Vec<u8, N>,
    /// The head, for a rig that names one.
    pub head: Option<Head>,
}

/// Lines of the ground along each axis, and both ways.
const GROUND_ROWS: i32 = 5;
const GROUND_LINES: usize = 2 * GROUND_ROWS as usize;
/// Brightness of the ground at the target's distance.
const GROUND_SHADE: i32 = 40;

/// The ground: a grid that stays in its place while the camera moves on.
#[derive(Clone, Copy, Debug)]
pub struct Ground {
    /// The vertical axis.
    pub axis: usize,
    /// Its height along that axis.
    pub height: i32,
    /// Between lines: 2^spacing figure units.
    pub spacing: u32,
}

impl<const N: usize> Lines<N> {
    /// Nothing to draw yet.
    pub const fn new() -> Self {
        Lines { ground: Vec::new(), bones: Vec::new(), order: Vec::new(), head: None }
    }

    /// Lines of the ground about the target.
    pub fn lay_ground(&mut self, ground: &Ground, camera: &Camera, target: Vector) {
        self.ground.clear();
        let half = (GROUND_ROWS / 2) << ground.spacing;
        // The line nearest to the target.
        let middle = target.map(|x| (x.wrapping_add(1 << (ground.spacing - 1)) >> ground.spacing) << ground.spacing);
        for (along, across) in [((ground.axis + 1) % 3, (ground.axis + 2) % 3), ((ground.axis + 2) % 3, (ground.axis + 1) % 3)] {
            for row in 0..GROUND_ROWS {
                let mut ends = [[0; 3]; 2];
                for (end, reach) in ends.iter_mut().zip([-half, half]) {
                    end[ground.axis] = ground.height;
                    end[along] = middle[along].wrapping_add(reach);
                    end[across] = middle[across].wrapping_add((row << ground.spacing) - half);
                }
                let [from, to] = ends.map(|end| camera.project(target, end));
                let depth = (from.depth + to.depth) / 2;
                let shade = (GROUND_SHADE - (depth >> 9)).clamp(24, 56) as u8;
                // There is room for all rows.
                let _ = self.ground.push(line(from, to, depth, shade));
            }
        }
    }

    /// Lines of the bones and the head.
    pub fn lay_bones(&mut self, skeleton: &Skeleton<N>, joints: &Kinematics<N>, camera: &Camera, target: Vector) {
        self.bones.clear();
        self.order.clear();
        self.head = None;
        let mut projected: Vec<Projected, N> = Vec::new();
        for (bone, joint) in skeleton.bones.iter().zip(joints.joints()) {
            let end = camera.project(target, joint.position);
            // One a bone: there is room.
            let _ = projected.push(end);
            let Some(start) = bone.parent.and_then(|parent| projected.get(usize::from(parent))) else { continue };
            let depth = (start.depth + end.depth) / 2;
            match bone.part {
                Part::Hidden => {}
                Part::Bone => self.insert(line(*start, end, depth, shade(depth))),
                Part::Crown => {
                    let radius = (camera.length(skeleton.head_radius) * end.magnification) >> 14;
                    let centre = [middle(start.x, end.x), middle(start.y, end.y)];
                    self.head = Some(Head { centre, radius: narrow(radius), shade: shade(depth) });
                }
            }
        }
    }

    /// Adds a line, and its index after those of lines that are farther.
    fn insert(&mut self, line: Line) {
        let mut place = self.bones.len();
        // At most one line a bone: there is room.
        let _ = self.order.push(place as u8);
        let _ = self.bones.push(line);
        let depth = |index: u8| self.bones.get(usize::from(index)).map_or(0, |line| line.depth);
        while let Some([before, here]) = self.order.get_mut(place.wrapping_sub(1)..=place)
            && depth(*before) < line.depth
        {
            core::mem::swap(before, here);
            place -= 1;
        }
    }

    /// Bones in the order in which they are drawn: from far to near.
    pub fn far_to_near(&self) -> impl Iterator<Item = &Line> {
        self.order.iter().filter_map(|&index| self.bones.get(usize::from(index)))
    }
}

fn line(from: Projected, to: Projected, depth: i32, shade: u8) -> Line {
    Line { from: [narrow(from.x), narrow(from.y)], to: [narrow(to.x), narrow(to.y)], depth: narrow(depth), shade }
}

fn middle(a: i32, b: i32) -> i16 {
    narrow((a + b) / 2)
}

fn narrow(x: i32) -> i16 {
    x.clamp(i32::from(i16::MIN), i32::from(i16::MAX)) as i16
}

/// Brightness by depth: a quarter of the figure's size (2^11) nearer or farther is a third of the scale.
fn shade(depth: i32) -> u8 {
    (176 - ((depth * 5) >> 7)).clamp(80, 255) as u8
}

/// The pixel that a sixteenth belongs to.
pub const fn pixel(sixteenths: i16) -> i32 {
    (sixteenths as i32) >> PIXEL_BITS
}
