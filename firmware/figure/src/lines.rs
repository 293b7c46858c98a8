//! What a frame is made of: lines and dots of the ground, lines of the bones, the head.

use crate::camera::{Camera, Canvas, MAGNIFICATION_BITS, PIXEL_BITS, Projected, magnification};
use crate::ink::BodyPart;
use crate::rotation::Vector;
use crate::skeleton::Bone;
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
    pub body_part: BodyPart,
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

/// A dot of the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dot {
    /// Where, in sixteenths of a pixel: x, y.
    pub place: [i16; 2],
    /// Brightness.
    pub shade: u8,
}

/// Everything that is drawn for a frame, gathered: for who draws it otherwise than [`FigureRenderer::draw_on`](crate::FigureRenderer::draw_on).
#[derive(Clone, Debug, Default)]
pub struct Lines<const N: usize> {
    /// The ground as a grid of lines, on a large display.
    pub ground: Vec<Line, GROUND_LINES>,
    /// The ground as dots, on a small one.
    pub dots: Vec<Dot, GROUND_DOTS>,
    /// Bones, from far to near.
    pub bones: Vec<Line, N>,
    /// The head, for a rig that names one.
    pub head: Option<Head>,
}

/// Lines of the ground along each axis, and both ways; dots along each.
const GROUND_ROWS: i32 = 5;
const GROUND_LINES: usize = 2 * GROUND_ROWS as usize;
const DOT_ROWS: i32 = 7;
const GROUND_DOTS: usize = (DOT_ROWS * DOT_ROWS) as usize;
/// Brightness of the ground's lines and of its dots at the target's distance.
const GROUND_SHADE: i32 = 40;
const DOT_SHADE: i32 = 112;

/// The ground: a grid that stays in its place while the camera moves on.
#[derive(Clone, Copy, Debug)]
pub struct Ground {
    /// The vertical axis.
    pub axis: usize,
    /// Its height along that axis.
    pub height: i32,
    /// Between lines, or dots: 2^spacing figure units.
    pub spacing: u32,
    /// Dots in place of lines.
    pub dotted: bool,
}

impl Ground {
    /// For a figure of `size` on a canvas: dots where lines would be most of the picture, an eighth to a quarter of the figure apart;
    /// lines are twice as far apart.
    pub(crate) fn new(axis: usize, height: i32, size: i32, canvas: Canvas) -> Ground {
        let dotted = u32::from(canvas.width) * u32::from(canvas.height) < 45_000;
        let finer = if dotted { 3 } else { 2 };
        Ground { axis, height, spacing: (32 - size.leading_zeros()).saturating_sub(finer).max(1), dotted }
    }

    /// In the camera's axes: the first of `rows` places both ways about the target, and the steps between them.
    fn lattice(&self, camera: &Camera, target: Vector, rows: i32) -> (Vector, [Vector; 2]) {
        let spacing = 1 << self.spacing;
        let mut corner = [0; 3];
        let axis = self.axis % 3;
        corner[axis] = self.height.wrapping_sub(target[axis]);
        let mut steps = [[0; 3]; 2];
        for (next, step) in (1..).zip(&mut steps) {
            let axis = (axis + next) % 3;
            let past = target[axis].wrapping_add(spacing / 2) & (spacing - 1);
            corner[axis] = spacing / 2 - past - (rows / 2) * spacing;
            step[axis] = spacing;
        }
        let view = camera.view();
        (view.apply_any(corner), steps.map(|step| view.apply_any(step)))
    }
}

impl Ground {
    /// Shows every line of the grid about the target.
    #[inline(always)]
    pub(crate) fn each_line(&self, camera: &Camera, target: Vector, mut show: impl FnMut(Line)) {
        let (corner, [a, b]) = self.lattice(camera, target, GROUND_ROWS);
        let last = |step: Vector| step.map(|x| x * (GROUND_ROWS - 1));
        for (start, step, across) in [(corner, a, last(b)), (corner, b, last(a))] {
            let mut start = start;
            for _ in 0..GROUND_ROWS {
                let from = camera.project(start);
                let to = camera.project(sum(start, across));
                let depth = (from.depth + to.depth) >> 1;
                let shade = (GROUND_SHADE - (depth >> 9)).clamp(24, 56) as u8;
                show(Line {
                    from: from.place(),
                    to: to.place(),
                    depth: narrow(depth),
                    shade,
                    body_part: BodyPart::Ground,
                    width: 1,
                });
                start = sum(start, step);
            }
        }
    }

    /// Shows every dot about the target.
    #[inline(always)]
    pub(crate) fn each_dot(&self, camera: &Camera, target: Vector, mut show: impl FnMut(Dot)) {
        let (mut row, [a, b]) = self.lattice(camera, target, DOT_ROWS);
        for index in 0..DOT_ROWS {
            // Without the corners: the longest way to a dot along the axes is one more than to the end of a middle row.
            let cut = ((index - DOT_ROWS / 2).abs() - 1).max(0);
            let mut place = sum(row, [a[0] * cut, a[1] * cut, a[2] * cut]);
            for _ in 2 * cut..DOT_ROWS {
                let dot = camera.project(place);
                let shade = (DOT_SHADE - (dot.depth >> 7)).clamp(32, 208) as u8;
                show(Dot { place: dot.place(), shade });
                place = sum(place, a);
            }
            row = sum(row, b);
        }
    }
}

impl Bone {
    /// The line from where the camera sees its parent to where it sees the joint.
    #[inline(always)]
    pub(crate) fn line(&self, from: Visible, to: Visible, camera: &Camera) -> Line {
        let depth = between(from, to);
        // Near limbs are thicker: half as thick again at a quarter of the camera's distance.
        let breadth = camera.breadth();
        let width = ((breadth - ((breadth * depth) >> 14)) >> PIXEL_BITS).clamp(1, 9) as u8;
        Line { from: from.place, to: to.place, depth: depth as i16, shade: shade(depth), body_part: self.body_part, width }
    }
}

impl Head {
    /// Between the head's joint and the crown.
    pub(crate) fn new(from: Visible, to: Visible, camera: &Camera, radius: i32) -> Head {
        let depth = between(from, to);
        let radius = (camera.length(radius) * magnification(to.depth.into())) >> MAGNIFICATION_BITS;
        let middle = |from: i16, to: i16| ((i32::from(from) + i32::from(to)) >> 1) as i16;
        let centre = [middle(from.place[0], to.place[0]), middle(from.place[1], to.place[1])];
        Head { centre, radius: narrow(radius), shade: shade(depth) }
    }
}

/// Depth of the middle.
#[inline(always)]
pub(crate) fn between(from: Visible, to: Visible) -> i32 {
    (i32::from(from.depth) + i32::from(to.depth)) >> 1
}

/// Where the camera sees a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Visible {
    /// Sixteenths of a pixel from the left and the top edge.
    pub place: [i16; 2],
    /// See [`Projected::depth`].
    pub depth: i16,
}

impl From<Projected> for Visible {
    #[inline(always)]
    fn from(projected: Projected) -> Visible {
        Visible { place: projected.place(), depth: narrow(projected.depth) }
    }
}

impl Projected {
    /// Its place on the display; farther than any display cut off.
    #[inline(always)]
    fn place(&self) -> [i16; 2] {
        [narrow(self.x), narrow(self.y)]
    }
}

#[inline(always)]
fn sum(a: Vector, b: Vector) -> Vector {
    [a[0].wrapping_add(b[0]), a[1].wrapping_add(b[1]), a[2].wrapping_add(b[2])]
}

#[inline(always)]
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
