//! Draws a clip's face from one or several views, with the device's own code.

use super::draw::ROOM;
use anyhow::Result;
use pantin::Clip;
use pantin_face::{Binding, FaceRenderer, FaceView, MODEL, Model, Morph, Weights};
use pantin_figure::Canvas;
use pantin_figure::camera::PIXEL_BITS;
use pantin_figure::lines::Line;
use pantin_figure::solid::{HeadPose, SolidFigure};
use pantin_figure::surface::Surface;
use pantin_images::shades::HeadFace;

/// Returns whether a clip is a face without a body.
pub fn is_face(clip: &Clip) -> Result<bool> {
    Ok(clip.rig().joint_count() == 0 && has_face(clip)?)
}

/// Returns whether a clip has the scalars of a face.
fn has_face(clip: &Clip) -> Result<bool> {
    Ok(drives(clip, &Model::new_checked(MODEL)?))
}

/// Returns whether a clip has scalars that drive a model.
pub fn drives(clip: &Clip, model: &Model) -> bool {
    Binding::new(&clip.rig(), model).is_face()
}

/// A face that is drawn on the head of a solid figure.
pub struct OnHead<'c, 'f> {
    cast: &'c mut Cast<'f>,
    view: usize,
}

impl HeadFace for OnHead<'_, '_> {
    fn draw<S: Surface>(&mut self, surface: &mut S, head: &HeadPose) {
        let Cast { model, morph, looks, .. } = &mut *self.cast;
        looks[self.view].draw_on_head(model, morph, surface, head);
    }
}

/// A face that a clip drives, with a renderer for each view.
pub struct Cast<'f> {
    model: Model<'f>,
    binding: Binding,
    weights: Weights,
    morph: Box<Morph<ROOM>>,
    looks: Vec<FaceRenderer<ROOM>>,
    /// First column of its area.
    column: i16,
    side: u16,
}

impl<'f> Cast<'f> {
    /// Sets up Pantin's own face with a renderer for each view, or returns `None` for a clip that has no face. A clip with a body has its face in the square that
    /// the firmware gives it.
    pub fn of_clip(clip: &Clip, canvas: Canvas, views: &[pantin_figure::View]) -> Result<Option<Cast<'static>>> {
        Cast::of_model(Model::new_checked(MODEL)?, clip, canvas, views)
    }

    /// Like [`Cast::of_clip`], with the face of any model.
    pub fn of_model(model: Model<'f>, clip: &Clip, canvas: Canvas, views: &[pantin_figure::View]) -> Result<Option<Cast<'f>>> {
        if !drives(clip, &model) {
            return Ok(None);
        }
        let (canvas, column) = match clip.rig().joint_count() {
            0 => (canvas, 0),
            _ => (canvas.with_face().face, canvas.with_face().face_column),
        };
        let view = |view: &pantin_figure::View| FaceView { orbit: view.orbit, tilt: view.tilt };
        let looks = views.iter().map(|seen| FaceRenderer::new(&model, canvas, view(seen))).collect();
        let (binding, weights, morph) = (Binding::new(&clip.rig(), &model), Weights::new(), Box::new(Morph::new(&model)?));
        Ok(Some(Cast { model, binding, weights, morph, looks, column, side: canvas.width.min(canvas.height) }))
    }

    /// The face of a model on the heads of solid figures, one for each view, or `None` for a clip that has no face.
    pub fn on_heads<const N: usize>(model: Model<'f>, clip: &Clip, bodies: &[SolidFigure<N>]) -> Result<Option<Cast<'f>>> {
        if !drives(clip, &model) {
            return Ok(None);
        }
        let on_head = |body: &SolidFigure<N>| {
            let mut renderer = FaceRenderer::EMPTY;
            renderer.set_up_on_head(&model, body.head_radius());
            renderer
        };
        let looks = bodies.iter().map(on_head).collect();
        let (binding, weights, morph) = (Binding::new(&clip.rig(), &model), Weights::new(), Box::new(Morph::new(&model)?));
        Ok(Some(Cast { model, binding, weights, morph, looks, column: 0, side: 0 }))
    }

    /// The face of a pose, to be drawn on the head that the view with index `view` sees.
    pub fn on_head<'c>(&'c mut self, pose: &[i32], view: usize) -> OnHead<'c, 'f> {
        self.binding.read(pose, &mut self.weights);
        self.morph.apply(&self.model, &self.weights);
        OnHead { cast: self, view }
    }

    /// Pixels of the shorter side of its area.
    pub fn side(&self) -> u16 {
        self.side
    }

    /// Returns the lines of a pose from the view with index `view`.
    pub fn lines(&mut self, pose: &[i32], view: usize) -> Vec<Line> {
        self.binding.read(pose, &mut self.weights);
        self.morph.apply(&self.model, &self.weights);
        let renderer = &mut self.looks[view];
        renderer.project(&self.model, &self.morph);
        let mut lines = Vec::new();
        let moved = |[x, y]: [i16; 2]| [x + (self.column << PIXEL_BITS), y];
        renderer.each_line(&self.model, |line| lines.push(Line { from: moved(line.from), to: moved(line.to), ..line }));
        lines
    }
}
