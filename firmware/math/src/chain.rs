//! Where a joint is in the world, and how it is turned: for programs that use a motion without drawing it.

use fixed::types::I20F12;
use heapless::Vec;
use pantin::{Clip, JointRef, Matrix, Pose, WrongForm};

/// A joint and those above it, at most `N` in all (32 suffice for people and animals), found once and then asked for frame by frame.
///
/// ```
/// # fn reach(player: &pantin::Player) -> Option<()> {
/// let hand = pantin_math::JointChain::<32>::to(player.clip(), "LeftHand").ok()?;
/// let [x, y, z] = hand.locate(player.pose()).ok()?.position;
/// println!("{x} {y} {z} cm");
/// # Some(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct JointChain<'a, const N: usize> {
    /// The root first.
    links: Vec<Link<'a>, N>,
    unit_micro_cm: u32,
    length_exponent: i8,
}

#[derive(Clone, Debug)]
struct Link<'a> {
    joint: JointRef<'a>,
    /// In steps of the rig.
    offset: [i32; 3],
}

/// Why there is no chain to a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ChainError {
    /// The rig has no joint of this name.
    NoSuchJoint,
    /// More joints stand above it than the chain has memory for.
    TooLong {
        /// The joints that are needed.
        needed: usize,
        /// Those that the chain holds.
        given: usize,
    },
}

impl core::fmt::Display for ChainError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            ChainError::NoSuchJoint => f.write_str("the rig has no joint of this name"),
            ChainError::TooLong { needed, given } => write!(f, "the joint stands below {needed} joints; the chain holds {given}"),
        }
    }
}

impl core::error::Error for ChainError {}

/// A joint in the world at one frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WorldJoint {
    /// Where the joint's own origin is (a foot's is its ankle), in centimetres, within 0.005 cm for a chain of 32 joints. The axes
    /// are the source's: which one is up is the source's choice.
    pub position: [I20F12; 3],
    /// How the joint's axes are turned against the world's; elements are within 1e-6 of the true ones.
    pub rotation: Matrix,
}

impl<'a, const N: usize> JointChain<'a, N> {
    /// The chain to a joint, by its name.
    pub fn to(clip: &Clip<'a>, name: &str) -> Result<Self, ChainError> {
        JointChain::to_joint(clip, clip.find(name).ok_or(ChainError::NoSuchJoint)?.index())
    }

    /// The chain to a joint of the rig, or to an End Site, by its index.
    pub fn to_joint(clip: &Clip<'a>, index: usize) -> Result<Self, ChainError> {
        let rig = clip.rig();
        let mut chain =
            JointChain { links: Vec::new(), unit_micro_cm: rig.unit_micro_cm(), length_exponent: rig.length_exponent() };
        let (mut next, mut needed) = (Some(index), 0);
        while let Some(at) = next {
            let (Some(joint), Some(reference)) = (rig.joint(at), rig.joint_ref(at)) else { return Err(ChainError::NoSuchJoint) };
            needed += 1;
            // Those beyond the chain's memory are counted alone.
            let _ = chain.links.push(Link { joint: reference, offset: joint.offset });
            next = joint.parent.map(usize::from);
        }
        if needed > N {
            return Err(ChainError::TooLong { needed, given: N });
        }
        chain.links.reverse();
        Ok(chain)
    }

    /// Where the joint is in a pose of the chain's rig.
    ///
    /// Costs some 2,200 instructions on a Cortex-M3 for each joint of the chain, 8,000 on a Cortex-M0: [`crate::Kinematics`] takes a sixth.
    pub fn locate(&self, pose: Pose<'_>) -> Result<WorldJoint, WrongForm> {
        let (mut position, mut rotation) = ([0i64; 3], Matrix::IDENTITY);
        for link in &self.links {
            let moved = pose.position(&link.joint)?;
            let mut offset = [0; 3];
            for ((offset, raw), moved) in offset.iter_mut().zip(link.offset).zip(moved) {
                *offset = match moved {
                    Some(raw) => self.centimetres(raw, pose.form.length_exponent()),
                    None => self.centimetres(raw, self.length_exponent),
                };
            }
            for (sum, part) in position.iter_mut().zip(rotation.apply(offset)) {
                *sum += part;
            }
            rotation = rotation.then(&pose.turn(&link.joint)?.matrix());
        }
        Ok(WorldJoint { position: position.map(|x| I20F12::from_bits(clamp((x + 2) >> 2))), rotation })
    }

    /// A length in 2^`exponent` units of the source, in 2^-14 cm; past 1.3 km it is cut off.
    fn centimetres(&self, raw: i32, exponent: i8) -> i32 {
        // 2^14 / 10^6 is 2^8 / 15625. The product is below 2^63.
        let micro_cm = i64::from(raw) * i64::from(self.unit_micro_cm);
        let shift = i32::from(exponent) + 8;
        let scaled = match shift {
            0.. if (micro_cm.unsigned_abs().leading_zeros() as i32) > shift + 1 => micro_cm << shift,
            0.. => micro_cm.signum() * i64::MAX,
            _ => micro_cm >> -shift,
        };
        clamp(scaled / 15_625)
    }
}

fn clamp(x: i64) -> i32 {
    x.clamp(i64::from(-i32::MAX), i64::from(i32::MAX)) as i32
}
