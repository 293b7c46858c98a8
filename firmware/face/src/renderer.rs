//! Projects a face on a display and draws it.

use crate::bytes::Bytes;
use crate::camera::{Camera, FaceView, frame};
use crate::model::Model;
use crate::morph::Morph;
use crate::outline::Outline;
use crate::pen::{EachLine, Pen, StrokeSink};
use crate::projection::{self, Projection};
use crate::strokes::{self, ProjectedFace};
use crate::vertex::Vertex;
use embedded_graphics::draw_target::DrawTarget;
use pantin_figure::camera::PIXEL_BITS;
use pantin_figure::lines::Line;
use pantin_figure::rotation::Rotation;
use pantin_figure::solid::HeadPose;
use pantin_figure::surface::{OnTarget, Surface};
use pantin_figure::{Canvas, Ink};

/// A camera, and the face as it appears on the display. `N` is the maximum number of vertices: [`VERTICES`](crate::VERTICES) for Pantin's own
/// face.
///
/// For each picture call [`project`](FaceRenderer::project), then one of [`draw`](FaceRenderer::draw), [`draw_over`](FaceRenderer::draw_over),
/// [`draw_on`](FaceRenderer::draw_on) and [`each_line`](FaceRenderer::each_line).
#[derive(Clone, Debug)]
pub struct FaceRenderer<const N: usize> {
    camera: Camera,
    detail: u8,
    vertices: usize,
    /// Sixteenths of a pixel.
    points: [[i16; 2]; N],
    /// Cosine of the angle between a vertex's normal and the direction towards the camera, 127 is 1; `NOT_DRAWN` where no line needs it.
    facing: [i8; N],
    outline: Outline,
    /// The head's rotation for which `points` were found, and, rounded, for which the rest was.
    before: Option<HeadRotation>,
    rounded: Option<[i8; 3]>,
}

/// Facing and outline are found again for every 2^26 of 2^-32 turns (5.6 degrees): an outline that is half of that late is exact to 1/800
/// of the head.
const ROUNDED_BITS: u32 = 26;

/// A head that looks at the camera by less than this has no face: 256 looks straight at it.
const LEAST_TOWARD: i32 = 48;

/// The head's angles, and the point about which it rotates.
type HeadRotation = ([i32; 3], Vertex);

impl<const N: usize> FaceRenderer<N> {
    /// A renderer without a camera, for [`FaceRenderer::set_up`].
    pub const EMPTY: Self = FaceRenderer {
        camera: Camera::EMPTY,
        detail: 0,
        vertices: 0,
        points: [[0; 2]; N],
        facing: [0; N],
        outline: Outline::EMPTY,
        before: None,
        rounded: None,
    };

    /// Returns a renderer for a display or a part of it, seen from `view`. The face fills the canvas.
    #[inline(always)]
    pub fn new(model: &Model, canvas: Canvas, view: FaceView) -> Self {
        let mut renderer = FaceRenderer::EMPTY;
        renderer.set_up(model, canvas, view);
        renderer
    }

    /// Sets the renderer up in place: [`FaceRenderer::new`] may copy its result, for which a small machine may have no RAM.
    #[inline(never)]
    pub fn set_up(&mut self, model: &Model, canvas: Canvas, view: FaceView) {
        (self.camera, self.detail) = frame(model, canvas);
        self.vertices = model.vertices().min(N);
        self.aim(view);
    }

    /// Changes the direction from which the face is seen; it applies from the next [`FaceRenderer::project`] on.
    pub fn aim(&mut self, view: FaceView) {
        (self.before, self.rounded) = (None, None);
        self.camera.aim(view);
    }

    /// Moves the picture by whole pixels to the right and down, for instance beside a figure.
    pub fn shift(&mut self, x: i16, y: i16) {
        self.before = None;
        self.camera.centre[0] += i32::from(x) << PIXEL_BITS;
        self.camera.centre[1] += i32::from(y) << PIXEL_BITS;
    }

    /// Sets the renderer up for the head of a solid figure, whose skull has a radius of about `radius` pixels. Such a face is drawn
    /// by [`FaceRenderer::draw_on_head`].
    #[inline(never)]
    pub fn set_up_on_head(&mut self, model: &Model, radius: u16) {
        let height = radius.saturating_mul(5) / 3;
        self.set_up(model, Canvas { width: height.saturating_mul(2), height }, FaceView::default());
    }

    /// Draws the face of `morph` on the head of a solid figure, if the head shows it:
    /// [`SolidFigure::draw_with_face`](pantin_figure::solid::SolidFigure::draw_with_face) passes both.
    pub fn draw_on_head<S: Surface>(&mut self, model: &Model, morph: &Morph<N>, surface: &mut S, head: &HeadPose) {
        if head.toward() < LEAST_TOWARD {
            return;
        }
        (self.before, self.rounded) = (None, None);
        self.camera.put_on(head);
        self.project(model, morph);
        self.draw_on(model, surface);
    }

