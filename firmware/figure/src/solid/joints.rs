//! Which joints of a skeleton are a person's: limbs by the words in their names, neck and waist by where arms and head branch off.

use crate::ink::BodyPart;
use crate::joint_info::length;
use crate::names::contains;
use crate::skeleton::{Bone, Part, Skeleton};
use heapless::Vec;
use pantin::Rig;

/// The joints of an arm or a leg: [`ARM`] or [`LEG`] names them.
pub(super) type Limb = [u8; 3];

/// What the three joints of an arm are called in names. A joint with one of the words of `weak` is taken if there is none with the others.
const ARM: Words = Words {
    weak: &[b"shoulder", b"shldr"],
    generic: b"arm",
    strong: [
        &[b"upperarm", b"upper_arm", b"upper-arm", b"uparm", b"humerus", b"oberarm"],
        &[b"forearm", b"lowerarm", b"lower_arm", b"loarm", b"elbow", b"radius", b"unterarm"],
        &[b"hand", b"wrist"],
    ],
};

/// What the three joints of a leg are called.
const LEG: Words = Words {
    weak: &[b"hip"],
    generic: b"leg",
    strong: [
        &[b"upleg", b"upperleg", b"upper_leg", b"thigh", b"femur", b"oberschenkel"],
        &[b"lowerleg", b"lower_leg", b"loleg", b"shin", b"calf", b"knee", b"tibia", b"unterschenkel"],
        &[b"foot", b"ankle", b"fuss", b"fu_"],
    ],
};

/// The words of a limb's joints, from the trunk outwards.
struct Words {
    weak: &'static [&'static [u8]],
    /// The next joint of the limb.
    generic: &'static [u8],
    strong: [&'static [&'static [u8]]; 3],
}

/// A joint that is not there.
pub(super) const NONE: u8 = u8::MAX;

/// The joints of a person, as indices of a skeleton's bones. Sides: left, right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Joints {
    pub(super) hips: u8,
    /// A joint of the spine about 2/5 of the way up, or [`NONE`].
    pub(super) waist: u8,
    pub(super) neck: u8,
    pub(super) head: u8,
    /// Upper arm (its joint is the shoulder), forearm (elbow), hand (wrist).
    pub(super) arms: [Limb; 2],
    /// Thigh (its joint is the hip), shin (knee), foot (ankle).
    pub(super) legs: [Limb; 2],
    /// The joint at the end of the hand, or [`NONE`].
    pub(super) fingers: [u8; 2],
    /// The joint at the end of the foot, or [`NONE`].
    pub(super) toes: [u8; 2],
}

impl Joints {
    /// No person.
    pub(super) const NOBODY: Joints = Joints {
        hips: 0,
        waist: NONE,
        neck: 0,
        head: 0,
        arms: [[0; 3]; 2],
        legs: [[0; 3]; 2],
        fingers: [NONE; 2],
        toes: [NONE; 2],
    };

    /// Finds a person's joints. `None` if a limb, the head or the place where the arms branch off is missing, and for a rig with a tail or wings.
    #[inline(never)]
    pub fn find<const N: usize>(rig: &Rig, skeleton: &Skeleton<N>) -> Option<Joints> {
        let bones = &skeleton.bones;
        if rig.joints().any(|joint| contains(joint.name_bytes(), b"tail") || contains(joint.name_bytes(), b"wing")) {
            return None;
        }
        let mut joints = Joints::NOBODY;
        for (side, body_part) in [BodyPart::Left, BodyPart::Right].into_iter().enumerate() {
            *joints.arms.get_mut(side)? = limb(rig, bones, &ARM, body_part)?;
            *joints.legs.get_mut(side)? = limb(rig, bones, &LEG, body_part)?;
        }
        let [left, right] = joints.arms.map(|[shoulder, ..]| shoulder);
        let chest = common(bones, left, right)?;
        let crown = bones.iter().position(|bone| bone.part == Part::Crown);
        joints.head = match crown.and_then(|crown| bones.get(crown)) {
            Some(crown) => crown.parent?,
            None => last_of_neck(bones, chest)?,
        };
        joints.neck = below(bones, joints.head, chest)?;
        if joints.neck == joints.head {
            // The arms hang on the neck.
            joints.neck = chest;
        }
        joints.hips = skeleton.hips as u8;
        joints.waist = waist(bones, joints.hips, joints.neck);
        for side in 0..2 {
            let [wrist, ankle] = [joints.arms.get(side)?[2], joints.legs.get(side)?[2]];
            *joints.fingers.get_mut(side)? = far_end(rig, bones, wrist, skeleton.size / 50);
            *joints.toes.get_mut(side)? = unfolded(bones, ankle, far_end(rig, bones, ankle, skeleton.size / 30));
        }
        Some(joints)
    }
}

