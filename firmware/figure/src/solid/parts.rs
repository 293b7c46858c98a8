//! The parts of a figure: which circles a part is the hull of, how far away it counts as, and what it is made of.

use super::hull::Circle;
use super::joints::{Joints, NONE};
use super::look::{Look, Material, RADII, Radius};
use super::sizes::Sizes;
use super::tint::{Pattern, Tint};
use super::{HeadPose, Kind, MOST_PARTS};
use crate::camera::{MAGNIFICATION_BITS, magnification};
use crate::ink::BodyPart;
use crate::renderer::FigureRenderer;
use crate::rotation::RotationBackend;
use heapless::Vec;

/// Parts of a person.
pub(super) const HUMAN_PARTS: usize = 16;
/// Pelvis (0), chest, neck and head.
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

const WAIST: JointBit = 1;
const NECK_JOINT: JointBit = 2;
const HEAD_JOINT: JointBit = 4;

/// Radii at both ends of a side's parts.
static SEGMENTS: [[Radius; 2]; SIDE as usize] = [
    [Radius::Shoulder, Radius::Elbow],
    [Radius::Elbow, Radius::Wrist],
    [Radius::Wrist, Radius::Hand],
    [Radius::Hip, Radius::Knee],
    [Radius::Knee, Radius::Ankle],
    [Radius::Ankle, Radius::Toe],
];

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

impl Part {
    /// Nothing yet.
    #[inline(always)]
    pub(super) fn new() -> Self {
        let tint = Tint { rgb: [0; 3], grey: 0, pattern: Pattern::Dark };
        Part { circles: Vec::new(), tint, ends: [(0, 0); 2], covers: 0, right: false }
    }
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
    pub head: &'a HeadPose,
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
    #[inline(never)]
    pub(super) fn human_keys(&self, joints: &Joints, keys: &mut [i32; MOST_PARTS]) {
        let mix = |a: i32, b: i32, part: i32| a + (((b - a) * part) >> 8);
        let height = self.sizes.depth;
        let [arms, legs] = [joints.arms, joints.legs].map(|limbs| limbs.map(|limb| limb.map(|joint| self.joint(joint)[2])));
        let ends = arms[0][0] + arms[1][0] + legs[0][0] + legs[1][0];
        let trunk = (ends + 2 * self.waist(joints)[2]) / 6;
        let skull = self.head_depth(joints);
        // Under both thighs, so that trousers are one garment, but not behind an arm behind the back.
        let thighs = legs.map(|[hip, knee, _]| mix(hip, knee, 179));
        let pelvis = thighs[0].max(thighs[1]).max(trunk).min(trunk + height * 8 / 100);
        let [middle, rest @ ..] = keys.as_chunks_mut::<{ LIMBS as usize }>().0 else { return };
        *middle = [pelvis + height / 200, trunk, skull - height * 24 / 1000, skull - height * HEAD_OVER / 1000];
        for (side, limbs) in rest.as_flattened_mut().as_chunks_mut::<{ SIDE as usize }>().0.iter_mut().take(2).enumerate() {
            let [[shoulder, elbow, wrist], [hip, knee, ankle]] = [arms[side], legs[side]];
            *limbs = [
                mix(shoulder, elbow, 192),
                (elbow + wrist) / 2,
                mix(wrist, self.hand(joints, side)[2], 179),
                mix(hip, knee, 179),
                (knee + ankle) / 2,
                mix(ankle, self.foot(joints, side)[1][2], 154) - height / 200,
            ];
        }
        for (key, attachment) in keys.iter_mut().skip(HUMAN_PARTS).zip(self.look.attachments()) {
            *key = self.attached_key(joints, &attachment, thighs);
        }
    }

    /// The depth of the skull's middle.
    pub(super) fn head_depth(&self, joints: &Joints) -> i32 {
        let [.., away] = self.head.up;
        // The skull's radius is a known part of the height, and as long as the vectors.
        let radius = self.head.skull[2].max(1);
        self.joint(joints.head)[2]
            + away * self.sizes.skull[0] / 256 * self.sizes.depth / 1000 * self.sizes.skull_thousandths / radius
    }

