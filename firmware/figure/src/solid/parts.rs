//! The parts of a figure: which circles a part is the hull of, how far away it counts as, and what it is made of.

use super::hull::Circle;
use super::joints::{Joints, Limb, NONE};
use super::look::{Look, Material, RADII, Radius};
use super::sizes::Sizes;
use super::tint::Tint;
use super::{Head, Kind};
use crate::camera::{MAGNIFICATION_BITS, magnification};
use crate::ink::BodyPart;
use crate::renderer::FigureRenderer;
use crate::rotation::RotationBackend;
use heapless::Vec;

/// Parts of a person.
pub(super) const HUMAN_PARTS: usize = 16;
const PELVIS: u8 = 0;
const CHEST: u8 = 1;
const NECK: u8 = 2;
pub(super) const HEAD: u8 = 3;
/// The first part of the left side; those of the right side follow.
const LIMBS: u8 = 4;
const SIDE: u8 = 6;
/// Thousandths of the height by which the head counts as nearer than the skull's middle.
pub(super) const HEAD_OVER: i32 = 30;

/// A joint where parts meet, as a bit: the outline of a part that is drawn later is open there.
pub(super) type JointBit = u64;

/// A part on the display.
pub(super) struct Part {
    pub circles: Vec<Circle, 4>,
    pub tint: Tint,
    /// Circles at joints, and the joints.
    pub ends: [(u8, JointBit); 2],
    /// Joints that it covers.
    pub covers: JointBit,
    /// Whether it is of the right side, which is a little darker.
    pub right: bool,
}

/// A place on the display: sixteenths of a pixel right and down, and depth.
pub(super) type Place = [i32; 3];

/// Between two places: `part` of 256 from the first to the second, or beyond.
#[inline(never)]
pub(super) fn between(a: Place, b: Place, part: i32) -> Place {
    core::array::from_fn(|axis| a[axis] + (((b[axis] - a[axis]) * part) >> 8))
}

/// A posed figure, ready to be taken apart.
pub(super) struct Body<'a, const N: usize, R: RotationBackend> {
    pub figure: &'a FigureRenderer<N, R>,
    pub kind: &'a Kind,
    pub sizes: &'a Sizes,
    pub look: &'a Look,
    pub head: &'a Head,
}

