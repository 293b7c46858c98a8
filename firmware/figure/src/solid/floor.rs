//! What the figure stands on: a disc, the floor's lines or dots, and the figure's shadow.

use super::joints::{Joints, NONE};
use super::joints_of;
use super::look::Material;
use super::paint::{Cut, Fill, Outline, Painter};
use super::parts::{Body, Place, between};
use crate::camera::{Level, MAGNIFICATION_BITS, magnification};
use crate::ink::Ink;
use crate::rotation::RotationBackend;
use crate::surface::Surface;

impl<const N: usize, R: RotationBackend> Body<'_, N, R> {
    /// A disc on the floor, in the hull's heights of 4.
    #[inline(never)]
    fn disc(&self, [x, y, depth]: Place, thousandths: i32) -> [i32; 3] {
        [x, y * 4, (self.sizes.pixels * thousandths / 1000 * magnification(depth)) >> MAGNIFICATION_BITS]
    }

    /// Draws the floor, if it is wanted, and the shadow of a person.
    #[inline(never)]
    pub(super) fn draw_floor<S: Surface>(&self, painter: &mut Painter<S>, whole: bool) {
        let joints = joints_of(self.kind);
        let ink = |material: Material| S::Ink::tint(&self.look.tint(material), 256);
        let (edge, shadow, floor) = (ink(Material::Edge), ink(Material::Shadow), ink(Material::Floor));
        let bare = Outline { ink: edge, width: 0, cuts: [Cut::None; 2] };
        let hips = joints.map_or(self.figure.skeleton().hips as u8, |joints| joints.hips);
        let ground = self.figure.ground_level();
        if S::Ink::HUES && whole {
            let stage = self.disc(self.figure.below(hips, &ground), 620);
            painter.hull(&[stage], true, &bare, &Fill::Plain(ink(Material::Stage)));
        }
        if whole {
            self.figure.draw_ground(painter.surface, false, Some(floor));
        }
        if let Some(joints) = joints {
            let fill = if S::Ink::TONES { Fill::Plain(shadow) } else { Fill::Dotted(shadow, edge) };
            self.draw_shadow(painter, joints, &ground, &bare, &fill);
        }
    }

    /// Discs below hips, chest and feet, which shrink as the lower foot leaves the floor.
    fn draw_shadow<S: Surface>(
        &self,
        painter: &mut Painter<S>,
        joints: &Joints,
        ground: &Level,
        bare: &Outline<S::Ink>,
        fill: &Fill<S::Ink>,
    ) {
        let below = |joint: u8| self.figure.below(joint, ground);
        let middle = |a: u8, b: u8| between(below(a), below(b), 128);
        let [ankles, shoulders] = [joints.legs.map(|[.., ankle]| ankle), joints.arms.map(|[shoulder, ..]| shoulder)];
        let above = ankles.iter().map(|ankle| below(*ankle)[1] - self.joint(*ankle)[1]);
        let height = above.min().unwrap_or(0).max(0);
        // From 1 on the floor to 0.45.
        let scale = (256 - height * 154 / self.sizes.pixels.max(1)).clamp(115, 256);
        let hips = self.disc(below(joints.hips), 105 * scale / 256);
        let foot = |ankle: u8, toes: u8| (ankle, if toes == NONE { ankle } else { toes }, 70);
        let feet = [foot(ankles[0], joints.toes[0]), foot(ankles[1], joints.toes[1])];
        for (from, to, thousandths) in [(shoulders[0], shoulders[1], 84), feet[0], feet[1]] {
            painter.hull(&[hips, self.disc(middle(from, to), thousandths * scale / 256)], true, bare, fill);
        }
    }
}