/// The three joints of a side's limb. Parents come before children, so the first joint with a word is the one nearest to the trunk.
fn limb(rig: &Rig, bones: &[Bone], words: &Words, side: BodyPart) -> Option<Limb> {
    let mut found: [Option<u8>; 3] = [None; 3];
    let mut weak = None;
    for (index, bone) in bones.iter().enumerate() {
        let Some(joint) = rig.joint(bone.joint.into()).filter(|joint| bone.body_part == side && !joint.end_site) else {
            continue;
        };
        let name = joint.name_bytes();
        let named = |words: &[&[u8]]| words.iter().any(|word| contains(name, word));
        let role = match words.strong.iter().position(|words| named(words)) {
            Some(role) => role,
            None if contains(name, words.generic) => found.iter().position(|joint| joint.is_none()).unwrap_or(3),
            None => {
                if weak.is_none() && named(words.weak) {
                    weak = Some(index as u8);
                }
                continue;
            }
        };
        if let Some(place @ None) = found.get_mut(role) {
            *place = Some(index as u8);
        }
    }
    let [first, second, third] = found;
    let limb = [first.or(weak)?, second?, third?];
    let hangs = |joint: u8, above: u8| ancestors(bones, joint).any(|ancestor| ancestor == above);
    (hangs(limb[1], limb[0]) && hangs(limb[2], limb[1])).then_some(limb)
}

/// The joints above one, the nearest first.
fn ancestors(bones: &[Bone], joint: u8) -> impl Iterator<Item = u8> {
    core::iter::successors(parent(bones, joint), |joint| parent(bones, *joint))
}

fn parent(bones: &[Bone], joint: u8) -> Option<u8> {
    bones.get(usize::from(joint))?.parent
}

/// The nearest joint above two.
fn common(bones: &[Bone], one: u8, other: u8) -> Option<u8> {
    ancestors(bones, one).find(|joint| ancestors(bones, other).any(|above| above == *joint))
}

/// The joint on the way from `chest` to `head` that hangs on the chest.
fn below(bones: &[Bone], head: u8, chest: u8) -> Option<u8> {
    core::iter::once(head).chain(ancestors(bones, head)).find(|joint| parent(bones, *joint) == Some(chest))
}

/// In a rig that names no head: the last joint but the end of what rises from the chest between the arms.
fn last_of_neck(bones: &[Bone], chest: u8) -> Option<u8> {
    let child = |joint: u8| {
        let hangs = |(_, bone): &(usize, &Bone)| bone.parent == Some(joint) && bone.body_part == BodyPart::Middle;
        bones.iter().enumerate().find(hangs).map(|(index, _)| index as u8)
    };
    let neck = child(chest)?;
    let mut head = child(neck)?;
    while let Some(next) = child(head).filter(|next| child(*next).is_some()) {
        head = next;
    }
    Some(head)
}

/// The joint of the spine that is nearest to 2/5 of the way from the hips to the neck; [`NONE`] if none is between 1/5 and 3/5.
fn waist(bones: &[Bone], hips: u8, neck: u8) -> u8 {
    let own = |joint: u8| bones.get(usize::from(joint)).map_or(0, |bone| length(bone.offset.map(i32::from)));
    let chain = || core::iter::once(neck).chain(ancestors(bones, neck)).take_while(|joint| *joint != hips);
    let total: i32 = chain().map(own).sum();
    let mut above = 0;
    let mut nearest = (total / 5, NONE);
    for joint in chain() {
        let apart = (total - above - total * 2 / 5).abs();
        if apart < nearest.0 {
            nearest = (apart, joint);
        }
        above += own(joint);
    }
    nearest.1
}