impl<const N: usize, R: RotationBackend> Body<'_, N, R> {
    /// Where a joint is.
    #[inline(never)]
    pub(super) fn joint(&self, joint: u8) -> Place {
        let Some(visible) = self.figure.visible(joint) else { return [0; 3] };
        [visible.place[0].into(), visible.place[1].into(), visible.depth.into()]
    }

    #[inline(always)]
    fn circle(&self, place: Place, radius: Radius) -> Circle {
        self.round(place, self.sizes.radii[radius as usize % RADII].into())
    }

    #[inline(never)]
    fn round(&self, [x, y, depth]: Place, radius: i32) -> Circle {
        [x, y, (radius * magnification(depth)) >> MAGNIFICATION_BITS]
    }

    /// The end of a hand.
    fn hand(&self, joints: &Joints, side: usize) -> Place {
        let [_, elbow, wrist] = joints.arms[side].map(|joint| self.joint(joint));
        let ratio = self.sizes.hands[side].into();
        match joints.fingers[side] {
            NONE => between(elbow, wrist, 256 + i32::from(self.sizes.hands[side])),
            fingers => between(wrist, self.joint(fingers), ratio),
        }
    }

    /// Heel and toes.
    pub(super) fn foot(&self, joints: &Joints, side: usize) -> [Place; 2] {
        let [_, knee, ankle] = joints.legs[side].map(|joint| self.joint(joint));
        let ratio = i32::from(self.sizes.toes[side]);
        let far = match joints.toes[side] {
            NONE => {
                let [x, y, _] = self.head.face;
                [ankle[0] + x, ankle[1] + y, ankle[2]]
            }
            toes => self.joint(toes),
        };
        let [down, back] = self.sizes.heels[side].map(i32::from);
        let below = between(knee, ankle, 256 + down);
        let behind = between(ankle, far, -back);
        let heel = core::array::from_fn(|axis| below[axis] + behind[axis] - ankle[axis]);
        [heel, between(ankle, far, ratio)]
    }

    /// How far away the parts of a person count as, in units of depth. Upper arm and thigh count as what is farther from the trunk, so that
    /// they lie over it or under it as a whole.
    pub(super) fn human_keys(&self, joints: &Joints, keys: &mut [i16]) {
        let depth = |joint: u8| self.joint(joint)[2];
        let mix = |a: i32, b: i32, part: i32| a + (((b - a) * part) >> 8);
        let height = self.sizes.depth;
        let ends = |limbs: &[Limb; 2]| depth(limbs[0][0]) + depth(limbs[1][0]);
        let trunk = (ends(&joints.arms) + 2 * self.waist(joints)[2] + ends(&joints.legs)) / 6;
        let skull = self.head_depth(joints);
        let mut set = |part: u8, key: i32| {
            if let Some(place) = keys.get_mut(usize::from(part)) {
                *place = key.clamp(i16::MIN.into(), i16::MAX.into()) as i16;
            }
        };
        // Under both thighs, so that trousers are one garment, but not behind an arm behind the back.
        let thighs = joints.legs.map(|[hip, knee, _]| mix(depth(hip), depth(knee), 179));
        let pelvis = thighs[0].max(thighs[1]).clamp(trunk, trunk + height * 8 / 100);
        set(PELVIS, pelvis + height / 200);
        set(CHEST, trunk);
        set(NECK, skull - height * 24 / 1000);
        set(HEAD, skull - height * HEAD_OVER / 1000);
        for side in 0..2 {
            let first = LIMBS + SIDE * side as u8;
            let [shoulder, elbow, wrist] = joints.arms[side].map(depth);
            let [hip, knee, ankle] = joints.legs[side].map(depth);
            set(first, mix(shoulder, elbow, 192));
            set(first + 1, (elbow + wrist) / 2);
            set(first + 2, mix(wrist, self.hand(joints, side)[2], 179));
            set(first + 3, mix(hip, knee, 179));
            set(first + 4, (knee + ankle) / 2);
            set(first + 5, mix(ankle, self.foot(joints, side)[1][2], 154) - height / 200);
        }
        for (part, attachment) in (HUMAN_PARTS as u8..).zip(self.look.attachments()) {
            set(part, self.attached_key(joints, &attachment, thighs));
        }
    }

    /// The depth of the skull's middle.
    pub(super) fn head_depth(&self, joints: &Joints) -> i32 {
        let [.., away] = self.head.up;
        // The skull's radius is a known part of the height, and as long as the vectors.
        let radius = self.head.skull[2].max(1);
        self.joint(joints.head)[2]
            + away * self.sizes.skull[0] / 256 * self.sizes.depth / 1000 * i32::from(self.skull_thousandths()) / radius
    }

    fn skull_thousandths(&self) -> u8 {
        self.look.radius(Radius::Skull, self.sizes.small)
    }

    fn waist(&self, joints: &Joints) -> Place {
        match joints.waist {
            NONE => between(self.joint(joints.hips), self.joint(joints.neck), 102),
            waist => self.joint(waist),
        }
    }

    /// A part of a person but the head.
    #[inline(never)]
    pub(super) fn human(&self, joints: &Joints, part: u8) -> Part {
        const WAIST: JointBit = 1;
        const NECK_JOINT: JointBit = 2;
        const HEAD_JOINT: JointBit = 4;
        let limb_joint = |side: usize, index: usize| 8 << (6 * side + index);
        let both = |index: usize| limb_joint(0, index) | limb_joint(1, index);
        let plain = |material: Material| self.look.tint(material);
        let pair = |limbs: &[Limb; 2], inwards: i32, radius: Radius| {
            let [left, right] = [self.joint(limbs[0][0]), self.joint(limbs[1][0])];
            let middle = between(left, right, 128);
            [left, right].map(|end| self.circle(between(end, middle, inwards), radius))
        };
        let waist = || self.circle(self.waist(joints), Radius::Waist);
        let make = |circles: &[Circle], tint: Tint, ends: [(u8, JointBit); 2], right: bool| {
            let covers = ends[0].1 | ends[1].1;
            // At most 3.
            Part { circles: Vec::from_slice(circles).unwrap_or_default(), tint, ends, covers, right }
        };
        match part {
            PELVIS | CHEST => {
                let (limbs, inwards, radius, material) = match part {
                    CHEST => (&joints.arms, 61, Radius::Chest, Material::Shirt),
                    _ => (&joints.legs, 26, Radius::Pelvis, Material::Trousers),
                };
                let [left, right] = pair(limbs, inwards, radius);
                let mut part_made = make(&[left, right, waist()], plain(material), [(2, WAIST), (0, 0)], false);
                part_made.covers |= if part == CHEST { both(0) | NECK_JOINT } else { both(3) };
                part_made
            }
            NECK => {
                let [from, to] = [joints.neck, joints.head].map(|joint| self.joint(joint));
                let ends = [between(from, to, self.sizes.neck.into()), to].map(|place| self.circle(place, Radius::Neck));
                make(&ends, plain(Material::Skin), [(0, NECK_JOINT), (1, HEAD_JOINT)], false)
            }
            _ => {
                let side = usize::from(part >= LIMBS + SIDE);
                let index = usize::from((part - LIMBS) % SIDE);
                let own = if side == 0 { Material::Left } else { Material::Right };
                let end = if side == 0 { Material::Left } else { Material::RightEnd };
                let limb = |of: Material| self.look.limb(of, own);
                let [shoulder, elbow, wrist] = joints.arms[side];
                let [hip, knee, ankle] = joints.legs[side];
                let at = |joint: u8, radius: Radius| self.circle(self.joint(joint), radius);
                let ends = [(0, limb_joint(side, index)), (1, limb_joint(side, index + 1))];
                let right = side == 1;
                match index {
                    0 => make(&[at(shoulder, Radius::Shoulder), at(elbow, Radius::Elbow)], limb(own), ends, right),
                    1 => make(&[at(elbow, Radius::Elbow), at(wrist, Radius::Wrist)], limb(Material::Skin), ends, right),
                    2 => {
                        let far = self.circle(self.hand(joints, side), Radius::Hand);
                        make(&[at(wrist, Radius::Wrist), far], self.look.limb(end, end), [ends[0], (0, 0)], right)
                    }
                    3 => make(&[at(hip, Radius::Hip), at(knee, Radius::Knee)], limb(Material::Trousers), ends, right),
                    4 => make(&[at(knee, Radius::Knee), at(ankle, Radius::Ankle)], limb(Material::Trousers), ends, right),
                    _ => {
                        let [heel, toes] = self.foot(joints, side);
                        let circles = [self.circle(heel, Radius::Heel), at(ankle, Radius::Ankle), self.circle(toes, Radius::Toe)];
                        make(&circles, self.look.limb(end, end), [(1, ends[0].1), (0, 0)], right)
                    }
                }
            }
        }
    }

    /// A bone of a rig that is no person's.
    #[inline(never)]
    pub(super) fn bone(&self, index: u8) -> Part {
        let bones = &self.figure.skeleton().bones;
        let bone = bones.get(usize::from(index));
        let parent = bone.and_then(|bone| bone.parent).unwrap_or(index);
        let body_part = bone.map_or(BodyPart::Middle, |bone| bone.body_part);
        let material = match body_part {
            BodyPart::Left => Material::Left,
            BodyPart::Right => Material::Right,
            _ => Material::Shirt,
        };
        // Long bones are thicker, within what keeps a figure one.
        let long = bone.map_or(0, |bone| crate::joint_info::length(bone.offset.map(i32::from)));
        let units = (long / 6).clamp(self.sizes.height / 60, self.sizes.height / 22);
        let radius = self.figure.camera().length(units).max(8);
        let near = self.round(self.joint(parent), radius);
        let far = self.round(self.joint(index), radius * 3 / 4);
        let bit = |joint: u8| 1u64.checked_shl(joint.into()).unwrap_or(0);
        Part {
            circles: Vec::from_slice(&[near, far]).unwrap_or_default(),
            tint: self.look.tint(material),
            ends: [(0, bit(parent)), (1, bit(index))],
            covers: bit(parent) | bit(index),
            right: body_part == BodyPart::Right,
        }
    }
}
