//! Attachments on the display: where their circles are, and how far away they count as.

use super::hull::Circle;
use super::joints::{Joints, Limb};
use super::look::{Anchor, Attachment, Radius};
use super::parts::{Body, Part, Place, between};
use crate::camera::{MAGNIFICATION_BITS, magnification};
use crate::renderer::FigureRenderer;
use crate::rotation::{RotationBackend, Vector};
use pantin_math::vector::{cross, direction, sub};

/// An anchor on the display. Axes are right, down and away.
struct Frame {
    origin: Place,
    /// Left, up and ahead, as long as `length`.
    axes: [Vector; 3],
    /// Sixteenths of a pixel, and the same in thousandths of the figure's height.
    length: i32,
    thousandths: i32,
}

/// Thousandths of the height by which an attachment counts as nearer than it is: it lies over what it hangs on.
const OVER: i32 = 4;

impl Frame {
    /// A vector of thousandths of the height, times `length`.
    fn along(&self, [left, up, ahead, _]: [i32; 4]) -> Vector {
        let [[a, b, c], [d, e, f], [g, h, i]] = self.axes;
        [a * left + d * up + g * ahead, b * left + e * up + h * ahead, c * left + f * up + i * ahead]
    }

    fn circle(&self, place: [i32; 4]) -> Circle {
        let ([x, y, _], thousandths) = (self.along(place), self.thousandths.max(1));
        [self.origin[0] + x / thousandths, self.origin[1] + y / thousandths, place[3] * self.length / thousandths]
    }
}

/// The direction from a joint to another one, 2^15 long; nothing if they are in one place.
#[inline(never)]
pub(super) fn way<const N: usize, R: RotationBackend>(figure: &FigureRenderer<N, R>, from: u8, to: u8) -> Vector {
    let place = |joint: u8| figure.joints().position(joint.into());
    direction(sub(place(to), place(from))).map_or([0; 3], |(v, _)| v)
}

impl<const N: usize, R: RotationBackend> Body<'_, N, R> {
    /// The anchor of a place.
    #[inline(never)]
    fn frame(&self, joints: &Joints, anchor: Anchor, left: i32) -> Frame {
        if anchor == Anchor::Head {
            let [x, y, radius] = self.head.skull;
            let thousandths = self.look.radius(Radius::Skull, self.sizes.small);
            return Frame {
                origin: [x, y, self.head_depth(joints)],
                axes: [self.head.left, self.head.up, self.head.face],
                length: radius.max(1),
                thousandths: thousandths.max(1).into(),
            };
        }
        let way = |from: u8, to: u8| way(self.figure, from, to);
        let pair = |limbs: &[Limb; 2]| limbs.map(|limb| limb[0]);
        let [one, other] = pair(if anchor == Anchor::Chest { &joints.arms } else { &joints.legs });
        let leftward = way(other, one);
        let [hip, knee, _] = joints.legs[usize::from(left < 0)];
        let (origin, up) = match anchor {
            Anchor::Thighs => (self.joint(hip), way(knee, hip)),
            _ => (between(self.joint(one), self.joint(other), 128), way(joints.hips, joints.neck)),
        };
        // Below 2^15, so that products stay within 32 bits.
        let length = ((self.sizes.pixels.min(1 << 14) * magnification(origin[2])) >> MAGNIFICATION_BITS).clamp(1, (1 << 15) - 1);
        let axes = [leftward, up, cross(leftward, up)].map(|axis| axis.map(|part| (part * length) >> 15));
        Frame { origin, axes, length, thousandths: 1000 }
    }

    /// Where an attachment is.
    #[inline(never)]
    pub(super) fn attached(&self, joints: &Joints, attachment: &Attachment, made: &mut Part) {
        for place in attachment.circles() {
            let _ = made.circles.push(self.frame(joints, attachment.anchor, place[0]).circle(place));
        }
        made.tint = attachment.tint;
    }

    /// How far away an attachment counts as: a skirt as much as the nearer thigh, whose depths are `thighs`.
    #[inline(never)]
    pub(super) fn attached_key(&self, joints: &Joints, attachment: &Attachment, thighs: [i32; 2]) -> i32 {
        let thousandth = |count: i32| self.sizes.depth * count / 1000;
        if attachment.anchor == Anchor::Thighs {
            return thighs[0].min(thighs[1]) - thousandth(OVER);
        }
        let frame = self.frame(joints, attachment.anchor, 0);
        let away: i32 = attachment.circles().map(|place| frame.along(place)[2] / frame.length.max(1)).sum();
        let over = if attachment.anchor == Anchor::Head { super::parts::HEAD_OVER } else { 0 };
        frame.origin[2] + thousandth(away / attachment.circles().len().max(1) as i32 - over - OVER)
    }
}
