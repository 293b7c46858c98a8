//! A face.

use super::{Show, display};
use crate::board::{Board, Exit};
use crate::log::{error, info};
use crate::run::{After, Scenery, play};
use pantin::{Clip, Player, Rig};
use pantin_face::{Binding, MODEL, Model, Morph, VERTICES, Weights};
use pantin_figure::surface::{Frame, Layout};
use pantin_figure::{Canvas, Look, View};

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
    look: &'a mut pantin_face::Look<VERTICES>,
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
    let mut look = pantin_face::Look::EMPTY;
    look.set_up(&model, canvas, from(view, ahead));
    look.shift(column, 0);
    Some(then(Face { model: &model, binding: &binding, morph: &mut morph, look: &mut look, ahead }))
}

impl Face<'_> {
    /// Number of the clip's scalars that drive it.
    #[cfg(feature = "defmt")]
    pub(super) fn names(&self) -> usize {
        self.binding.names()
    }

    pub(super) fn place(&mut self, pose: &[i32]) {
        self.shape(pose);
        self.look.project(self.model, self.morph);
    }

    /// In a function of its own: the weights are given back.
    #[inline(never)]
    fn shape(&mut self, pose: &[i32]) {
        let mut weights = Weights::new();
        self.binding.weigh(pose, &mut weights);
        self.morph.place(self.model, &weights);
    }

    pub(super) fn draw<L: Layout>(&mut self, frame: &mut Frame<L>) {
        self.look.draw_on(self.model, frame);
    }

    pub(super) fn aim(&mut self, view: View) {
        self.look.aim(from(view, self.ahead));
    }
}

/// A face is turned by as much as the view is away from where that is straight ahead.
fn from(view: View, ahead: View) -> pantin_face::View {
    pantin_face::View { orbit: view.orbit - ahead.orbit, tilt: view.tilt - ahead.tilt }
}

impl<L: Layout> Show<L> for Face<'_> {
    fn place(&mut self, pose: &[i32]) {
        Face::place(self, pose);
    }

    fn draw(&mut self, frame: &mut Frame<L>, _look: Look) {
        Face::draw(self, frame);
    }

    fn aim(&mut self, _player: &mut Player, view: View) {
        Face::aim(self, view);
    }
}

/// Plays it on the whole display.
#[inline(never)]
pub(super) fn perform<B: Board>(player: &mut Player, scenery: Scenery<B>) -> After {
    let rig = player.clip().rig();
    let views = [scenery.scene.view, scenery.scene.ahead];
    let after = with(&rig, display::<B::Layout>(), 0, views, |mut face| {
        info!(
            "{}: {} frames of {} ns, {} channels, {} of them moving; {} drive the face",
            scenery.entry.name,
            player.clip().frames(),
            player.clip().frame_time_ns(),
            player.clip().rig().channels(),
            player.clip().moving(),
            face.names()
        );
        let face: &mut dyn Show<B::Layout> = &mut face;
        play(player, face, scenery)
    });
    after.unwrap_or_else(no_model)
}

/// The model is the program's own; its bytes may have been damaged.
pub(super) fn no_model() -> After {
    error!("the face's model is no use");
    After::Exit(Exit::BadClip)
}
