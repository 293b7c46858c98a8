//! A face before its camera: vertices on the display, and which of them look away.

use crate::bytes::Bytes;
use crate::model::Model;
use crate::morph::{Morph, Place, coordinates};
use crate::outline::Outline;
use crate::pen::{Each, Paint, Pen};
use crate::projection::{self, Projection};
use crate::strokes::{self, Screen};
use pantin_figure::Canvas;
use pantin_figure::camera::PIXEL_BITS;
use pantin_figure::lines::Line;
use pantin_figure::rotation::{Rotation, Vector};
use pantin_figure::surface::Surface;

/// From where a face is seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct View {
    /// Degrees about the vertical: 0 looks the face in the eyes, 90 sees it look to the left.
    pub orbit: i16,
    /// Degrees above the horizon.
    pub tilt: i16,
}

/// The camera.
#[derive(Clone, Debug)]
pub(crate) struct Camera {
    /// Where the face is drawn, in sixteenths of a pixel.
    pub centre: [i32; 2],
    /// Right, up and towards the camera, Q15.
    pub rows: [Vector; 3],
    /// Steps times Q15 rows times this (below 2^15) are sixteenths of a pixel after 15 and `shift` bits.
    pub scale: i32,
    pub shift: u32,
    /// Magnification a step towards the camera, Q28: at most 2^14.
    pub nearer: i32,
    /// What stands in the middle of the display.
    pub middle: Vector,
}

/// A camera and what it sees of a face of at most `N` vertices.
#[derive(Clone, Debug)]
pub struct FaceRenderer<const N: usize> {
    camera: Camera,
    detail: u8,
    vertices: usize,
    /// Sixteenths of a pixel.
    points: [[i16; 2]; N],
    /// Cosine of the angle between a vertex's normal and the way to the camera, 127 is 1; `UNSEEN` where nothing is drawn.
    facing: [i8; N],
    outline: Outline,
    /// How the head was turned when the points were found, and, rounded, when the rest was.
    before: Option<Turned>,
    rounded: Option<[i8; 3]>,
}

/// Where surfaces look is found anew for every 2^26 of 2^-32 turns, 5.6 degrees: an outline that is half of that late is right to an
/// 800th of the head.
const ROUNDED_BITS: u32 = 26;

/// The head's angles, and what it turns about.
type Turned = ([i32; 3], Place);

/// The display's height is 64 of these parts, the face's down to the end of its neck so many: that end may leave the display.
const FILLED: i32 = 65;
/// Parts above it.
const ABOVE: i32 = 1;
/// Pixels of the face's height from which on more is drawn.
const DETAILS: [i32; 3] = [96, 150, 190];
/// The camera is so many times the face's height away, as a power of two.
const DISTANCE_BITS: u32 = 2;

impl<const N: usize> FaceRenderer<N> {
    /// No camera yet.
    pub const EMPTY: Self = FaceRenderer {
        camera: Camera { centre: [0; 2], rows: [[0; 3]; 3], scale: 1, shift: 16, nearer: 0, middle: [0; 3] },
        detail: 0,
        vertices: 0,
        points: [[0; 2]; N],
        facing: [0; N],
        outline: Outline::EMPTY,
        before: None,
        rounded: None,
    };

    /// A camera for a display.
    #[inline(always)]
    pub fn new(model: &Model, canvas: Canvas, view: View) -> Self {
        let mut renderer = FaceRenderer::EMPTY;
        renderer.set_up(model, canvas, view);
        renderer
    }

    /// A camera for a display, where there was none: as [`Morph::set_up`].
    #[inline(never)]
    pub fn set_up(&mut self, model: &Model, canvas: Canvas, view: View) {
        (self.camera, self.detail) = frame(model, canvas);
        self.vertices = model.vertices().min(N);
        self.aim(view);
    }

    /// Looks from elsewhere.
    pub fn aim(&mut self, view: View) {
        let mut turned = Rotation::IDENTITY;
        turned.turn(0, of_degrees(view.tilt));
        turned.turn(1, of_degrees(-view.orbit));
        let [x, y, z] = turned.0;
        (self.before, self.rounded) = (None, None);
        self.camera.rows = core::array::from_fn(|row| [x[row], y[row], z[row]]);
    }

    /// Moves the picture by whole pixels: a place beside a figure.
    pub fn shift(&mut self, x: i16, y: i16) {
        self.before = None;
        self.camera.centre[0] += i32::from(x) << PIXEL_BITS;
        self.camera.centre[1] += i32::from(y) << PIXEL_BITS;
    }

