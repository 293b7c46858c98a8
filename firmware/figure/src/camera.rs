//! A perspective camera in integers: no division a point, no product wider than 32 bits.

use crate::bounds::{Bounds, Orientation, cross};
use crate::root::direction;
use crate::rotation::{Rotation, Vector};
use crate::trig::{FRACTION_BITS, HALF, ONE, WORKED_OUT, sin_cos, table};
use pantin::Up;

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

/// The areas of a display that shows a body and its face: side by side on a wide display, the face in a corner of a tall one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Areas {
    /// The body's, from the left.
    pub body: Canvas,
    /// The face's square at the top right.
    pub face: Canvas,
    /// First column of the face's area.
    pub face_column: i16,
}

impl Canvas {
    /// Divides the display between a body and its face.
    pub const fn with_face(self) -> Areas {
        let Canvas { width, height } = self;
        let wide = 2 * width >= 3 * height;
        let side = if wide { height } else { width / 5 * 2 };
        let body = if wide { width - side } else { width };
        Areas {
            body: Canvas { width: body, height },
            face: Canvas { width: side, height: side },
            face_column: (width - side) as i16,
        }
    }
}

/// What the camera looks at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CameraTarget {
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
    pub track: CameraTarget,
    /// The direction that is vertical, in place of the one that the rig states.
    pub up: Option<Up>,
}

impl View {
    /// The orbits, in degrees, through which the user command "view" goes: three quarters, front, side, behind.
    pub const ORBITS: [i16; 4] = [-50, 0, -90, 140];

    /// Returns the orbit after this view's in [`View::ORBITS`], or the first if this one is none of them.
    pub fn next_orbit(&self) -> i16 {
        let mut orbits = Self::ORBITS.iter().copied();
        orbits.find(|orbit| *orbit == self.orbit).and_then(|_| orbits.next()).unwrap_or(Self::ORBITS[0])
    }
}

