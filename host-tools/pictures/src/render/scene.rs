//! A frame of the figure as strokes in pixels, thicker the nearer they are: for what draws more finely than a display does.

use pantin::Pose;
use pantin_figure::FigureRenderer;
use pantin_figure::camera::PIXEL_BITS;
use pantin_figure::ink::BodyPart;
use pantin_figure::lines::Line;
use pantin_images::palette::{FARTHEST, NEAREST};

/// Widths of the farthest and the nearest bones, and of the ground's lines, as parts of the figure's height.
const FAR_WIDTH: f32 = 0.011;
const NEAR_WIDTH: f32 = 0.028;
const GROUND_WIDTH: f32 = 0.005;

/// A bone is set off from those behind it by so much paper on each side, in parts of its width.
const CLEARANCE: f32 = 0.35;
/// Where it joins others it is not: this number of its widths is left out at its ends. What is then less than a half has none.
const JOINT: f32 = 2.0;

/// A line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// One end: x, y.
    pub from: [f32; 2],
    /// The other end.
    pub to: [f32; 2],
    /// In pixels.
    pub width: f32,
    /// What it is of.
    pub body_part: BodyPart,
    /// Brightness.
    pub shade: u8,
}

impl Stroke {
    /// The paper about a bone, to be drawn before it.
    pub fn clearance(&self) -> Option<Stroke> {
        let along = [self.to[0] - self.from[0], self.to[1] - self.from[1]];
        let length = along[0].hypot(along[1]);
        let cut = JOINT * self.width / length;
        let at = |part: f32| [self.from[0] + along[0] * part, self.from[1] + along[1] * part];
        let width = self.width * (1.0 + 2.0 * CLEARANCE);
        (cut < 0.25).then(|| Stroke { from: at(cut), to: at(1.0 - cut), width, ..*self })
    }
}

/// A circle: the head, or a dot of the ground, which is full.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Its middle.
    pub centre: [f32; 2],
    /// To the middle of its line, in pixels.
    pub radius: f32,
    /// Of its line.
    pub width: f32,
    /// Brightness.
    pub shade: u8,
}

/// What is drawn, in this order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// The ground as lines.
    pub ground: Vec<Stroke>,
    /// The ground as dots: small pictures have them instead.
    pub dots: Vec<Disc>,
    /// From far to near.
    pub bones: Vec<Stroke>,
    /// The head, for a rig that names one.
    pub head: Option<Disc>,
    /// The lines of a face. Later ones lie over earlier ones, and none is set off from those behind it.
    pub face: Vec<Stroke>,
}

impl Scene {
    /// The frame of a pose, `factor` times as big as the stage has it.
    pub fn of<const N: usize>(renderer: &mut FigureRenderer<N>, pose: Pose<'_>, factor: f32) -> Scene {
        renderer.set_pose(pose).expect("the renderer was set up for this clip");
        Scene::of_placed(renderer, factor)
    }

    /// The frame of the pose that the renderer placed last.
    pub fn of_placed<const N: usize>(renderer: &mut FigureRenderer<N>, factor: f32) -> Scene {
        let unit = factor / f32::from(1u8 << PIXEL_BITS);
        let height = renderer.camera().length(renderer.skeleton().size) as f32 * unit;
        let lines = renderer.placed_lines();
        let place = |[x, y]: [i16; 2]| [f32::from(x) * unit, f32::from(y) * unit];
        let stroke = |line: &Line, width: f32| Stroke {
            from: place(line.from),
            to: place(line.to),
            width: (width * height).max(0.75),
            body_part: line.body_part,
            shade: line.shade,
        };
        Scene {
            ground: lines.ground.iter().map(|line| stroke(line, GROUND_WIDTH)).collect(),
            dots: lines
                .dots
                .iter()
                .map(|dot| Disc { centre: place(dot.place), radius: 0.5, width: 0.0, shade: dot.shade })
                .collect(),
            bones: lines.bones.iter().map(|line| stroke(line, width(line.shade))).collect(),
            head: lines.head.map(|head| Disc {
                centre: place(head.centre),
                radius: f32::from(head.radius) * unit,
                width: (width(head.shade) * height).max(0.75),
                shade: head.shade,
            }),
            face: Vec::new(),
        }
    }
}

/// Width of a face's lines, as a part of its area's shorter side.
const FACE_WIDTH: f32 = 0.0055;

impl Scene {
    /// Adds the lines of a face, `factor` times as big as they are given, in an area whose shorter side has `side` pixels.
    pub fn add_face(&mut self, lines: &[Line], factor: f32, side: f32) {
        let unit = factor / f32::from(1u8 << PIXEL_BITS);
        let place = |[x, y]: [i16; 2]| [f32::from(x) * unit, f32::from(y) * unit];
        let stroke = |line: &Line| Stroke {
            from: place(line.from),
            to: place(line.to),
            width: (FACE_WIDTH * side).max(1.0),
            body_part: line.body_part,
            shade: line.shade,
        };
        self.face.extend(lines.iter().map(stroke));
    }
}

/// Brightness depends on the depth.
fn width(shade: u8) -> f32 {
    let near = f32::from(shade.saturating_sub(FARTHEST)) / f32::from(NEAREST - FARTHEST);
    FAR_WIDTH + (NEAR_WIDTH - FAR_WIDTH) * near
}
