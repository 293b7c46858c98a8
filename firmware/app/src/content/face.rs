//! A face.

use super::{AnyContent, Content, whole_display};
use crate::board::{Board, Exit};
use crate::capacity::Style;
use crate::log::{error, info};
use crate::session::{Outcome, PlayContext};
use pantin::{Clip, Player, Pose, Rig};
use pantin_face::{Binding, FaceRenderer, Model, Morph, Weights};
use pantin_figure::surface::{Framebuffer, Layout};
use pantin_figure::{Canvas, View};

/// The face of large displays.
#[cfg(not(feature = "cartoon"))]
pub(super) mod large {
    pub use pantin_face::{MODEL, VERTICES};
}

/// The face of small displays.
#[cfg(not(feature = "cartoon"))]
pub(super) mod small {
    pub use pantin_face::{SMALL as MODEL, SMALL_VERTICES as VERTICES};
}

/// The face of filled shapes is the same on all displays.
#[cfg(feature = "cartoon")]
pub(super) mod large {
    pub use pantin_face::{CARTOON as MODEL, CARTOON_VERTICES as VERTICES};
}
#[cfg(feature = "cartoon")]
pub(super) use large as small;

/// Whether a display shows the face of small displays. The compiler knows it, so that a program contains one of the two.
#[inline(always)]
pub(super) const fn is_small<L: Layout>() -> bool {
    L::HEIGHT <= pantin_face::SMALL_HEIGHT as usize
}

/// Returns whether a clip drives a face.
#[inline(always)]
pub(super) fn is_in<L: Layout>(clip: &Clip) -> bool {
    drives(clip, if is_small::<L>() { small::MODEL } else { large::MODEL })
}

/// Not inlined: the binding is on the stack only meanwhile.
#[inline(never)]
fn drives(clip: &Clip, model: &[u8]) -> bool {
    Model::new_checked(model).is_ok_and(|model| Binding::new(&clip.rig(), &model).is_face())
}

/// A face and its camera.
pub(super) struct Face<'a, const N: usize> {
    model: &'a Model<'static>,
    binding: &'a Binding,
    morph: &'a mut Morph<N>,
    renderer: &'a mut FaceRenderer<N>,
    /// The view that shows the face from straight ahead.
    ahead: View,
}

/// Builds the face of a model of at most `N` vertices that a clip drives for an area of the display, given with its first column, and hands it to `then`; returns `None` if
/// the model's bytes are damaged. Inlined: the face's buffers are too large to be moved out of the caller's stack frame.
#[inline(always)]
pub(super) fn with<const N: usize, T>(
    model: &'static [u8],
    rig: &Rig,
    canvas: Canvas,
    column: i16,
    [view, ahead]: [View; 2],
    then: impl FnOnce(Face<N>) -> T,
) -> Option<T> {
    let set_up = |renderer: &mut FaceRenderer<N>, model: &Model| {
        renderer.set_up(model, canvas, face_view(view, ahead));
        renderer.shift(column, 0);
    };
    with_renderer(model, rig, ahead, set_up, then)
}

/// Builds the face of a model that a clip drives for the head of a body with volume, whose radius in pixels is given. Otherwise like [`with`].
#[cfg(feature = "neck")]
#[inline(always)]
pub(super) fn on_head<const N: usize, T>(
    model: &'static [u8],
    rig: &Rig,
    radius: u16,
    then: impl FnOnce(Face<N>) -> T,
) -> Option<T> {
    let set_up = |renderer: &mut FaceRenderer<N>, model: &Model| renderer.set_up_on_head(model, radius);
    with_renderer(model, rig, View::default(), set_up, then)
}

#[inline(always)]
fn with_renderer<const N: usize, T>(
    model: &'static [u8],
    rig: &Rig,
    ahead: View,
    set_up: impl FnOnce(&mut FaceRenderer<N>, &Model),
    then: impl FnOnce(Face<N>) -> T,
) -> Option<T> {
    let model = Model::new_checked(model).ok()?;
    let mut binding = Binding::EMPTY;
    binding.set_up(rig, &model);
    let mut morph = Morph::EMPTY;
    morph.set_up(&model).ok()?;
    let mut renderer = FaceRenderer::EMPTY;
    set_up(&mut renderer, &model);
    info!("{} scalars drive the face", binding.driving());
    Some(then(Face { model: &model, binding: &binding, morph: &mut morph, renderer: &mut renderer, ahead }))
}

impl<const N: usize> Face<'_, N> {
    pub(super) fn set_pose(&mut self, pose: Pose<'_>) {
        self.shape(pose.values);
        self.renderer.project(self.model, self.morph);
    }

    /// Moves the vertices. Not inlined: the weights are on the stack only meanwhile.
    #[inline(never)]
    pub(super) fn shape(&mut self, pose: &[i32]) {
        let mut weights = Weights::new();
        self.binding.read(pose, &mut weights);
        self.morph.apply(self.model, &weights);
    }

    pub(super) fn draw<L: Layout>(&mut self, framebuffer: &mut Framebuffer<L>) {
        self.renderer.draw_on(self.model, framebuffer);
    }

    /// Draws it on the head of a body with volume.
    #[cfg(feature = "neck")]
    pub(super) fn draw_on_head<L: Layout>(&mut self, framebuffer: &mut Framebuffer<L>, head: &pantin_figure::solid::HeadPose) {
        self.renderer.draw_on_head(self.model, self.morph, framebuffer, head);
    }

    pub(super) fn aim(&mut self, view: View) {
        self.renderer.aim(face_view(view, self.ahead));
    }
}

/// Returns the view of a face: it is turned by the difference to the view that is straight ahead.
fn face_view(view: View, ahead: View) -> pantin_face::FaceView {
    pantin_face::FaceView { orbit: view.orbit - ahead.orbit, tilt: view.tilt - ahead.tilt }
}

impl<L: Layout, const N: usize> Content<L> for Face<'_, N> {
    fn set_pose(&mut self, pose: Pose<'_>) {
        Face::set_pose(self, pose);
    }

    fn draw(&mut self, framebuffer: &mut Framebuffer<L>, _style: Style) {
        Face::draw(self, framebuffer);
    }

    fn aim(&mut self, _player: &mut Player, view: View, _style: Style) {
        Face::aim(self, view);
    }
}

/// Builds it for the whole display.
#[inline(always)]
pub(super) fn build<B: Board>(
    player: &mut Player,
    context: &mut PlayContext<B>,
    then: impl FnOnce(&mut Player, &mut AnyContent<B>, &mut PlayContext<B>) -> Outcome,
) -> Outcome {
    if is_small::<B::Layout>() {
        build_model::<B, { small::VERTICES }>(small::MODEL, player, context, then)
    } else {
        build_model::<B, { large::VERTICES }>(large::MODEL, player, context, then)
    }
}

#[inline(never)]
fn build_model<B: Board, const N: usize>(
    model: &'static [u8],
    player: &mut Player,
    context: &mut PlayContext<B>,
    then: impl FnOnce(&mut Player, &mut AnyContent<B>, &mut PlayContext<B>) -> Outcome,
) -> Outcome {
    let rig = player.clip().rig();
    let views = [context.view_state.view, context.view_state.ahead];
    let canvas = whole_display::<B::Layout>();
    let outcome = with::<N, _>(model, &rig, canvas, 0, views, |mut face| then(player, &mut face, context));
    outcome.unwrap_or_else(bad_model)
}

/// Ends the program: the model is part of it, so its bytes are damaged.
pub(super) fn bad_model() -> Outcome {
    error!("the face's model is damaged");
    Outcome::Exit(Exit::BadClip)
}
