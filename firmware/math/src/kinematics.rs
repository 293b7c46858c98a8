//! Where the joints are and how they are turned, in memory that the program lends.

use crate::rotation::{Rotation, Vector, shift_right};
use crate::units::FigureUnits;
use fixed::types::I20F12;
use pantin::{Clip, FormRef, Joint, JointRef, Kind, Pose, WrongForm};

/// A joint of [`Kinematics`]: 76 bytes that the program lends.
#[derive(Clone, Copy, Debug)]
pub struct JointPlace {
    /// Where it stands in its parent, in figure units, as far as no channel says so.
    offset: Vector,
    position: Vector,
    rotation: Rotation,
    /// What its channels do, four bits each, the first one lowest: a [`Kind`], or one of [`CODED`].
    kinds: [u32; 2],
    first_channel: u16,
    channels: u8,
    /// Which of [`OWN_QUATERNION`], [`OWN_MAP`] and [`OWN_CODED`] it has.
    groups: u8,
    /// Index of the parent; [`NO_PARENT`] for the root.
    parent: u16,
    /// The joint below it on the way to the one that is asked for.
    next: u16,
}

/// In place of a parent's index.
const NO_PARENT: u16 = u16::MAX;

/// From this kind on: x, y and z of the exponential map that a clip has in place of three Euler angles.
const CODED: u32 = 13;

const ROTATION: u32 = Kind::Xrotation as u32;
const QUATERNION: u32 = Kind::Wquaternion as u32;
const MAP: u32 = Kind::Xexponential as u32;

const OWN_QUATERNION: u8 = 1;
const OWN_MAP: u8 = 2;
const OWN_CODED: u8 = 4;

/// Channels in a word of [`JointPlace::kinds`].
const IN_WORD: usize = 8;

impl JointPlace {
    /// A joint that was not placed: at the origin, without rotation.
    pub const NEW: JointPlace = JointPlace {
        offset: [0; 3],
        position: [0; 3],
        rotation: Rotation::IDENTITY,
        kinds: [0; 2],
        first_channel: 0,
        channels: 0,
        groups: 0,
        parent: NO_PARENT,
        next: 0,
    };

    /// Where it is in the world, in figure units: [`Kinematics::exponent`]. The axes are the source's.
    pub fn position(&self) -> Vector {
        self.position
    }

    /// How its axes are turned against the world's. Elements are within 2e-4 of the true ones for each joint above it.
    pub fn rotation(&self) -> &Rotation {
        &self.rotation
    }
}

impl Default for JointPlace {
    fn default() -> Self {
        JointPlace::NEW
    }
}

/// Why kinematics could not be set up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum KinematicsError {
    /// The pose is not one of the clip.
    WrongForm(WrongForm),
    /// There is memory for too few joints.
    TooFewJoints {
        /// The joints of the clip's rig, End Sites included.
        needed: usize,
        /// Those that memory was given for.
        given: usize,
    },
}

impl core::fmt::Display for KinematicsError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            KinematicsError::WrongForm(error) => core::fmt::Display::fmt(error, f),
            KinematicsError::TooFewJoints { needed, given } => {
                write!(f, "the rig has {needed} joints; there is memory for {given}")
            }
        }
    }
}

impl core::error::Error for KinematicsError {}

impl From<WrongForm> for KinematicsError {
    fn from(error: WrongForm) -> Self {
        KinematicsError::WrongForm(error)
    }
}

/// The places and rotations of a rig's joints in a pose: for programs that use a motion and draw nothing.
///
/// Positions are within 0.05 % of the figure's height of what real numbers give: a millimetre for a person. They are those of the figure that `pantin-figure` draws, bit for bit.
/// [`crate::JointChain`] is more exact and takes five times as long.
///
/// ```
/// use pantin::{Clip, Room};
/// use pantin_math::{JointPlace, Kinematics};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let walk: &'static [u8] = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../motions/walk.ptn"));
/// let clip = Clip::new_checked(walk)?;
/// let mut room = Room::<64, 144>::new();
/// let mut player = room.player(clip)?;
/// let mut joints = [JointPlace::NEW; 32];
/// let mut kinematics = Kinematics::new(&clip, player.pose(), &mut joints)?;
/// let foot = clip.find("left-foot").ok_or("no such joint")?;
/// player.step();
/// // One joint, and those above it:
/// let one = *kinematics.place(player.pose(), &foot)?;
/// // All of them:
/// kinematics.set_pose(player.pose())?;
/// let all = kinematics.joint(&foot)?;
/// assert_eq!(one.position(), all.position());
/// let [x, y, z] = kinematics.centimetres(all.position());
/// println!("{x} {y} {z} cm");
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Kinematics<'a, 'm> {
    joints: &'m mut [JointPlace],
    form: FormRef<'a>,
    position_shift: i32,
    exponent: i32,
    /// Centimetres in a figure unit, times 2^(12 + `down`).
    scale: i64,
    down: i32,
}