    /// Puts the vertices that are drawn on the display. In a function of its own: the morph before takes room too.
    #[inline(never)]
    pub fn project(&mut self, model: &Model, morph: &Morph<N>) {
        let head = morph.turn();
        // Where surfaces look, and what makes the outline, depends on the head's turn alone, and hardly on a degree of it.
        let rounded = head.0.map(|angle| (((angle >> (ROUNDED_BITS - 1)) + 1) >> 1) as i8);
        if self.rounded != Some(rounded) {
            let towards = projection::towards(&self.camera, rounded.map(|angle| i32::from(angle) << ROUNDED_BITS));
            projection::facing(model, towards, &mut self.facing);
            self.outline.of(model, &self.facing);
            strokes::leave_out(model, self.detail, &self.outline, &mut self.facing);
            (self.rounded, self.before) = (Some(rounded), None);
        }
        let all = self.before != Some(head);
        project(model, &self.camera, morph.places(), head, all, &self.facing, &mut self.points);
        self.before = Some(head);
    }

    /// The places of the vertices on the display, in sixteenths of a pixel.
    pub fn points(&self) -> &[[i16; 2]] {
        self.points.get(..self.vertices).unwrap_or(&[])
    }

    /// Draws the face on a clear surface.
    #[inline(never)]
    pub fn draw_on<S: Surface>(&self, model: &Model, surface: &mut S) {
        self.paint(model, &mut Pen::on(surface));
    }

    /// Gives the lines of the face, the brighter ones after the darker ones.
    pub fn lines(&self, model: &Model, out: impl FnMut(Line)) {
        self.paint(model, &mut Each::new(out));
    }

    #[inline(always)]
    fn paint(&self, model: &Model, out: &mut impl Paint) {
        let screen = Screen { points: &self.points, facing: &self.facing, outline: &self.outline };
        strokes::draw(model, screen, self.detail, out);
    }
}

/// The camera for a display, not aimed yet, and how much is drawn at its size.
fn frame(model: &Model, canvas: Canvas) -> (Camera, u8) {
    let (mut low, mut high) = ([i32::MAX; 3], [i32::MIN; 3]);
    for point in model.points.as_chunks::<6>().0 {
        for ((low, high), x) in low.iter_mut().zip(&mut high).zip(coordinates(*point)) {
            *low = (*low).min(i32::from(x));
            *high = (*high).max(i32::from(x));
        }
    }
    // A model has at least one point.
    let (height, width) = ((high[1] - low[1]).max(1), (2 * high[0].max(-low[0])).max(1));
    let [columns, rows] = [canvas.width, canvas.height].map(|pixels| i32::from(pixels) << PIXEL_BITS);
    // Sixteenths of a pixel a step, Q16, by whichever side is tighter; canvases count for at most 2^16 sixteenths.
    let fit = |room: i32, size: i32| ((room.min(1 << 16) << 14) / size) << 2;
    let scale = fit(rows * FILLED / 64, height).min(fit(columns, width)).clamp(1, 1 << 20);
    let excess = (32 - scale.leading_zeros()).saturating_sub(15);
    let covered = ((height >> 4) * (scale >> 4)) >> (8 + PIXEL_BITS);
    let camera = Camera {
        centre: [columns / 2, rows / 2],
        rows: [[0; 3]; 3],
        scale: scale >> excess,
        shift: 16 - excess,
        nearer: ((1 << 28) / (height << DISTANCE_BITS)).min(1 << 14),
        middle: [0, high[1] - height / FILLED * (32 - ABOVE), 0],
    };
    (camera, DETAILS.iter().filter(|&&least| covered >= least).count() as u8)
}

/// Puts the vertices on the display that are drawn there: all, or those that may move. In a function of its own: finding the outline
/// before takes room too.
#[inline(never)]
fn project(model: &Model, camera: &Camera, places: &[Place], head: Turned, all: bool, facing: &[i8], points: &mut [[i16; 2]]) {
    let (angles, pivot) = head;
    let head = projection::turned(angles);
    let pivot = pivot.map(i32::from);
    let carried = head.apply_any(pivot);
    let whole = Projection::new(camera, &head, core::array::from_fn(|axis| pivot[axis] - carried[axis] - camera.middle[axis]));
    if !all {
        for [from, to] in model.moving() {
            if let (Some(places), Some(facing), Some(points)) =
                (places.get(from..to), facing.get(from..to), points.get_mut(from..to))
            {
                whole.points(places, facing, points);
            }
        }
        return;
    }
    whole.points(places, facing, points);
    let still = Projection::new(camera, &Rotation::IDENTITY, camera.middle.map(|x| -x));
    let mut fixed = Bytes(model.fixed);
    while let Ok(index) = fixed.index(model.wide) {
        if let (Some(point), Some(&place)) = (points.get_mut(usize::from(index)), places.get(usize::from(index))) {
            *point = still.point(place);
        }
    }
}

/// Degrees in 2^-32 turns.
fn of_degrees(degrees: i16) -> i32 {
    i32::from(degrees).wrapping_mul(11_930_465)
}
