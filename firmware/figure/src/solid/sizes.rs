//! A figure's lengths on the display, worked out when its camera is set up.

use super::joints::{Joints, NONE};
use super::look::{Look, RADII, Radius};
use crate::camera::Canvas;
use crate::joint_info::length;
use crate::renderer::FigureRenderer;
use crate::rotation::RotationBackend;
use crate::skeleton::Bone;

/// Figures of fewer pixels have thicker limbs and a larger head.
const SMALL: i32 = 80 << 4;

/// Lengths of a figure. Ratios have 8 fraction bits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sizes {
    /// The height of a person in figure units: 2.04 times thigh and shin, which are 0.49 of it. Of other rigs, their size.
    pub height: i32,
    /// The same in sixteenths of a pixel at the target's distance.
    pub pixels: i32,
    /// The same in units of depth.
    pub depth: i32,
    /// Radii in sixteenths of a pixel at the target's distance, by [`Radius`].
    pub radii: [i16; RADII],
    /// The skull's centre above and before the head's joint, in 256ths of its radius.
    pub skull: [i32; 2],
    /// The skull's radius in thousandths of the height.
    pub skull_thousandths: i32,
    /// Another face than that of the figure is drawn on the head.
    pub bare_face: bool,
    /// How far the hand goes on beyond the wrist, as a part of the way from the wrist to [`Joints::fingers`], or without them of the forearm.
    pub hands: [i16; 2],
    /// Where the neck starts, as a part of the way from its joint to the head: some rigs have it deep in the chest.
    pub neck: i16,
    /// The toes' place as a part of the way from the ankle to [`Joints::toes`], or without them in skull radii before the ankle.
    pub toes: [i16; 2],
    /// The heel's place: below the ankle as a part of the shin, and behind it as a part of the way to [`Joints::toes`].
    pub heels: [[i16; 2]; 2],
    /// Pixels of an outline.
    pub outline: i32,
    /// The look's smaller figures.
    pub small: bool,
}

impl Sizes {
    /// No figure.
    pub(super) const NOTHING: Sizes = Sizes {
        height: 1,
        pixels: 16,
        depth: 1,
        radii: [0; RADII],
        skull: [0; 2],
        skull_thousandths: 1,
        bare_face: false,
        hands: [0; 2],
        neck: 0,
        toes: [0; 2],
        heels: [[0; 2]; 2],
        outline: 1,
        small: true,
    };

    /// For a figure whose camera is set up.
    #[inline(never)]
    pub(super) fn new<const N: usize, R: RotationBackend>(
        figure: &FigureRenderer<N, R>,
        joints: Option<&Joints>,
        look: &Look,
        bare_face: bool,
    ) -> Sizes {
        let bones = &figure.skeleton().bones;
        let mut sizes = Sizes { height: figure.skeleton().size, ..Sizes::NOTHING };
        if let Some(joints) = joints {
            sizes.height = height(bones, joints);
            sizes.extremities(bones, joints);
        }
        sizes.pixels = figure.camera().length(sizes.height).max(1);
        let (_, size, _) = figure.camera().framing();
        // A size is 2^13 units of depth; a height has at most 19 bits.
        sizes.depth = ((sizes.height >> 3) * (1 << 10) / (size >> 6).max(1)).max(1);
        sizes.small = sizes.pixels < SMALL;
        let pixels = |thousandths: i32| (sizes.pixels * thousandths / 1000).clamp(1, 1 << 11) as i16;
        for (radius, thousandths) in sizes.radii.iter_mut().zip(look.radii(sizes.small)) {
            *radius = pixels((*thousandths).into());
        }
        let larger = if bare_face { larger_skull(figure.canvas()) } else { 0 };
        let skull = i32::from(look.radius(Radius::Skull, sizes.small)).max(1) + larger;
        if bare_face {
            sizes.radii[Radius::Skull as usize] = pixels(skull);
        }
        (sizes.skull_thousandths, sizes.bare_face) = (skull, bare_face);
        // A larger skull stays on the neck.
        sizes.skull = [(HEAD_MIDDLE + larger * 7 / 8) * 256 / skull, 12 * 256 / skull];
        // A figure that reaches beyond the display has no thicker outline than one that fills it.
        let most = i32::from(figure.canvas().height) << 4;
        sizes.outline = ((sizes.pixels.min(most) + 8) / (i32::from(look.outline()).max(1) * 16)).clamp(1, 8);
        sizes
    }

    fn extremities(&mut self, bones: &[Bone], joints: &Joints) {
        let height = self.height >> 4;
        let part = |thousandths: i32, of: i32| ratio(height, thousandths, of);
        // The last 0.075 of the height.
        self.neck = (256 - part(75, way(bones, joints.neck, joints.head))).max(0);
        for side in 0..2 {
            let ([_, elbow, wrist], [_, knee, ankle]) = (joints.arms[side], joints.legs[side]);
            let (fingers, toes) = (joints.fingers[side], joints.toes[side]);
            let hand = if fingers == NONE { way(bones, elbow, wrist) } else { way(bones, wrist, fingers) };
            self.hands[side] = part(55, hand);
            let foot = way(bones, ankle, toes);
            let least = (self.height >> 3) * 95 / 125;
            let most = (self.height >> 3) * 135 / 125;
            self.toes[side] = if toes == NONE {
                (256 * 95 / 78) as i16
            } else {
                // At least 0.095 of the height, at most 0.135.
                part(foot.max(least).min(most) / (self.height / 1000).max(1), foot)
            };
            self.heels[side] = [part(18, way(bones, knee, ankle)), if toes == NONE { 40 } else { part(12, foot) }];
        }
    }
}

/// Thousandths of the height from the head's joint to the skull's middle.
pub(super) const HEAD_MIDDLE: i32 = 62;

/// Thousandths of the height by which the skull's radius is larger with another face on it: the fewer rows a display has, the larger the head.
pub(super) fn larger_skull(canvas: Canvas) -> i32 {
    (6000 / i32::from(canvas.height).max(1)).min(120)
}

/// Thousandths of 16 heights as a part of a length.
#[inline(never)]
fn ratio(height: i32, thousandths: i32, of: i32) -> i16 {
    (height * thousandths / 1000 * 256 / (of >> 4).max(1)).clamp(0, 2000) as i16
}

/// The height of a person in figure units.
pub(super) fn height(bones: &[Bone], joints: &Joints) -> i32 {
    let legs = joints.legs.iter().flat_map(|[hip, knee, ankle]| [way(bones, *hip, *knee), way(bones, *knee, *ankle)]);
    // 2.04 times the mean of both sides.
    ((legs.sum::<i32>() * 261) >> 8).max(1)
}

/// The length of the bones from a joint down to another one.
fn way(bones: &[Bone], from: u8, to: u8) -> i32 {
    let (mut joint, mut sum) = (to, 0);
    while joint != from && joint != NONE {
        let Some(bone) = bones.get(usize::from(joint)) else { break };
        sum += length(bone.offset.map(i32::from));
        joint = bone.parent.unwrap_or(NONE);
    }
    sum
}
