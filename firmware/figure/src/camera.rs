//! A perspective camera in integers: no division a point, no product wider than 32 bits.

use crate::rotation::Vector;
use crate::survey::{Bearings, Survey, cross};
use crate::trig::{FRACTION_BITS, HALF, sin_cos};

/// Fraction bits of a pixel in projected places.
pub const PIXEL_BITS: u32 = 4;

/// Size of a display in pixels, each at most 2047.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Canvas {
    /// Columns.
    pub width: u16,
    /// Rows.
    pub height: u16,
}

/// What the camera looks at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Track {
    /// The hips, wherever they go; vertically it stands still as long as the clip stays within twice the figure.
    Follow,
    /// The middle of all that the clip covers.
    Fixed,
}

/// Where the camera stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct View {
    /// Degrees about the vertical: 0 looks the figure in the face, 90 sees it walk to the left, -90 to the right.
    pub orbit: i16,
    /// Degrees above the horizon.
    pub tilt: i16,
    /// What it looks at.
    pub track: Track,
    /// The axis that is vertical, in place of the one along which the figure has its head farthest from its feet: animals
    /// have it ahead.
    pub up: Option<u8>,
}

impl Default for View {
    fn default() -> Self {
        View { orbit: -50, tilt: 12, track: Track::Follow, up: None }
    }
}

/// A point on the display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Projected {
    /// Sixteenths of a pixel from the left edge.
    pub x: i32,
    /// Sixteenths of a pixel from the top edge.
    pub y: i32,
    /// Depth behind the target (positive is farther) in 2^-15 of the camera's distance.
    pub depth: i32,
    /// Magnification against a point at the target's distance, Q14.
    pub magnification: i32,
}

/// The distance of the camera from its target in sizes of the figure.
pub const DISTANCE: i32 = 4;
/// The same in units of depth: 2^15.
const DEPTH_BITS: u32 = 15;
/// Relative places are shifted to bring the size within 2^12 .. 2^13 and cut off to 16 bits, four sizes or more away: no
/// point is farther than 56 756 from the target then.
const SIZE_BITS: u32 = 13;
/// Longest row of the view's matrix, so that its product with such a point stays below 2^31.
const LONGEST_ROW: i32 = 37_000;

/// Projects places of the world.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    /// Right, down and away in world axes. The first two give sixteenths of a pixel after `shift`, the last depth after 14.
    rows: [Vector; 3],
    shift: u32,
    pre_shift: u32,
    /// Target's coordinates along the axes that the camera does not follow.
    fixed: [Option<i32>; 3],
    /// Where the target appears, in sixteenths of a pixel.
    centre: [i32; 2],
    /// Sixteenths of a pixel that a `size` at the target's distance takes.
    scale: i32,
    size: i32,
}

impl Camera {
    /// Sees everything in one place.
    pub(crate) const NOWHERE: Camera =
        Camera { rows: [[0; 3]; 3], shift: 0, pre_shift: 0, fixed: [None; 3], centre: [0; 2], scale: 1, size: 1 };

    /// A camera for what `survey` saw of a figure of `size`, with a size `scale` sixteenths of a pixel (at most 2^14) big and
    /// the target in the top left corner: [`Camera::show`] moves it to its place.
    pub fn new(survey: &Survey, bearings: Bearings, size: i32, view: View, scale: i32) -> Self {
        let middle = survey.middle();
        let climbs = survey.half_extent(bearings.axis) > size;
        let fixed = core::array::from_fn(|axis| match view.track {
            Track::Fixed => Some(middle[axis]),
            Track::Follow => (axis == bearings.axis && !climbs).then_some(middle[axis]),
        });
        let size = match view.track {
            Track::Follow => size,
            Track::Fixed => (0..3).fold(size, |size, axis| size.max(survey.half_extent(axis))),
        };
        let pre_shift = (32 - size.leading_zeros()).saturating_sub(SIZE_BITS);
        let mut camera = Camera { rows: axes(bearings, view), shift: 16, pre_shift, fixed, centre: [0; 2], scale, size };
        let size = (size >> pre_shift).max(1);
        while (scale << camera.shift) / size > LONGEST_ROW && camera.shift > 0 {
            camera.shift -= 1;
        }
        let across = (scale << camera.shift) / size;
        let away = (1 << (DEPTH_BITS + 14)) / (DISTANCE * size);
        for (row, length) in camera.rows.iter_mut().zip([across, across, away]) {
            *row = row.map(|x| (x * length + HALF) >> FRACTION_BITS);
        }
        camera
    }

    /// Puts the target at a place of the display, in sixteenths of a pixel.
    pub fn show(&mut self, x: i32, y: i32) {
        self.centre = [x, y];
    }

    /// Scale (sixteenths of a pixel a size at the target's distance), size in figure units, and where the target appears.
    pub fn framing(&self) -> (i32, i32, [i32; 2]) {
        (self.scale, self.size, self.centre)
    }

