//! The Virtual Motion Capture protocol, by which VRM programs send a humanoid: the rotations of its bones over OSC.
//!
//! Unity's axes are left-handed with y up; the figure looks along z. Ours are right-handed: x changes its sign.

use super::osc::{Argument, Message, messages};
use super::turns::{IDENTITY, Turn, product, turned};
use std::collections::HashMap;

/// The bones of a humanoid that move the body, each with its parent. Fingers, eyes and jaw are known and move nothing.
const BONES: [(&str, Option<&str>); 22] = [
    ("Hips", None),
    ("Spine", Some("Hips")),
    ("Chest", Some("Spine")),
    ("UpperChest", Some("Chest")),
    ("Neck", Some("UpperChest")),
    ("Head", Some("Neck")),
    ("LeftShoulder", Some("UpperChest")),
    ("LeftUpperArm", Some("LeftShoulder")),
    ("LeftLowerArm", Some("LeftUpperArm")),
    ("LeftHand", Some("LeftLowerArm")),
    ("RightShoulder", Some("UpperChest")),
    ("RightUpperArm", Some("RightShoulder")),
    ("RightLowerArm", Some("RightUpperArm")),
    ("RightHand", Some("RightLowerArm")),
    ("LeftUpperLeg", Some("Hips")),
    ("LeftLowerLeg", Some("LeftUpperLeg")),
    ("LeftFoot", Some("LeftLowerLeg")),
    ("LeftToes", Some("LeftFoot")),
    ("RightUpperLeg", Some("Hips")),
    ("RightLowerLeg", Some("RightUpperLeg")),
    ("RightFoot", Some("RightLowerLeg")),
    ("RightToes", Some("RightFoot")),
];
/// For each of the display body's joints, the bone whose rotation it has.
pub const DISPLAY: [&str; 15] = [
    "Hips",
    "UpperChest",
    "Head",
    "LeftUpperArm",
    "LeftLowerArm",
    "LeftHand",
    "RightUpperArm",
    "RightLowerArm",
    "RightHand",
    "LeftUpperLeg",
    "LeftLowerLeg",
    "LeftFoot",
    "RightUpperLeg",
    "RightLowerLeg",
    "RightFoot",
];
/// Beginnings of the names of bones that move nothing here.
const STILL: [&str; 5] = ["LeftEye", "RightEye", "Jaw", "Left", "Right"];
const FINGERS: [&str; 5] = ["Thumb", "Index", "Middle", "Ring", "Little"];
/// Addresses of the protocol that say nothing about a pose.
const PROTOCOL: &str = "/VMC/";
/// A quaternion whose length differs from 1 by more is none.
const QUATERNION_SLACK: f64 = 0.1;

/// A humanoid as the last datagrams had it.
#[derive(Clone, Debug, Default)]
pub struct Vmc {
    /// Rotation in the parent by name; a bone that did not come is not turned.
    turns: HashMap<&'static str, Turn>,
    /// Places in metres: of the root in the world, and of the hips in the root.
    root: Option<(Turn, [f64; 3])>,
    hips: Option<[f64; 3]>,
}

/// What was odd about a datagram whose other messages were taken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Odd {
    /// A bone of an unknown name.
    Bone(String),
    /// An address outside of the protocol.
    Address(String),
}

impl Vmc {
    /// Takes a datagram: all of it, or nothing if it is damaged or a bone's arguments are wrong. Returns whether a bone moved, and what was passed over.
    pub fn take(&mut self, datagram: &[u8]) -> Result<(bool, Vec<Odd>), &'static str> {
        let (mut next, mut moved, mut odd) = (self.clone(), false, Vec::new());
        for message in messages(datagram)? {
            match message.address {
                "/VMC/Ext/Bone/Pos" => {
                    let (name, turn, place) = bone(&message)?;
                    match BONES.iter().find(|(own, _)| *own == name) {
                        Some((own, _)) => {
                            next.turns.insert(own, turn);
                            moved = true;
                        }
                        None if is_still(name) => {}
                        None => odd.push(Odd::Bone(name.into())),
                    }
                    if name == "Hips" {
                        next.hips = Some(place);
                    }
                }
                "/VMC/Ext/Root/Pos" => {
                    let (_, turn, place) = bone(&message)?;
                    next.root = Some((turn, place));
                    moved = true;
                }
                address if address.starts_with(PROTOCOL) => {}
                address => odd.push(Odd::Address(address.into())),
            }
        }
        *self = next;
        Ok((moved, odd))
    }

    /// The bone that a joint of this name is, upper or lower case.
    pub fn bone_named(name: &str) -> Option<&'static str> {
        BONES.iter().map(|(bone, _)| *bone).find(|bone| bone.eq_ignore_ascii_case(name))
    }

    /// The rotation of a bone in the world.
    pub fn world(&self, bone: &str) -> Turn {
        let (root, _) = self.root.unwrap_or((IDENTITY, [0.0; 3]));
        let mut chain = Vec::new();
        let mut at = Some(bone);
        while let Some((name, parent)) = BONES.iter().find(|(name, _)| Some(*name) == at) {
            chain.push(*name);
            at = *parent;
        }
        chain.iter().rev().fold(root, |turn, name| product(turn, self.turns.get(name).copied().unwrap_or(IDENTITY)))
    }

    /// The place of the hips in the world, in metres; `None` before it has come.
    pub fn place(&self) -> Option<[f64; 3]> {
        let (turn, root) = self.root.unwrap_or((IDENTITY, [0.0; 3]));
        let hips = turned(turn, self.hips?);
        Some(std::array::from_fn(|axis| root[axis] + hips[axis]))
    }
}