/// The joint below one that is farthest down its longest branch without thumbs, if it is at least `shortest` away.
fn far_end(rig: &Rig, bones: &[Bone], joint: u8, shortest: i32) -> u8 {
    let mut reach: Vec<i32, 16> = Vec::new();
    let mut best = (shortest, NONE);
    // What hangs on a joint follows it without a gap.
    let first = usize::from(joint) + 1;
    for (index, bone) in bones.iter().enumerate().skip(first) {
        let Some(above) = bone.parent.filter(|parent| *parent >= joint) else { break };
        let thumb = rig
            .joint(bone.joint.into())
            .is_some_and(|joint| contains(joint.name_bytes(), b"thumb") && !contains(joint.name_bytes(), b"foot"));
        let before = if above == joint { 0 } else { reach.get(usize::from(above) - first).copied().unwrap_or(i32::MIN / 2) };
        let own = if thumb { i32::MIN / 2 } else { before.saturating_add(length(bone.offset.map(i32::from))) };
        if reach.push(own).is_err() {
            break;
        }
        if own > best.0 {
            best = (own, index as u8);
        }
    }
    best.1
}

/// The end of a foot, or the joint before it if the end leads back towards the ankle: some exporters turn End Sites with other axes than the joints'.
fn unfolded(bones: &[Bone], ankle: u8, end: u8) -> u8 {
    let Some(before) = bones.get(usize::from(end)).and_then(|bone| bone.parent).filter(|before| *before > ankle) else {
        return end;
    };
    let straight = |to: u8| {
        let (mut sum, mut joint) = ([0; 3], to);
        while joint > ankle {
            let Some(bone) = bones.get(usize::from(joint)) else { break };
            sum.iter_mut().zip(bone.offset).for_each(|(sum, part)| *sum += i32::from(part));
            joint = bone.parent.unwrap_or(ankle);
        }
        length(sum)
    };
    if straight(end) < straight(before) { before } else { end }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solid::{Build, Look, SolidFigure};
    use crate::{Canvas, View};
    use pantin::{Clip, Room};

    #[test]
    fn a_foot_whose_end_leads_back_ends_at_its_toes() {
        let bone = |parent: Option<u8>, offset: [i16; 3]| Bone {
            offset,
            parent,
            joint: 0,
            part: Part::Bone,
            body_part: BodyPart::Left,
            drives: 0,
            slot: u8::MAX,
            parent_slot: u8::MAX,
            moves: false,
        };
        let leg =
            |end: [i16; 3]| [bone(None, [0; 3]), bone(Some(0), [0, -400, 0]), bone(Some(1), [-2, -122, 83]), bone(Some(2), end)];
        // As a character of Mixamo was exported, and as its toes are.
        assert_eq!(unfolded(&leg([0, 147, 0]), 1, 3), 2);
        assert_eq!(unfolded(&leg([0, -10, 60]), 1, 3), 3);
        assert_eq!(unfolded(&leg([0, 147, 0]), 1, 2), 2);
        assert_eq!(unfolded(&leg([0, 147, 0]), 1, NONE), NONE);
    }

    #[test]
    fn a_persons_joints_are_found_and_a_knees_are_not() {
        for (clip, build) in [
            (&include_bytes!("../../../../motions/walk.ptn")[..], Build::Person),
            (&include_bytes!("../../../../motions/run.ptn")[..], Build::Person),
            (&include_bytes!("../../../../motions/kneebend.ptn")[..], Build::Person),
        ] {
            let mut room = Room::<144, 144>::new();
            let mut player = room.player(Clip::new_checked(clip).unwrap()).unwrap();
            let canvas = Canvas { width: 128, height: 64 };
            let figure = SolidFigure::<60>::of_clip(&mut player, canvas, View::default(), Look::DEFAULT).unwrap();
            assert_eq!(figure.build(), build);
        }
    }
}
