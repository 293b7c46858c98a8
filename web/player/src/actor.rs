//! What a clip is drawn as, and from where it is seen: a body, a face, both side by side, or bars.

use crate::facts::Trouble;
use crate::picture::Stroke;
use crate::source::Source;
use pantin::Rig;
use pantin_face::{Binding, Model, Morph, VERTICES, Weights};
use pantin_figure::camera::PIXEL_BITS;
use pantin_figure::ink::Tone;
use pantin_figure::lines::Line;
use pantin_figure::skeleton::Detail;
use pantin_figure::{Canvas, RIG_JOINTS, Skeleton, Stage, View};

/// Pantin's own face: docs/FACE.md.
static MODEL: &[u8] = include_bytes!("../../../motions/face.model");

/// Joints of a figure: those of the rig, and a crown.
const JOINTS: usize = RIG_JOINTS + 1;
/// Poses in which a clip is looked at before it plays, as [`Stage::aim`] does.
const SAMPLES: u32 = 48;
/// Pixels that a bar is across at most.
const THICKEST: i32 = 24;

pub struct Face {
    model: Model<'static>,
    binding: Binding,
    morph: Morph<VERTICES>,
    look: pantin_face::Look<VERTICES>,
}

/// What stands before the camera.
pub struct Actor {
    pub stage: Option<Stage<JOINTS>>,
    pub face: Option<Face>,
    bars: Option<Bars>,
}

/// Channels that are neither body nor face: from the middle, as far as each is of its full scale.
struct Bars {
    canvas: Canvas,
    first: usize,
}

impl Face {
    fn of(rig: &Rig) -> Option<(Model<'static>, Binding)> {
        let model = Model::new_checked(MODEL).ok()?;
        let binding = Binding::of(rig, &model);
        binding.is_face().then_some((model, binding))
    }

    fn place(&mut self, pose: &[i32]) {
        let mut weights = Weights::new();
        self.binding.weigh(pose, &mut weights);
        self.morph.place(&self.model, &weights);
        self.look.project(&self.model, &self.morph);
    }
}

impl Actor {
    /// Nobody.
    pub const NONE: Actor = Actor { stage: None, face: None, bars: None };

    /// Sets everything up for a picture; leaves the source at the frame that it shows.
    #[inline(never)]
    pub fn aim(&mut self, source: &mut Source, canvas: Canvas, view: View) -> Result<(), Trouble> {
        let rig = source.rig().ok_or(Trouble::Nothing)?;
        if source.playable() == 0 {
            return Err(Trouble::Nothing);
        }
        let face = Face::of(&rig);
        let body = rig.joint_count() > 0;
        let [left, right] = parts(canvas, body && face.is_some());
        self.bars = (!body && face.is_none()).then_some(Bars { canvas, first: rig.joint_channels() });
        if body {
            let now = source.facts().frame;
            let skeleton = self.skeleton(source, &rig)?;
            self.stage = Some(Stage::new(skeleton, left, view, |visit| sample(source, visit)));
            source.go(now);
        }
        if let Some((model, binding)) = face {
            let ahead = View::default();
            let view = pantin_face::View { orbit: view.orbit - ahead.orbit, tilt: view.tilt - ahead.tilt };
            let mut look = pantin_face::Look::new(&model, right, view);
            look.shift((canvas.width - right.width) as i16, 0);
            let morph = Morph::new(&model).map_err(|_| Trouble::TooBig)?;
            self.face = Some(Face { model, binding, morph, look });
        }
        self.place(source.pose());
        Ok(())
    }

    /// That of the picture before, or a new one.
    fn skeleton(&self, source: &mut Source, rig: &Rig) -> Result<Skeleton<JOINTS>, Trouble> {
        if let Some(stage) = &self.stage {
            return Ok(stage.skeleton().clone());
        }
        source.go(0);
        let pose = source.pose();
        Ok(Skeleton::new(rig, Detail::Body, pose, source.length_exponent(), |joint| source.is_exponential(joint))?)
    }

    /// Takes a pose.
    pub fn place(&mut self, pose: &[i32]) {
        if let Some(stage) = &mut self.stage {
            stage.place(pose);
        }
        if let Some(face) = &mut self.face {
            face.place(pose);
        }
    }

    /// Shows everything of the pose that was placed last, from far to near.
    pub fn each(&mut self, pose: &[i32], show: &mut dyn FnMut(Stroke)) {
        if let Some(stage) = &mut self.stage {
            stage.sort();
            if stage.ground().dotted {
                stage.each_dot(|dot| show(dot.into()));
            } else {
                stage.each_ground_line(|line| show(line.into()));
            }
            stage.each_bone(|line| show(line.into()));
            if let Some(head) = stage.head() {
                show(head.into());
            }
        }
        if let Some(Face { model, look, .. }) = &self.face {
            look.lines(model, |line| show(line.into()));
        }
        if let Some(bars) = &self.bars {
            bars.each(pose, show);
        }
    }

    /// See [`crate::facts::Facts::kind`].
    pub fn kind(&self) -> u32 {
        match (&self.stage, &self.face) {
            (None, None) => 4,
            (body, face) => u32::from(body.is_some()) + 2 * u32::from(face.is_some()),
        }
    }
}

impl Bars {
    fn each(&self, pose: &[i32], show: &mut dyn FnMut(Stroke)) {
        let bars = pose.get(self.first..).unwrap_or(&[]);
        let [width, height] = [self.canvas.width, self.canvas.height].map(|pixels| i32::from(pixels) << PIXEL_BITS);
        let (middle, count) = (width / 2, (bars.len() as i32).max(1));
        let breadth = (i32::from(self.canvas.height) / (2 * count)).clamp(1, THICKEST) as u8;
        let mut line = |from: [i32; 2], to: [i32; 2], tone, shade, width| {
            let [from, to] = [from, to].map(|end| end.map(|place| place as i16));
            show(Line { from, to, depth: 0, shade, tone, width }.into());
        };
        line([middle, 0], [middle, height], Tone::Ground, 80, 1);
        for (index, raw) in (0..).zip(bars) {
            let y = (2 * index + 1) * height / (2 * count);
            line([middle, y], [middle + (((raw >> 16) * middle) >> 15), y], Tone::Left, 208, breadth);
        }
    }
}

/// Shows a clip in about [`SAMPLES`] poses.
fn sample(source: &mut Source, visit: &mut dyn FnMut(&[i32])) {
    let frames = source.playable();
    let mut frame = 0;
    while frame < frames {
        visit(source.go(frame));
        frame += frames.div_ceil(SAMPLES).max(1);
    }
}

/// The body's part of the picture, and the face's, whose right edges are the picture's; as the firmware divides its displays.
fn parts(canvas: Canvas, both: bool) -> [Canvas; 2] {
    if !both {
        return [canvas; 2];
    }
    let Canvas { width, height } = canvas;
    let wide = 2 * width >= 3 * height;
    let side = if wide { height } else { width / 5 * 2 };
    let body = if wide { width - side } else { width };
    [Canvas { width: body, height }, Canvas { width: side, height: side }]
}
