//! A face.

use super::{Content, display};
use crate::board::{Board, Exit};
use crate::log::{error, info};
use crate::run::{Outcome, PlayContext, play};
use pantin::{Clip, Player, Pose, Rig};
use pantin_face::{Binding, MODEL, Model, Morph, VERTICES, Weights};
use pantin_figure::surface::{Framebuffer, Layout};
use pantin_figure::{Canvas, DrawStyle, View};

/// Whether a clip drives a face. In a function of its own: what the names are bound to is given back.
#[inline(never)]
pub(super) fn is_in(clip: &Clip) -> bool {
    Model::new_checked(MODEL).is_ok_and(|model| Binding::of(&clip.rig(), &model).is_face())
}

/// A face before its camera.
pub(super) struct Face<'a> {
    model: &'a Model<'static>,
    binding: &'a Binding,
    morph: &'a mut Morph<VERTICES>,
    renderer: &'a mut pantin_face::FaceRenderer<VERTICES>,
    /// From where it is seen straight ahead.
    ahead: View,
}

/// Shows the face that a clip drives on a part of the display, given with its first column; none where the model is no use. What a face
/// needs stays where it was made, in the caller: it is too large to be handed on.
#[inline(always)]
pub(super) fn with<T>(
    rig: &Rig,
    canvas: Canvas,
    column: i16,
    [view, ahead]: [View; 2],
    then: impl FnOnce(Face) -> T,
) -> Option<T> {
    let model = Model::new_checked(MODEL).ok()?;
    let mut binding = Binding::EMPTY;
    binding.set_up(rig, &model);
    let mut morph = Morph::EMPTY;
    morph.set_up(&model).ok()?;
    let mut renderer = pantin_face::FaceRenderer::EMPTY;
    renderer.set_up(&model, canvas, from(view, ahead));
    renderer.shift(column, 0);
    Some(then(Face { model: &model, binding: &binding, morph: &mut morph, renderer: &mut renderer, ahead }))
}

impl Face<'_> {
    /// Number of the clip's scalars that drive it.
    #[cfg(feature = "defmt")]
    pub(super) fn names(&self) -> usize {
        self.binding.names()
    }

    pub(super) fn set_pose(&mut self, pose: Pose<'_>) {
        self.shape(pose.values);
        self.renderer.project(self.model, self.morph);
    }

    /// In a function of its own: the weights are given back.
    #[inline(never)]
    fn shape(&mut self, pose: &[i32]) {
        let mut weights = Weights::new();
        self.binding.weigh(pose, &mut weights);
        self.morph.place(self.model, &weights);
    }

    pub(super) fn draw<L: Layout>(&mut self, frame: &mut Framebuffer<L>) {
        self.renderer.draw_on(self.model, frame);
    }

    pub(super) fn aim(&mut self, view: View) {
        self.renderer.aim(from(view, self.ahead));
    }
}

/// A face is turned by as much as the view is away from where that is straight ahead.
fn from(view: View, ahead: View) -> pantin_face::View {
    pantin_face::View { orbit: view.orbit - ahead.orbit, tilt: view.tilt - ahead.tilt }
}

impl<L: Layout> Content<L> for Face<'_> {
    fn set_pose(&mut self, pose: Pose<'_>) {
        Face::set_pose(self, pose);
    }

    fn draw(&mut self, frame: &mut Framebuffer<L>, _style: DrawStyle) {
        Face::draw(self, frame);
    }

    fn aim(&mut self, _player: &mut Player, view: View) {
        Face::aim(self, view);
    }
}

/// Plays it on the whole display.
#[inline(never)]
pub(super) fn perform<B: Board>(player: &mut Player, context: PlayContext<B>) -> Outcome {
    let rig = player.clip().rig();
    let views = [context.view_state.view, context.view_state.ahead];
    let after = with(&rig, display::<B::Layout>(), 0, views, |mut face| {
        info!(
            "{}: {} frames of {} ns, {} channels, {} of them moving; {} drive the face",
            context.entry.name,
            player.clip().frames(),
            player.clip().frame_time_ns(),
            player.clip().rig().channels(),
            player.clip().moving(),
            face.names()
        );
        let face: &mut dyn Content<B::Layout> = &mut face;
        play(player, face, context)
    });
    after.unwrap_or_else(no_model)
}

/// The model is the program's own; its bytes may have been damaged.
pub(super) fn no_model() -> Outcome {
    error!("the face's model is no use");
    Outcome::Exit(Exit::BadClip)
}