    /// The target for a frame whose hips are at `hips`.
    pub fn target(&self, hips: Vector) -> Vector {
        core::array::from_fn(|axis| self.fixed[axis].unwrap_or(hips[axis]))
    }

    /// Projects a place, with the camera on `target`.
    #[inline(always)]
    pub fn project(&self, target: Vector, place: Vector) -> Projected {
        self.magnify(self.turn(core::array::from_fn(|axis| place[axis].wrapping_sub(target[axis]))))
    }

    /// Places of a lattice about the target: its corner from there, and its steps. Everything is within two sizes of the target.
    pub(crate) fn lattice(&self, corner: Vector, steps: [Vector; 2]) -> Lattice {
        Lattice { corner: self.turn(corner), steps: steps.map(|step| self.turn(step)) }
    }

    /// Right, down and away, before the perspective.
    #[inline(always)]
    fn turn(&self, relative: Vector) -> Vector {
        let rounding = (1 << self.pre_shift) >> 1;
        let [u, v, w] = relative.map(|x| sixteen_bits(x.wrapping_add(rounding) >> self.pre_shift));
        self.rows.map(|row| row[0] * u + row[1] * v + row[2] * w)
    }

    /// The perspective.
    #[inline(always)]
    fn magnify(&self, [x, y, depth]: Vector) -> Projected {
        let depth = depth >> 14;
        let magnification = magnification(depth);
        // Within 2^15 sixteenths, magnified at most twice: products stay within 2^30.
        let [x, y] = [x, y].map(|x| (sixteen_bits(x >> self.shift) * magnification + (1 << 13)) >> 14);
        Projected { x: x + self.centre[0], y: y + self.centre[1], depth, magnification }
    }

    /// Projects a place of a lattice: so many steps of each kind, at most 8, from its corner.
    #[inline(always)]
    pub(crate) fn project_lattice(&self, lattice: &Lattice, steps: [i32; 2]) -> Projected {
        let Lattice { corner, steps: [a, b] } = lattice;
        self.magnify(core::array::from_fn(|axis| corner[axis] + steps[0] * a[axis] + steps[1] * b[axis]))
    }

    /// Sixteenths of a pixel that a limb at the target's distance is across: a 50th of the figure.
    pub fn breadth(&self) -> i32 {
        self.scale / 50
    }

    /// Sixteenths of a pixel of a length in figure units at the target's distance.
    pub fn length(&self, length: i32) -> i32 {
        (length >> self.pre_shift).min(i32::from(i16::MAX)) * self.scale / (self.size >> self.pre_shift).max(1)
    }
}

/// Equally spaced places of a plane as the camera has them before the perspective.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lattice {
    corner: Vector,
    steps: [Vector; 2],
}

/// Right, down and away for a view.
fn axes(bearings: Bearings, view: View) -> [Vector; 3] {
    let (sin, cos) = sin_cos(of_degrees(view.orbit));
    let left = cross(bearings.up, bearings.facing);
    // Towards the camera, in the plane; then raised.
    let level: Vector = core::array::from_fn(|axis| (cos * bearings.facing[axis] + sin * left[axis] + HALF) >> FRACTION_BITS);
    let (sin, cos) = sin_cos(of_degrees(view.tilt));
    let mix = |a: i32, b: i32| -> Vector {
        core::array::from_fn(|axis| (a * level[axis] + b * bearings.up[axis] + HALF) >> FRACTION_BITS)
    };
    [cross(bearings.up, level), mix(sin, -cos), mix(-cos, -sin)]
}

/// Degrees in 2^-32 turns.
fn of_degrees(degrees: i16) -> i32 {
    i32::from(degrees).wrapping_mul(11_930_465)
}

/// By the saturating instruction, where the core has one.
fn sixteen_bits(x: i32) -> i32 {
    x.clamp(i32::from(i16::MIN), i32::from(i16::MAX))
}

/// Distances from half to one and a half times the camera's, in 128 steps: value at the start of each, and step to the next.
static MAGNIFICATION: [[i32; 2]; 128] = {
    let mut table = [[0; 2]; 128];
    let mut distance = 64;
    while distance < 192 {
        let from = ((1 << 21) + distance / 2) / distance;
        let to = ((1 << 21) + distance / 2) / (distance + 1);
        table[distance as usize - 64] = [from, to - from];
        distance += 1;
    }
    table
};

/// Camera's distance over the point's, Q14: within 1.3e-4 at half the distance, 2e-5 at the target's.
fn magnification(depth: i32) -> i32 {
    let distance = (depth + (1 << (DEPTH_BITS - 1))).clamp(0, (1 << DEPTH_BITS) - 1);
    let (index, place) = ((distance >> 8) as usize, distance & 0xff);
    let Some(&[from, step]) = MAGNIFICATION.get(index) else { return 1 << 14 };
    from + ((step * place) >> 8)
}
