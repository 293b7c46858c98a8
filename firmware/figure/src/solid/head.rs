//! The head, which looks somewhere: skull and jaw in the hair's colour, and a face that moves across them with the gaze.

use super::hull::Circle;
use super::look::{Look, Material};
use super::paint::{Cut, Fill, Outline, Painter};
use super::tint::{Light, SHADE};
use crate::ink::Ink;
use crate::surface::Surface;

/// A head on the display. Vectors are as long as the skull's radius, in sixteenths of a pixel: right, down and away from the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HeadPose {
    /// The skull's middle and radius in sixteenths of a pixel.
    pub skull: [i32; 3],
    /// Where the head's upper side is.
    pub up: [i32; 3],
    /// Where the face looks.
    pub face: [i32; 3],
    /// Where the head's own left is.
    pub left: [i32; 3],
}

/// From this radius in sixteenths of a pixel on, eyes and nose have a shape.
const DETAILED: i32 = 7 << 4;

impl HeadPose {
    /// A place in 256ths of the skull's radius along face, up and left, from its middle.
    #[inline(never)]
    fn place(&self, [face, up, left]: [i32; 3]) -> [i32; 3] {
        let [x, y, _] = self.skull;
        let along = |axis: usize| (self.face[axis] * face + self.up[axis] * up + self.left[axis] * left) >> 8;
        [x + along(0), y + along(1), along(2)]
    }

    /// A circle about such a place.
    #[inline(never)]
    fn circle(&self, place: [i32; 3], radius: i32) -> Circle {
        let [x, y, _] = self.place(place);
        [x, y, radius]
    }

    /// Skull and jaw.
    pub(super) fn hull(&self) -> [Circle; 2] {
        [self.skull, self.circle([36, -90, 0], (self.skull[2] * 210) >> 8)]
    }

    /// How far the face looks at the camera: 256 if it looks straight at it, -256 if it looks away.
    pub fn toward(&self) -> i32 {
        (-self.face[2] * 256 / self.skull[2].max(1)).clamp(-256, 256)
    }

    /// Draws it. With `bare_face`, it has no nose and no eyes, and its face is as dark as an outline: another face is drawn on it.
    #[inline(never)]
    pub(super) fn draw<S: Surface>(&self, painter: &mut Painter<S>, look: &Look, light: Light, width: i32, bare_face: bool) {
        let (r, toward) = (self.skull[2], self.toward());
        let shade = |light: Light| ((u32::from(light) * SHADE) >> 8) as Light;
        let ink = |material: Material, light: Light| S::Ink::tint(&look.tint(material), light);
        let edge = ink(Material::Edge, 256);
        let outline = Outline { ink: edge, width, cuts: [Cut::None; 2] };
        let bare = Outline { width: 0, ..outline };
        let detailed = r >= DETAILED;
        let nose = |far: i32, radius: i32| self.circle([far, -56, 0], radius);
        let nose_radius = ((r * 43) >> 8).max(9);
        if toward < 26 && !bare_face {
            painter.hull(&[nose(271, nose_radius)], false, &outline, &Fill::Plain(ink(Material::Nose, light)));
        }
        let hull = self.hull();
        // One and a half of it stays within the margin.
        let side = (r >> 6).min(9);
        let shaded = |material: Material, side: i32| {
            let (lit, dark) = (ink(material, light), ink(material, shade(light)));
            if S::Ink::SHADED && detailed { Fill::Shaded(lit, dark, [side, side * 3 / 2]) } else { Fill::Plain(lit) }
        };
        let hair = match S::Ink::TONES {
            true => shaded(Material::Hair, side.max(1)),
            false => Fill::Rimmed(ink(Material::Face, 256), ink(Material::Hair, 256)),
        };
        painter.hull(&hull, false, &outline, &hair);
        if bare_face {
            return self.face(painter, toward, &hull, &Fill::Plain(edge));
        }
        self.face(painter, toward, &hull, &shaded(Material::Face, (side / 2).max(1)));
        self.eyes(painter, toward, detailed, &ink(Material::Eye, 256), &bare);
        if toward >= 26 && detailed {
            let dark = ink(Material::Face, shade(light));
            painter.hull(&[nose(258, nose_radius)], false, &bare, &Fill::Plain(dark));
            let [x, y, radius] = nose(258, nose_radius);
            painter.hull(&[[x - r / 20, y - r / 16, radius * 3 / 4]], false, &bare, &Fill::Plain(ink(Material::Nose, light)));
        } else if (26..214).contains(&toward) && !detailed {
            // In profile: more than 0.55 of the gaze is across.
            painter.hull(&[nose(293, nose_radius)], false, &bare, &Fill::Plain(ink(Material::Nose, light)));
        }
    }

    /// The face, which is a circle, as far as it lies within the head.
    fn face<S: Surface>(&self, painter: &mut Painter<S>, toward: i32, hull: &[Circle], fill: &Fill<S::Ink>) {
        let r = self.skull[2];
        let size = if toward < 0 { 205 + toward * 141 / 256 } else { 215 };
        if size <= 38 || toward <= -192 {
            return;
        }
        let ahead = 133 + 192 * (-toward).max(0) / 256;
        painter.clipped(self.circle([ahead, -51, 0], (r * size) >> 8), hull, fill);
    }

    fn eyes<S: Surface>(&self, painter: &mut Painter<S>, toward: i32, detailed: bool, ink: &S::Ink, bare: &Outline<S::Ink>) {
        if toward < -90 {
            return;
        }
        let r = self.skull[2];
        for side in [-1, 1] {
            if detailed {
                let away = self.place([236, 5, side * 99])[2];
                if -away * 8 > r {
                    let radius = (r / 10).max(8);
                    let eye = [self.circle([220, -20, side * 92], radius), self.circle([220, 20, side * 92], radius)];
                    painter.hull(&eye, false, bare, &Fill::Plain(*ink));
                }
            } else {
                let [x, y, away] = self.place([205, 0, side * 115]);
                if -away * 4 > r {
                    let (x, y) = (x >> 4, (y + r / 10) >> 4);
                    let [columns, rows] = painter.surface.size();
                    if (0..columns).contains(&x) && (0..rows).contains(&y) {
                        let cursor = painter.surface.cursor(x, y);
                        painter.surface.put(cursor, *ink);
                        painter.surface.mark([x, y], [x, y]);
                    }
                }
            }
        }
    }
}
