//! The figure of one frame as lines on the display, in the order in which they are drawn.

use crate::camera::{Camera, PIXEL_BITS, Projected};
use crate::ink::Tone;
use crate::kinematics::Kinematics;
use crate::rotation::{Turning, Vector};
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
    /// What it is of.
    pub tone: Tone,
    /// Pixels across.
    pub width: u8,
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
    pub const NEW: Self = Lines { ground: Vec::new(), bones: Vec::new(), order: Vec::new(), head: None };

    /// Lines of the ground about the target.
    #[inline(never)]
    pub fn lay_ground(&mut self, ground: &Ground, camera: &Camera, target: Vector) {
        self.ground.clear();
        let spacing = 1 << ground.spacing;
        let axes = [(ground.axis + 1) % 3, (ground.axis + 2) % 3];
        // From the target to the corner before the line that is nearest to it.
        let mut corner = [0; 3];
        corner[ground.axis] = ground.height.wrapping_sub(target[ground.axis]);
        let mut steps = [[0; 3]; 2];
        for (axis, step) in axes.into_iter().zip(&mut steps) {
            let past = target[axis].wrapping_add(spacing / 2) & (spacing - 1);
            corner[axis] = spacing / 2 - past - (GROUND_ROWS / 2) * spacing;
            step[axis] = spacing;
        }
        let lattice = camera.lattice(corner, steps);
        for row in 0..GROUND_ROWS {
            for ends in [[[0, row], [GROUND_ROWS - 1, row]], [[row, 0], [row, GROUND_ROWS - 1]]] {
                let [from, to] = ends.map(|end| camera.project_lattice(&lattice, end));
                let depth = (from.depth + to.depth) >> 1;
                let shade = (GROUND_SHADE - (depth >> 9)).clamp(24, 56) as u8;
                let line = Line { from: from.place(), to: to.place(), depth: narrow(depth), shade, tone: Tone::Ground, width: 1 };
                // There is room for all rows.
                let _ = self.ground.push(line);
            }
        }
    }

    /// Lines of the bones and the head.
    #[inline(never)]
    pub fn lay_bones<R: Turning>(&mut self, skeleton: &Skeleton<N>, joints: &Kinematics<N, R>, camera: &Camera, target: Vector) {
        self.bones.clear();
        self.head = None;
        let breadth = camera.breadth();
        let mut ends: Vec<([i16; 2], i16), N> = Vec::new();
        for (bone, &position) in skeleton.bones.iter().zip(joints.positions()) {
            let end = camera.project(target, position);
            let (place, far) = (end.place(), narrow(end.depth));
            // One a bone: there is room.
            let _ = ends.push((place, far));
            let Some(&(start, near)) = bone.parent.and_then(|parent| ends.get(usize::from(parent))) else { continue };
            let depth = (i32::from(near) + end.depth) >> 1;
            match bone.part {
                Part::Hidden => {}
                Part::Bone => {
                    // Near limbs are thicker: half as thick again at a quarter of the camera's distance.
                    let width = ((breadth - (breadth * depth >> 14)) >> PIXEL_BITS).clamp(1, 9) as u8;
                    let line = Line { from: start, to: place, depth: narrow(depth), shade: shade(depth), tone: bone.tone, width };
                    let _ = self.bones.push(line);
                }
                Part::Crown => {
                    let radius = (camera.length(skeleton.head_radius) * end.magnification) >> 14;
                    let centre = [0, 1].map(|axis| ((i32::from(start[axis]) + i32::from(place[axis])) >> 1) as i16);
                    self.head = Some(Head { centre, radius: narrow(radius), shade: shade(depth) });
                }
            }
        }
        self.sort();
    }

    /// Puts the farthest first. The order of the frame before is nearly right; lines as far as each other keep that of the
    /// skeleton, so that the outcome is the frame's alone.
    fn sort(&mut self) {
        if self.order.len() != self.bones.len() {
            self.order.clear();
            // One a bone: there is room.
            self.order.extend((0..self.bones.len()).map(|index| index as u8));
        }
        let bones = &self.bones;
        let key = |index: u8| bones.get(usize::from(index)).map_or(0, |line| i32::from(line.depth) * 256 - i32::from(index));
        for place in 1..self.order.len() {
            let mut place = place;
            while let Some([before, here]) = self.order.get_mut(place.wrapping_sub(1)..=place)
                && key(*before) < key(*here)
            {
                core::mem::swap(before, here);
                place -= 1;
            }
        }
    }

    /// Bones in the order in which they are drawn: from far to near.
    pub fn far_to_near(&self) -> impl Iterator<Item = &Line> {
        self.order.iter().filter_map(|&index| self.bones.get(usize::from(index)))
    }
}

impl Projected {
    /// Its place on the display; farther than any display cut off.
    fn place(&self) -> [i16; 2] {
        [narrow(self.x), narrow(self.y)]
    }
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
