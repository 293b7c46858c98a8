//! What the figure stands on: a disc, the floor's lines or dots, and the figure's shadow.

use super::joints::{Joints, NONE};
use super::look::Material;
use super::paint::{Cut, Fill, Outline, Painter};
use super::parts::{Body, Place};
use crate::camera::{Level, MAGNIFICATION_BITS, magnification};
use crate::ink::Ink;
use crate::lines::pixel;
use crate::raster::{Dots, line};
use crate::rotation::RotationBackend;
use crate::surface::Surface;

impl<const N: usize, R: RotationBackend> Body<'_, N, R> {
    /// A disc on the floor, in the hull's heights of 4.
    #[inline(never)]
    fn disc(&self, [x, y, depth]: Place, thousandths: i32) -> [i32; 3] {
        [x, y * 4, (self.sizes.pixels * thousandths / 1000 * magnification(depth)) >> MAGNIFICATION_BITS]
    }

    /// Draws the floor, and the shadow of a person.
    #[inline(never)]
    pub(super) fn draw_floor<S: Surface>(&self, painter: &mut Painter<S>, joints: Option<&Joints>) {
        let ink = |material: Material| S::Ink::tint(&self.look.tint(material), 256);
        let (edge, shadow, floor) = (ink(Material::Edge), ink(Material::Shadow), ink(Material::Floor));
        let bare = Outline { ink: edge, width: 0, cuts: [Cut::None; 2] };
        let hips = joints.map_or(self.figure.skeleton().hips as u8, |joints| joints.hips);
        let ground = self.figure.ground_level();
        if S::Ink::HUES {
            let stage = self.disc(self.figure.below(hips, &ground), 620);
            painter.hull(&[stage], true, &bare, &Fill::Plain(ink(Material::Stage)));
        }
        if self.figure.ground().dotted {
            let mut dots = Dots::on(painter.surface);
            self.figure.each_dot(|dot| dots.put([pixel(dot.place[0]), pixel(dot.place[1])], floor));
            dots.mark();
        } else {
            self.figure.each_ground_line(|ground| {
                line(painter.surface, ground.from.map(pixel), ground.to.map(pixel), floor);
            });
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
        let middle = |a: Place, b: Place| core::array::from_fn(|axis| (a[axis] + b[axis]) / 2);
        let hips = below(joints.hips);
        let chest = middle(below(joints.arms[0][0]), below(joints.arms[1][0]));
        let feet = joints.legs.map(|[.., ankle]| (self.joint(ankle), below(ankle)));
        let height = feet.iter().map(|(ankle, floor)| floor[1] - ankle[1]).min().unwrap_or(0).max(0);
        // From 1 on the floor to 0.45.
        let part = |thousandths: i32| thousandths * (256 - height * 154 / self.sizes.pixels).clamp(115, 256) / 256;
        painter.hull(&[self.disc(hips, part(105)), self.disc(chest, part(84))], true, bare, fill);
        for (side, (_, floor)) in feet.into_iter().enumerate() {
            let toes = joints.toes[side];
            let foot = if toes == NONE { floor } else { middle(floor, below(toes)) };
            painter.hull(&[self.disc(hips, part(105)), self.disc(foot, part(70))], true, bare, fill);
        }
    }
}