impl<'a, 'm> Kinematics<'a, 'm> {
    /// Sets up the joints of a clip's rig, End Sites included, in `joints`: [`pantin::Rig::joint_count`] of them. `pose` is any pose of the clip; its values
    /// determine the figure unit where position channels move joints.
    ///
    /// Costs some 51,000 instructions on a Cortex-M3 for 23 joints and 6 End Sites: once a clip.
    #[inline(never)]
    pub fn new(clip: &Clip<'a>, pose: Pose<'_>, joints: &'m mut [JointPlace]) -> Result<Self, KinematicsError> {
        let (rig, form) = (clip.rig(), clip.form_ref());
        form.check(pose.form)?;
        let (needed, given) = (rig.joint_count(), joints.len());
        let joints = joints.get_mut(..needed).ok_or(KinematicsError::TooFewJoints { needed, given })?;
        let units = FigureUnits::new(&rig, pose.values, form.length_exponent());
        let mut choices = 0;
        for ((index, joint), own) in rig.joints().enumerate().zip(joints.iter_mut()) {
            let choice = joint.kinds.filter(|kind| kind.is_rotation()).count() == 3;
            let exponential = choice && form.is_exponential_choice(choices);
            choices += usize::from(choice);
            let offset = if index <= units.hips {
                joint.offset.map(|raw| shift_right(raw, units.offset_shift()))
            } else {
                units.bone(&joint, pose.values).map(i32::from)
            };
            *own = JointPlace { offset, ..JointPlace::of(&joint, exponential) };
        }
        let (scale, down) = centimetres(rig.unit_micro_cm(), units.exponent);
        Ok(Kinematics { joints, form, position_shift: units.position_shift(), exponent: units.exponent, scale, down })
    }

    /// Places all joints. The pose is one of the clip: the error names the difference.
    ///
    /// Costs some 290 instructions a joint on a Cortex-M3: 8,300 for the 23 joints and 6 End Sites of a person.
    #[inline(never)]
    pub fn set_pose(&mut self, pose: Pose<'_>) -> Result<(), WrongForm> {
        self.form.check(pose.form)?;
        for index in 0..self.joints.len() {
            place(self.joints, index, pose.values, self.position_shift);
        }
        Ok(())
    }

    /// Places one joint and those above it, and returns it. All others keep the places that they had.
    ///
    /// Costs some 370 instructions on a Cortex-M3 for each joint from the root down to it: 2,300 for the toes of a person.
    #[inline(never)]
    pub fn place(&mut self, pose: Pose<'_>, joint: &JointRef<'_>) -> Result<&JointPlace, WrongForm> {
        self.form.check(pose.form)?;
        self.joint(joint)?;
        // Up to the root, noting the way back. A parent's index is smaller than its child's.
        let last = joint.index();
        let (mut index, mut root) = (last, last);
        while let Some(&JointPlace { parent, .. }) = self.joints.get(index).filter(|joint| joint.parent != NO_PARENT) {
            root = usize::from(parent);
            if let Some(parent) = self.joints.get_mut(root) {
                parent.next = index as u16;
            }
            index = root;
        }
        index = root;
        loop {
            place(self.joints, index, pose.values, self.position_shift);
            if index >= last {
                break;
            }
            index = self.joints.get(index).map_or(last, |joint| usize::from(joint.next));
        }
        self.joint(joint)
    }

    /// A joint as it was placed last. The error is that it is one of another rig.
    pub fn joint(&self, joint: &JointRef<'_>) -> Result<&JointPlace, WrongForm> {
        let own = self.joints.get(joint.index()).filter(|_| joint.rig_id() == self.form.rig_id());
        own.ok_or(WrongForm::Rig)
    }

    /// All joints in the order of the rig, as they were placed last.
    pub fn joints(&self) -> &[JointPlace] {
        self.joints
    }

    /// A figure unit is 2^`exponent` units of the source. A person is some 2^16 figure units high.
    pub fn exponent(&self) -> i32 {
        self.exponent
    }

