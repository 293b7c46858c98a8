//! What a clip is drawn as (a body or bars), and the camera.

use crate::facts::Trouble;
use crate::picture::Picture;
use crate::source::Source;
use pantin::Pose;
use pantin_figure::camera::PIXEL_BITS;
use pantin_figure::ink::BodyPart;
use pantin_figure::lines::Line;
use pantin_figure::skeleton::Detail;
use pantin_figure::{Canvas, FigureRenderer, JointInfo, RIG_JOINTS, View};

/// Maximum number of joints of a figure: those of the rig, and the top of the head.
const JOINTS: usize = RIG_JOINTS + 1;
/// Number of poses that the camera setup visits, as [`FigureRenderer::aim`] does.
const SAMPLES: u32 = 48;
/// Maximum width of a bar in pixels.
const THICKEST: i32 = 24;

/// What the camera shows.
pub struct Actor {
    renderer: FigureRenderer<JOINTS>,
    /// Whether a figure stands on the stage.
    body: bool,
    bars: Option<Bars>,
}

/// Bars for the channels of a rig without joints: each extends from the middle by its fraction of full scale.
struct Bars {
    canvas: Canvas,
    first: usize,
}

impl Actor {
    /// Nothing to draw.
    pub const NOBODY: Actor = Actor { renderer: FigureRenderer::empty(), body: false, bars: None };

    /// Sets up figure and camera for a picture; the source stays at its frame.
    #[inline(never)]
    pub fn aim(&mut self, source: &mut Source, canvas: Canvas, view: View) -> Result<(), Trouble> {
        let rig = source.rig().ok_or(Trouble::Nothing)?;
        if rig.joint_count() == 0 {
            self.bars = (canvas.width > 0).then_some(Bars { canvas, first: rig.joint_channels() });
            return Ok(());
        }
        let now = source.frame();
        if !self.body {
            source.go(0);
            let mut room = [JointInfo::default(); RIG_JOINTS];
            let skeleton = self.renderer.skeleton_mut();
            skeleton.set_up(&rig, Detail::Body, source.pose(), &mut room)?;
            self.body = true;
        }
        #[cfg(feature = "character")]
        if let Source::Character(character) = source {
            let mut visited = Ok(());
            self.renderer.look_at(canvas, view, |visit| visited = visited.and(character.visit(visit)));
            self.place_at(character.pose(), character.stand());
            return visited;
        }
        self.renderer.look_at(canvas, view, |visit| sample(source, visit));
        self.place(source.go(now));
        Ok(())
    }

    /// Sets the pose.
    pub fn place(&mut self, pose: Pose<'_>) {
        if self.body {
            // It is of the source that the renderer was set up for.
            let _ = self.renderer.set_pose(pose);
        }
    }

    /// Sets the pose of a figure that stands somewhere in the world.
    #[cfg(feature = "character")]
    pub fn place_at(&mut self, pose: Pose<'_>, stand: pantin_figure::Stand) {
        if self.body {
            let _ = self.renderer.set_pose_at(pose, stand);
        }
    }

    /// Adds every stroke of a pose to `picture`, from far to near.
    pub fn each(&mut self, pose: &[i32], picture: &mut Picture) {
        let renderer = &mut self.renderer;
        if self.body {
            renderer.sort();
            if renderer.ground().dotted {
                renderer.each_dot(|dot| picture.add(dot.into()));
            } else {
                renderer.each_ground_line(|line| picture.add(line.into()));
            }
            renderer.each_bone(|line| picture.add(line.into()));
            if let Some(head) = renderer.head() {
                picture.add(head.into());
            }
        }
        if let Some(bars) = &self.bars {
            bars.each(pose, picture);
        }
    }
}

impl Bars {
    fn each(&self, pose: &[i32], picture: &mut Picture) {
        let bars = pose.get(self.first..).unwrap_or(&[]);
        let [width, height] = [self.canvas.width, self.canvas.height].map(|pixels| i32::from(pixels) << PIXEL_BITS);
        let (middle, count) = (width / 2, (bars.len() as i32).max(1));
        let breadth = (i32::from(self.canvas.height) / (2 * count)).clamp(1, THICKEST) as u8;
        let mut line = |from: [i32; 2], to: [i32; 2], body_part, shade, width| {
            let [from, to] = [from, to].map(|end| end.map(|place| place as i16));
            picture.add(Line { from, to, depth: 0, shade, body_part, width }.into());
        };
        line([middle, 0], [middle, height], BodyPart::Ground, 80, 1);
        for (index, raw) in (0..).zip(bars) {
            let y = (2 * index + 1) * height / (2 * count);
            line([middle, y], [middle + (((raw >> 16) * middle) >> 15), y], BodyPart::Left, 208, breadth);
        }
    }
}

/// Visits about [`SAMPLES`] poses of a clip.
fn sample(source: &mut Source, visit: &mut dyn FnMut(&[i32])) {
    let frames = source.playable();
    let mut frame = 0;
    while frame < frames {
        visit(source.go(frame).values);
        frame += frames.div_ceil(SAMPLES).max(1);
    }
}