    fn waist(&self, joints: &Joints) -> Place {
        match joints.waist {
            NONE => between(self.joint(joints.hips), self.joint(joints.neck), 102),
            waist => self.joint(waist),
        }
    }

    /// A part of a person but the head.
    #[inline(never)]
    pub(super) fn human(&self, joints: &Joints, part: u8, made: &mut Part) {
        let bit = |side: usize, index: usize| 8 << (6 * side + index);
        let circles = &mut made.circles;
        let mut add = |place: Place, radius: Radius| {
            // There is room for four.
            let _ = circles.push(self.circle(place, radius));
        };
        if part == NECK {
            let [from, to] = [joints.neck, joints.head].map(|joint| self.joint(joint));
            add(between(from, to, self.sizes.neck.into()), Radius::Neck);
            add(to, Radius::Neck);
            made.tint = self.look.tint(Material::Skin);
            made.ends = [(0, NECK_JOINT), (1, HEAD_JOINT)];
        } else if part < LIMBS {
            let (limbs, inwards, radius, material, covers) = match part {
                CHEST => (&joints.arms, 61, Radius::Chest, Material::Shirt, bit(0, 0) | bit(1, 0) | NECK_JOINT),
                _ => (&joints.legs, 26, Radius::Pelvis, Material::Trousers, bit(0, 3) | bit(1, 3)),
            };
            let ends = [limbs[0][0], limbs[1][0]].map(|joint| self.joint(joint));
            let middle = between(ends[0], ends[1], 128);
            ends.into_iter().for_each(|end| add(between(end, middle, inwards), radius));
            add(self.waist(joints), Radius::Waist);
            made.tint = self.look.tint(material);
            (made.ends[0], made.covers) = ((2, WAIST), covers);
        } else {
            let side = usize::from(part >= LIMBS + SIDE);
            let index = usize::from((part - LIMBS) % SIDE);
            let (limb, at) = if index < 3 { (&joints.arms[side], index) } else { (&joints.legs[side], index - 3) };
            let [from, to] = SEGMENTS[index];
            let mut far = self.joint(limb[(at + 1) % 3]);
            let is_end = at == 2;
            if index == 2 {
                far = self.hand(joints, side);
            } else if is_end {
                let [heel, toes] = self.foot(joints, side);
                add(heel, Radius::Heel);
                far = toes;
            }
            add(self.joint(limb[at]), from);
            add(far, to);
            made.ends[0] = (u8::from(index == 5), bit(side, index));
            if !is_end {
                made.ends[1] = (1, bit(side, index + 1));
            }
            let own = if side == 0 { Material::Left } else { Material::Right };
            let end = if side == 0 { Material::Left } else { Material::RightEnd };
            let material = [own, Material::Skin, end, Material::Trousers, Material::Trousers, end][index];
            made.tint = self.look.limb(material, if is_end { end } else { own });
            made.right = side == 1;
        }
        made.covers |= made.ends[0].1 | made.ends[1].1;
    }

    /// A bone of a rig that is no person's.
    #[inline(never)]
    pub(super) fn bone(&self, index: u8, made: &mut Part) {
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
        let units = (long / 6).max(self.sizes.height / 60).min(self.sizes.height / 22);
        let radius = self.figure.camera().length(units).max(8);
        let near = self.round(self.joint(parent), radius);
        let far = self.round(self.joint(index), radius * 3 / 4);
        let bit = |joint: u8| 1u64.checked_shl(joint.into()).unwrap_or(0);
        // There is room for four.
        let _ = made.circles.extend_from_slice(&[near, far]);
        made.tint = self.look.tint(material);
        made.ends = [(0, bit(parent)), (1, bit(index))];
        made.covers = bit(parent) | bit(index);
        made.right = body_part == BodyPart::Right;
    }
}