    /// A vector in figure units, in centimetres; past 5.2 km it is cut off.
    pub fn centimetres(&self, vector: Vector) -> [I20F12; 3] {
        let Kinematics { scale, down, .. } = *self;
        vector.map(|x| {
            // Below 2^62.
            let product = i64::from(x) * scale;
            let bits = match down {
                63.. => 0,
                0.. => product >> down,
                // A scale of 2^30 or more: any product is too large.
                _ => product.signum() * i64::MAX,
            };
            I20F12::from_bits(bits.clamp(i64::from(-i32::MAX), i64::from(i32::MAX)) as i32)
        })
    }
}

/// Centimetres in 2^`exponent` units of `unit_micro_cm`, as a number of 31 bits and how many of them, and 12 others, are behind the point.
fn centimetres(unit_micro_cm: u32, exponent: i32) -> (i64, i32) {
    // A millionth is 2^-6 / 15,625, and that 2^-51 times this number, within 2^-32.
    let product = u64::from(unit_micro_cm) * 2_251_799_814;
    let up = product.leading_zeros() as i32;
    ((product << up >> 33) as i64, 51 - 12 - exponent - 33 + up)
}

impl JointPlace {
    /// Without a place.
    fn of(joint: &Joint<'_>, exponential: bool) -> JointPlace {
        let (mut kinds, mut turned, mut groups) = ([0u32; 2], 0, 0);
        for (at, kind) in joint.kinds.enumerate() {
            let mut code = kind as u32;
            if exponential && kind.is_rotation() {
                code = CODED + turned;
                turned += 1;
            }
            groups |= match code {
                CODED.. => OWN_CODED,
                MAP..CODED => OWN_MAP,
                QUATERNION..MAP => OWN_QUATERNION,
                _ => 0,
            };
            if let Some(word) = kinds.get_mut(at / IN_WORD) {
                *word |= code << (4 * (at % IN_WORD));
            }
        }
        JointPlace {
            kinds,
            first_channel: joint.first_channel,
            channels: joint.kinds.len() as u8,
            groups,
            parent: joint.parent.unwrap_or(NO_PARENT),
            ..JointPlace::NEW
        }
    }
}

/// Places a joint on its parent, which was placed before.
#[inline(never)]
fn place(joints: &mut [JointPlace], index: usize, values: &[i32], position_shift: i32) {
    let Some((above, [own, ..])) = joints.split_at_mut_checked(index) else { return };
    let above = above.get(usize::from(own.parent));
    let parent = above.map_or(&Rotation::IDENTITY, |above| &above.rotation);
    for (own, above) in own.rotation.0.iter_mut().zip(&parent.0) {
        (own[0], own[1], own[2]) = (above[0], above[1], above[2]);
    }
    let first = usize::from(own.first_channel);
    let values = values.get(first..first + usize::from(own.channels)).unwrap_or_default();
    let mut offset = own.offset;
    let mut others = [0; 10];
    for (word, values) in own.kinds.iter().zip(values.chunks(IN_WORD)) {
        let mut kinds = *word;
        for value in values {
            let kind = kinds & 15;
            kinds >>= 4;
            match kind {
                ROTATION..QUATERNION => own.rotation.turn((kind - ROTATION) as usize, *value),
                QUATERNION.. => put(&mut others, (kind - QUATERNION) as usize, *value),
                _ => put(&mut offset, kind as usize, shift_right(*value, position_shift)),
            }
        }
    }
    if own.groups != 0 {
        turn_by_groups(&mut own.rotation, own.groups, &others);
    }
    let reach = parent.apply_any(offset);
    let from = above.map_or([0; 3], |above| above.position);
    own.position = [from[0].wrapping_add(reach[0]), from[1].wrapping_add(reach[1]), from[2].wrapping_add(reach[2])];
}

/// Turns a rotation by maps and a quaternion: w, x, y, z of the quaternion, x, y, z of the joint's own map, and of the one in place of Euler angles. FORMAT.md 11 has the
/// order.
#[inline(never)]
fn turn_by_groups(rotation: &mut Rotation, groups: u8, [w, x, y, z, a, b, c, d, e, f]: &[i32; 10]) {
    if groups & OWN_CODED != 0 {
        *rotation = rotation.then(&Rotation::of_exponential([*d, *e, *f]));
    }
    if groups & OWN_QUATERNION != 0 {
        *rotation = rotation.then(&Rotation::of_quaternion([*w, *x, *y, *z]));
    }
    if groups & OWN_MAP != 0 {
        *rotation = rotation.then(&Rotation::of_exponential([*a, *b, *c]));
    }
}

fn put<const N: usize>(array: &mut [i32; N], index: usize, value: i32) {
    if let Some(place) = array.get_mut(index) {
        *place = value;
    }
}
