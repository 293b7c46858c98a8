//! The camera in front of a face.

use crate::model::Model;
use crate::vertex;
use pantin_figure::Canvas;
use pantin_figure::camera::PIXEL_BITS;
use pantin_figure::rotation::{Rotation, Vector};
use pantin_figure::solid::HeadPose;

/// The direction from which a face is seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FaceView {
    /// Degrees about the vertical axis: at 0 the face looks into the camera, at 90 it looks to the left of the picture.
    pub orbit: i16,
    /// Degrees above the horizon.
    pub tilt: i16,
}

/// A camera for one size of picture.
#[derive(Clone, Debug)]
pub(crate) struct Camera {
    /// Where the face is drawn, in sixteenths of a pixel.
    pub centre: [i32; 2],
    /// Directions to the right, up and towards the camera, Q15.
    pub rows: [Vector; 3],
    /// Steps times Q15 rows times this scale (below 2^15) are sixteenths of a pixel after a shift by 15 and by `shift` bits.
    pub scale: i32,
    pub shift: u32,
    /// Magnification for each step towards the camera, Q28: at most 2^14.
    pub nearer: i32,
    /// The point of the model that appears in the middle of the picture.
    pub middle: Vector,
    /// Steps of the face's height.
    pub height: i32,
}

/// The height of the picture is 64 parts, that of the face down to the end of its neck is this many: there is room for a jaw that opens.
const FILLED: i32 = 60;
/// Parts above the face.
const ABOVE: i32 = 1;
/// Heights of the face in pixels from which on details 1, 2 and 3 apply.
const DETAILS: [i32; 3] = [96, 150, 190];
/// Distance of the camera: the face's height times 2^this.
const DISTANCE_BITS: u32 = 2;

impl Camera {
    /// No camera.
    pub const EMPTY: Camera =
        Camera { centre: [0; 2], rows: [[0; 3]; 3], scale: 1, shift: 16, nearer: 0, middle: [0; 3], height: 1 };

    /// Points the camera.
    #[inline(never)]
    pub fn aim(&mut self, view: FaceView) {
        let mut rotated = Rotation::IDENTITY;
        rotated.turn(0, of_degrees(view.tilt));
        rotated.turn(1, of_degrees(-view.orbit));
        let [x, y, z] = rotated.0;
        self.rows = core::array::from_fn(|row| [x[row], y[row], z[row]]);
    }

    /// Sets the scale: sixteenths of a pixel for each step, Q16, at most 2^20.
    fn set_scale(&mut self, scale: i32) {
        let excess = (32 - scale.leading_zeros()).saturating_sub(15);
        (self.scale, self.shift) = (scale >> excess, 16 - excess);
    }

    /// Puts the face on a head: where it is, how it is turned, and how large it is.
    #[inline(never)]
    pub fn put_on(&mut self, head: &HeadPose) {
        let [x, y, radius] = head.skull;
        let radius = radius.clamp(1, LARGEST_HEAD);
        self.centre = [0, 1].map(|axis| [x, y][axis] + head.up[axis] * RAISED / 256);
        let axes = [head.left, head.up, head.face];
        // Down and away are negative in the model.
        self.rows = core::array::from_fn(|row| {
            let sign = if row == 0 { 1 } else { -1 };
            axes.map(|axis| sign * axis[row].clamp(-LARGEST_HEAD, LARGEST_HEAD) * (1 << 15) / radius)
        });
        self.set_scale(((radius << 16) / HEIGHT_IN_RADII[1] * HEIGHT_IN_RADII[0] / self.height).clamp(1, 1 << 20));
    }
}

/// Largest radius of a skull on which a face is put, in sixteenths of a pixel.
const LARGEST_HEAD: i32 = 1 << 12;
/// The face's height in radii of the skull, as a fraction.
const HEIGHT_IN_RADII: [i32; 2] = [5, 3];
/// How far above the skull's middle the face's middle is, in 256ths of the radius.
const RAISED: i32 = -38;

/// Returns a camera for a canvas, which is not aimed yet, and the detail that is drawn at this size.
pub(crate) fn frame(model: &Model, canvas: Canvas) -> (Camera, u8) {
    let (mut low, mut high) = ([i32::MAX; 3], [i32::MIN; 3]);
    for point in model.points.as_chunks::<6>().0 {
        for ((low, high), x) in low.iter_mut().zip(&mut high).zip(vertex::of_bytes(*point)) {
            *low = (*low).min(i32::from(x));
            *high = (*high).max(i32::from(x));
        }
    }
    // A model has at least one point.
    let (height, width) = ((high[1] - low[1]).max(1), (2 * high[0].max(-low[0])).max(1));
    let [columns, rows] = [canvas.width, canvas.height].map(|pixels| i32::from(pixels) << PIXEL_BITS);
    // Sixteenths of a pixel for each step, Q16, as the narrower side allows; canvases count for at most 2^16 sixteenths.
    let fit = |available: i32, size: i32| ((available.min(1 << 16) << 14) / size) << 2;
    let scale = fit(rows * FILLED / 64, height).min(fit(columns, width)).clamp(1, 1 << 20);
    let covered = ((height >> 4) * (scale >> 4)) >> (8 + PIXEL_BITS);
    let mut camera = Camera {
        centre: [columns / 2, rows / 2],
        nearer: ((1 << 28) / (height << DISTANCE_BITS)).min(1 << 14),
        middle: [0, high[1] - height / FILLED * (32 - ABOVE), 0],
        height,
        ..Camera::EMPTY
    };
    camera.set_scale(scale);
    (camera, DETAILS.iter().filter(|&&least| covered >= least).count() as u8)
}

/// Degrees in 2^-32 turns.
fn of_degrees(degrees: i16) -> i32 {
    i32::from(degrees).wrapping_mul(11_930_465)
}