/// Whether a bone of a humanoid, or what some programs send beside them, moves nothing of a body.
fn is_still(name: &str) -> bool {
    STILL.iter().any(|still| match *still {
        side @ ("Left" | "Right") => {
            name.strip_prefix(side).is_some_and(|rest| FINGERS.iter().any(|finger| rest.starts_with(finger)))
        }
        whole => name == whole,
    })
}

/// A name, a place and a rotation in our axes.
fn bone<'a>(message: &Message<'a>) -> Result<(&'a str, Turn, [f64; 3]), &'static str> {
    // Later editions add a scale and an offset behind them.
    let [Argument::Text(name), numbers @ ..] = &message.arguments[..] else { return Err("a bone without a name") };
    let mut values = [0.0; 7];
    for (index, value) in values.iter_mut().enumerate() {
        match numbers.get(index) {
            Some(Argument::Float(number)) if number.is_finite() => *value = *number,
            Some(Argument::Float(_)) => return Err("a bone with a number that is not finite"),
            _ => return Err("a bone without seven numbers"),
        }
    }
    let [x, y, z, i, j, k, w] = values;
    let length = (i * i + j * j + k * k + w * w).sqrt();
    if (length - 1.0).abs() > QUATERNION_SLACK {
        return Err("a bone whose quaternion has not the length 1");
    }
    let turn = [w, i, -j, -k].map(|component| component / length);
    Ok((name, turn, [-x, y, z]))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::super::osc::tests::{bundle, encoded};
    use super::*;

    /// A bone turned by `degrees` about x of Unity, which is ours.
    pub fn bone_about_x(name: &str, degrees: f32) -> Vec<u8> {
        let half = (degrees / 2.0).to_radians();
        encoded("/VMC/Ext/Bone/Pos", &[name], &[0.0, 0.9, 0.0, half.sin(), 0.0, 0.0, half.cos()])
    }

    #[test]
    fn rotations_add_up_along_the_bones() {
        let mut vmc = Vmc::default();
        let datagram =
            bundle(&[bone_about_x("Hips", 10.0), bone_about_x("LeftUpperLeg", 20.0), bone_about_x("LeftThumbProximal", 5.0)]);
        assert_eq!(vmc.take(&datagram), Ok((true, vec![])));
        let half = 15f64.to_radians();
        let found = vmc.world("LeftFoot");
        assert!((found[0] - half.cos()).abs() < 1e-6 && (found[1] - half.sin()).abs() < 1e-6, "{found:?}");
        assert!((vmc.place().unwrap()[1] - 0.9).abs() < 1e-6);
        // A place to the figure's left is at x below 0 there, and above 0 here.
        vmc.take(&encoded("/VMC/Ext/Root/Pos", &["root"], &[-1.0, 0.0, 2.0, 0.0, 0.0, 0.0, 1.0])).unwrap();
        assert!((vmc.place().unwrap()[0] - 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_damaged_datagram_changes_nothing() {
        let mut vmc = Vmc::default();
        vmc.take(&bone_about_x("Head", 30.0)).unwrap();
        let before = vmc.world("Head");
        for (bad, wanted) in [
            (encoded("/VMC/Ext/Bone/Pos", &["Head"], &[0.0; 6]), "seven numbers"),
            (encoded("/VMC/Ext/Bone/Pos", &["Head"], &[0.0; 7]), "length 1"),
            (encoded("/VMC/Ext/Bone/Pos", &[], &[0.0; 7]), "without a name"),
            (encoded("/VMC/Ext/Bone/Pos", &["Head", "x"], &[0.0; 7]), "seven numbers"),
            (encoded("/VMC/Ext/Bone/Pos", &["Head"], &[f32::NAN, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]), "not finite"),
            (b"junk".to_vec(), "cut off"),
            (vec![], "cut off"),
        ] {
            let datagram = bundle(&[bone_about_x("Head", 60.0), bad]);
            assert!(vmc.take(&datagram).is_err_and(|error| error.contains(wanted)), "{wanted}");
            assert_eq!(vmc.world("Head"), before);
        }
        let odd = vmc.take(&bundle(&[
            bone_about_x("Tail", 1.0),
            encoded("/chat", &["hello"], &[]),
            encoded("/VMC/Ext/T", &[], &[1.0]),
        ]));
        assert_eq!(odd, Ok((false, vec![Odd::Bone("Tail".into()), Odd::Address("/chat".into())])));
    }
}