impl Default for View {
    fn default() -> Self {
        View { orbit: -50, tilt: 12, track: CameraTarget::Follow, up: None }
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
/// Bits to which a size is cut for the divisions of the set-up.
const SIZE_BITS: u32 = 13;
/// Longest row of the view's rotation: one that long keeps all that forward kinematics does with it within 32 bits, as its
/// row of length 2^15 does.
const LONGEST_ROW: i32 = 37_000;
/// Fraction bits, of a sixteenth of a pixel, that a place keeps until the perspective.
const SPARE: i32 = 2;

/// Sees places as forward kinematics gives them in the camera's own axes: right, down and away from the target, in 2^-`fine`
/// sixteenths of a pixel at the target's distance.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    /// From the world's axes, as columns: a rotation times a factor of at most 1.13.
    view: Rotation,
    /// Bits that a place loses before the perspective, and those that it keeps.
    shift: u32,
    spare: u32,
    /// Depth of a place that is 1 away, in 2^-`depth_shift` units of depth.
    depth_factor: i32,
    depth_shift: u32,
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
    pub(crate) const NOWHERE: Camera = Camera {
        view: Rotation([[0; 3]; 3]),
        shift: 0,
        spare: 0,
        depth_factor: 0,
        depth_shift: 0,
        fixed: [None; 3],
        centre: [0; 2],
        scale: 1,
        size: 1,
    };

    /// A camera for what `bounds` saw of a figure of `size`, with a size `scale` sixteenths of a pixel (at most 2^14) big and
    /// the target in the top left corner: [`Camera::set_center`] moves it to its place.
    pub fn new(bounds: &Bounds, orientation: Orientation, size: i32, view: View, scale: i32) -> Self {
        let middle = bounds.middle();
        let climbs = bounds.half_extent(orientation.axis) > size;
        let fixed = core::array::from_fn(|axis| match view.track {
            CameraTarget::Fixed => Some(middle[axis]),
            CameraTarget::Follow => (axis == orientation.axis && !climbs).then_some(middle[axis]),
        });
        let size = match view.track {
            CameraTarget::Follow => size,
            CameraTarget::Fixed => (0..3).fold(size, |size, axis| size.max(bounds.half_extent(axis))),
        };
        // The factor is scale / size * 2^fine; in Q15, with the size cut to its highest bits, a shift is all there is to choose.
        let cut = (32 - size.leading_zeros()).saturating_sub(SIZE_BITS);
        let short = (size >> cut).max(1);
        let mut room = 0;
        while (scale << (room + 1)) / short <= LONGEST_ROW && room < 16 {
            room += 1;
        }
        let factor = (scale << room) / short;
        let fine = (room + cut) as i32 - FRACTION_BITS as i32;
        let rows = axes(orientation, view).map(|row| row.map(|x| (x * factor + HALF) >> FRACTION_BITS));
        let shift = (fine - SPARE).max(0);
        let spare = fine - shift;
        // A unit of depth is 2^-15 of DISTANCE scales. A place loses all but 2^15 of its bits, so the factor has 15 too.
        let mut depth_bits = 0;
        while (1 << (depth_bits + 1)) / (DISTANCE * scale) < ONE && depth_bits < 29 {
            depth_bits += 1;
        }
        Camera {
            view: Rotation(core::array::from_fn(|axis| rows.map(|row| row[axis]))),
            shift: shift as u32,
            spare: (MAGNIFICATION_BITS + spare) as u32,
            depth_factor: (1 << depth_bits) / (DISTANCE * scale),
            depth_shift: (depth_bits - DEPTH_BITS as i32 + spare).max(0) as u32,
            fixed,
            centre: [0; 2],
            scale,
            size,
        }
    }

    /// Puts the target at a place of the display, in sixteenths of a pixel.
    pub fn set_center(&mut self, x: i32, y: i32) {
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

    /// Turns the world into the camera's axes: forward kinematics starts from it.
    pub fn view(&self) -> &Rotation {
        &self.view
    }

    /// The perspective, for a place in the camera's axes.
    #[cfg_attr(not(target_arch = "wasm32"), inline(always))]
    pub fn project(&self, place: Vector) -> Projected {
        let [x, y, away] = place;
        let (x, y, away) = (sixteen_bits(x >> self.shift), sixteen_bits(y >> self.shift), sixteen_bits(away >> self.shift));
        let depth = (away * self.depth_factor) >> self.depth_shift;
        let magnification = magnification(depth);
        // Within 2^15, magnified at most twice: products stay within 2^30.
        let (x, y) = ((x * magnification) >> self.spare, (y * magnification) >> self.spare);
        Projected { x: x + self.centre[0], y: y + self.centre[1], depth, magnification }
    }

    /// A vector in the camera's axes as it is seen at the target's distance: right, down and away, in sixteenths of a pixel.
    pub(crate) fn vector(&self, [x, y, away]: Vector) -> Vector {
        let spare = self.spare as i32 - MAGNIFICATION_BITS;
        let seen = |part: i32| {
            let part = sixteen_bits(part >> self.shift);
            if spare >= 0 { part >> spare } else { part << -spare }
        };
        [seen(x), seen(y), seen(away)]
    }

    /// The level of `place` above `upright`, a vector; both are in the camera's axes.
    pub(crate) fn level(&self, upright: Vector, place: Vector) -> Level {
        // 2^14 long: sums of three products stay below 2^31.
        let upright = direction(upright).map_or([0; 3], |v| v.map(|part| part >> 1));
        Level { upright, height: Level { upright, height: 0 }.height_of(self.cut(place)) }
    }

    /// A place in the camera's axes, moved up or down to a level.
    #[inline(never)]
    pub(crate) fn moved_to(&self, level: &Level, place: Vector) -> Projected {
        let place = self.cut(place);
        let by = level.height - level.height_of(place);
        self.project(core::array::from_fn(|axis| (place[axis] + ((level.upright[axis] * by) >> 14)) << self.shift))
    }

    /// Without the bits that have no room in products.
    fn cut(&self, place: Vector) -> Vector {
        place.map(|part| sixteen_bits(part >> self.shift))
    }

    /// Sixteenths of a pixel that a limb at the target's distance is across: a 64th of the figure.
    pub fn breadth(&self) -> i32 {
        self.scale / 64
    }

    /// Sixteenths of a pixel of a length in figure units at the target's distance.
    pub fn length(&self, length: i32) -> i32 {
        {
            let cut = (32 - self.size.leading_zeros()).saturating_sub(SIZE_BITS);
            (length >> cut).min(i32::from(i16::MAX)) * self.scale / (self.size >> cut).max(1)
        }
    }
}

/// A horizontal plane in the camera's axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Level {
    /// 2^14 long.
    upright: Vector,
    height: i32,
}

impl Level {
    fn height_of(&self, place: Vector) -> i32 {
        place.iter().zip(self.upright).map(|(part, upright)| (part * upright) >> 2).sum::<i32>() >> 12
    }
}

/// Right, down and away for a view.
fn axes(orientation: Orientation, view: View) -> [Vector; 3] {
    let (sin, cos) = sin_cos(of_degrees(view.orbit));
    let left = cross(orientation.up, orientation.facing);
    // Towards the camera, in the plane; then raised.
    let level: Vector = core::array::from_fn(|axis| (cos * orientation.facing[axis] + sin * left[axis] + HALF) >> FRACTION_BITS);
    let (sin, cos) = sin_cos(of_degrees(view.tilt));
    let mix = |a: i32, b: i32| -> Vector {
        let one = |level: i32, up: i32| (a * level + b * up + HALF) >> FRACTION_BITS;
        let up = orientation.up;
        [one(level[0], up[0]), one(level[1], up[1]), one(level[2], up[2])]
    };
    [cross(orientation.up, level), mix(sin, -cos), mix(-cos, -sin)]
}

/// Degrees in 2^-32 turns.
fn of_degrees(degrees: i16) -> i32 {
    i32::from(degrees).wrapping_mul(11_930_465)
}

/// By the saturating instruction, where the core has one.
#[inline(always)]
fn sixteen_bits(x: i32) -> i32 {
    x.clamp(i32::from(i16::MIN), i32::from(i16::MAX))
}

/// Distances from half to one and a half times the camera's, in 128 steps: value at the start of each, and step to the next.
static MAGNIFICATION: [(u16, i16); 128] = table!(magnification_from, 128);

const fn magnification_from(index: usize) -> (u16, i16) {
    let distance = 64 + index as i32;
    let from = ((1 << 21) + distance / 2) / distance;
    let to = ((1 << 21) + distance / 2) / (distance + 1);
    (from as u16, (to - from) as i16)
}

/// Fraction bits of a magnification.
pub(crate) const MAGNIFICATION_BITS: i32 = 14;

/// Camera's distance over the point's, Q14: within 1.3e-4 at half the distance, 2e-5 at the target's.
#[inline(always)]
pub(crate) fn magnification(depth: i32) -> i32 {
    let distance = (depth + (1 << (DEPTH_BITS - 1))).clamp(0, (1 << DEPTH_BITS) - 1);
    let (index, place) = ((distance >> 8) as usize, distance & 0xff);
    let (from, step) = if WORKED_OUT {
        magnification_from(index)
    } else {
        let Some(&entry) = MAGNIFICATION.get(index) else { return 1 << 14 };
        entry
    };
    i32::from(from) + ((i32::from(step) * place) >> 8)
}