    /// Projects the vertices of `morph`. `model` is the one that the renderer was set up for.
    // A function of its own: the morph before it needs stack too.
    #[inline(never)]
    pub fn project(&mut self, model: &Model, morph: &Morph<N>) {
        let head = morph.head_rotation();
        // Facing and outline depend on the head's rotation alone, and hardly on a degree of it.
        let rounded = head.0.map(|angle| (((angle >> (ROUNDED_BITS - 1)) + 1) >> 1) as i8);
        if self.rounded != Some(rounded) {
            let towards = projection::towards(&self.camera, rounded.map(|angle| i32::from(angle) << ROUNDED_BITS));
            projection::facing(model, towards, &mut self.facing);
            self.outline.find(model, &self.facing);
            strokes::mark_unneeded(model, self.detail, &self.outline, &mut self.facing);
            (self.rounded, self.before) = (Some(rounded), None);
        }
        let all = self.before != Some(head);
        project(model, &self.camera, morph.vertices(), head, all, &self.facing, &mut self.points);
        self.before = Some(head);
    }

    /// The vertices on the display, in sixteenths of a pixel from its top left corner; those that no line needs keep older values.
    pub fn points(&self) -> &[[i16; 2]] {
        self.points.get(..self.vertices).unwrap_or(&[])
    }

    /// Clears `target` and draws the face that was projected last. Lines are clipped by the target's bounding box.
    ///
    /// Colours are [`Ink`]: `BinaryColor`, `Gray4`, `Gray8`, `Rgb565` and `Rgb888` of `embedded-graphics`. Returns the first error of the target.
    pub fn draw<D>(&self, model: &Model, target: &mut D) -> Result<(), D::Error>
    where
        D: DrawTarget,
        D::Color: Ink,
    {
        target.clear(D::Color::DARK)?;
        self.draw_over(model, target)
    }

    /// Draws the face that was projected last on what `target` shows already. Otherwise like [`FaceRenderer::draw`].
    pub fn draw_over<D>(&self, model: &Model, target: &mut D) -> Result<(), D::Error>
    where
        D: DrawTarget,
        D::Color: Ink,
    {
        let mut surface = OnTarget::new(target);
        self.draw_on(model, &mut surface);
        surface.outcome()
    }

    /// Draws the face that was projected last on a surface that is clear, such as a framebuffer of `pantin-figure`: the fastest way.
    #[inline(never)]
    pub fn draw_on<S: Surface>(&self, model: &Model, surface: &mut S) {
        self.paint(model, &mut Pen::on(surface));
    }

    /// Passes the lines of the face that was projected last to `out`, the brighter ones after the darker ones.
    pub fn each_line(&self, model: &Model, out: impl FnMut(Line)) {
        self.paint(model, &mut EachLine::new(out));
    }

    #[inline(always)]
    fn paint(&self, model: &Model, out: &mut impl StrokeSink) {
        let face = ProjectedFace { points: &self.points, facing: &self.facing, outline: &self.outline };
        strokes::draw(model, face, self.detail, out);
    }
}

/// Projects the vertices that are drawn: all, or those that may move. In a function of its own: finding the outline before it needs stack
/// too.
#[inline(never)]
fn project(
    model: &Model,
    camera: &Camera,
    vertices: &[Vertex],
    head: HeadRotation,
    all: bool,
    facing: &[i8],
    points: &mut [[i16; 2]],
) {
    let (angles, pivot) = head;
    let head = projection::head_rotation(angles);
    let pivot = pivot.map(i32::from);
    let carried = head.apply_any(pivot);
    let whole = Projection::new(camera, &head, core::array::from_fn(|axis| pivot[axis] - carried[axis] - camera.middle[axis]));
    if !all {
        for [from, to] in model.moving() {
            if let (Some(vertices), Some(facing), Some(points)) =
                (vertices.get(from..to), facing.get(from..to), points.get_mut(from..to))
            {
                whole.points(vertices, facing, points);
            }
        }
        return;
    }
    whole.points(vertices, facing, points);
    let still = Projection::new(camera, &Rotation::IDENTITY, camera.middle.map(|x| -x));
    let mut fixed = Bytes(model.fixed);
    while let Ok(index) = fixed.index(model.wide) {
        if let (Some(point), Some(&vertex)) = (points.get_mut(usize::from(index)), vertices.get(usize::from(index))) {
            *point = still.point(vertex);
        }
    }
}
