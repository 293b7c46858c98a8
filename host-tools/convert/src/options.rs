//! What a user asks of a clip.

use crate::fit::level::Level;
use crate::fit::rotation_coding::Rotations;
use crate::length::Length;
use crate::memory::Memory;

/// Bounds of each channel, in place of the joints' bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ChannelBound {
    /// The greatest error of each channel at every frame: degrees for each Euler angle, in its joint's own order; for all others percent (of a position's
    /// range, of a scalar's full scale, of 2 for a quaternion's components). Above 0.
    Error(f64),
    /// The greatest error of each channel's acceleration, its second difference: degrees per frame^2 for rotations, and percent per frame^2 for all
    /// others. Above 0. Positions and rotations drift.
    Acceleration(f64),
    /// Known curves are coded as they are, but for rounding: at most 0.006 degrees, or 2^-16 of what percentages refer to.
    Exact,
}

/// Whether a clip holds the keys of its motion (a key clip, which only players with feature `keys` play) or segments, which every player plays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UseKeys {
    /// Segments, for players of any build.
    #[default]
    Never,
    /// Keys where they take fewer bytes than segments within the bound, else segments.
    IfSmaller,
    /// Keys. A motion without a key clip is an error.
    Always,
}

/// What a user asks of a clip. The defaults suit a figure of human size on a small display.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// The greatest distance of any bounded point from where the source has it: of each joint, of the three points of its shell, and of each
    /// End Site. 0.5 cm by default, or 6 times `mean_error`.
    pub max_error: Option<Length>,
    /// The distance of the shell's points from their joint, along the joint's own axes, so that `max_error` bounds how each joint is turned,
    /// too. By default 3 cm, or 3 % of the height of a figure below 1 m.
    pub shell: Option<Length>,
    /// Whether the places of joints and End Sites are bounded alone, without their shells; `false` by default. For figures that are drawn as
    /// lines between joints: a head's yaw or a forearm's twist may be lost.
    pub places_only: bool,
    /// The mean error of the joints, End Sites left out: the clip is as small as this mean allows. `max_error` still holds.
    pub mean_error: Option<Length>,
    /// The greatest error of scalars, in percent of their full scale; 2 by default. Above 0.
    pub max_scalar_error: Option<f64>,
    /// The greatest angle in degrees between the true and the decoded rotation of any joint in the world. Above 0, at most 180.
    pub max_rotation_error: Option<f64>,
    /// The greatest angle in degrees between the true and the decoded rotation of any joint in its parent, for skinned meshes. Above 0, at most 180. A
    /// single Euler angle can be off by more, and by much more where the second angle is near 90 or -90 degrees: [`ChannelBound::Error`] bounds each.
    pub max_joint_error: Option<f64>,
    /// Bounds of each channel, in place of all bounds above.
    pub channels: Option<ChannelBound>,
    /// The encoder's effort, 1 to 9: speed against size; 6 by default.
    pub effort: Level,
    /// How joints with three Euler angles are coded; by cost as the default. Joints whose channels have bounds keep their angles; `Exact` allows
    /// quaternions.
    pub rotations: Rotations,
    /// Seconds between snapshots for seeking; none by default.
    pub index: Option<f64>,
    /// Whether the clip holds the motion's keys; [`UseKeys::Never`] by default. A clip with an [`index`](Options::index) has segments.
    pub keys: UseKeys,
    /// Whether the rig stays out of the clip, to be shared by several; `false` by default.
    pub rig_apart: bool,
    /// Whether the seam between the last frame and the first is closed, which makes the clip a loop. What that moves is part of the bound.
    pub looped: bool,
    /// Whether the frames at which feet touch down become events.
    pub footsteps: bool,
    /// The memory that the conversion may take; 1 GiB by default.
    pub memory: Memory,
}

impl Default for Options {
    fn default() -> Options {
        Options {
            max_error: None,
            shell: None,
            places_only: false,
            mean_error: None,
            max_scalar_error: None,
            max_rotation_error: None,
            max_joint_error: None,
            channels: None,
            effort: Level::DEFAULT,
            rotations: Rotations::ByCost,
            index: None,
            keys: UseKeys::Never,
            rig_apart: false,
            looped: false,
            footsteps: false,
            memory: Memory::default(),
        }
    }
}

impl Options {
    /// The bound of joints without a setting.
    pub const MAX_ERROR: Length = Length::Cm(0.5);
    /// The bound of scalars without a setting, in percent of full scale.
    pub const MAX_SCALAR_PERCENT: f64 = 2.0;
    /// The bound of joints relative to the mean error, where only the mean is set.
    pub const MAX_OF_MEAN: f64 = 6.0;

    /// The least bound on a rotation in degrees: rounding three angles to steps of 360 / 2^32 degrees turns a joint by nearly as much.
    pub const LEAST_DEGREES: f64 = 2e-7;

    /// The defaults.
    pub fn new() -> Options {
        Options::default()
    }

    /// Bounds the distance of joints.
    pub fn max_error(self, error: impl Into<Option<Length>>) -> Options {
        Options { max_error: error.into(), ..self }
    }

    /// Aims at a mean distance of joints.
    pub fn mean_error(self, error: impl Into<Option<Length>>) -> Options {
        Options { mean_error: error.into(), ..self }
    }

    /// Bounds scalars, in percent of full scale.
    pub fn max_scalar_error(self, percent: impl Into<Option<f64>>) -> Options {
        Options { max_scalar_error: percent.into(), ..self }
    }

    /// Sets the distance of the shell's points.
    pub fn shell(self, distance: impl Into<Option<Length>>) -> Options {
        Options { shell: distance.into(), ..self }
    }

    /// Bounds places alone.
    pub fn places_only(self, places_only: bool) -> Options {
        Options { places_only, ..self }
    }

    /// Bounds whole rotations against the parent, in degrees.
    pub fn max_joint_error(self, degrees: impl Into<Option<f64>>) -> Options {
        Options { max_joint_error: degrees.into(), ..self }
    }

    /// Bounds rotations in the world, in degrees.
    pub fn max_rotation_error(self, degrees: impl Into<Option<f64>>) -> Options {
        Options { max_rotation_error: degrees.into(), ..self }
    }

    /// Bounds channels instead of joints.
    pub fn channels(self, bound: impl Into<Option<ChannelBound>>) -> Options {
        Options { channels: bound.into(), ..self }
    }

    /// Sets the encoder's effort.
    pub fn effort(self, effort: Level) -> Options {
        Options { effort, ..self }
    }

    /// Sets how rotations are coded.
    pub fn rotations(self, rotations: Rotations) -> Options {
        Options { rotations, ..self }
    }

    /// Stores a snapshot every `seconds`.
    pub fn index(self, seconds: impl Into<Option<f64>>) -> Options {
        Options { index: seconds.into(), ..self }
    }

    /// Chooses between keys and segments.
    pub fn keys(self, keys: UseKeys) -> Options {
        Options { keys, ..self }
    }

    /// Keeps the rig out of the clip.
    pub fn rig_apart(self, rig_apart: bool) -> Options {
        Options { rig_apart, ..self }
    }

    /// Closes the seam of a loop.
    pub fn looped(self, looped: bool) -> Options {
        Options { looped, ..self }
    }

    /// Finds footsteps.
    pub fn footsteps(self, footsteps: bool) -> Options {
        Options { footsteps, ..self }
    }

    /// Limits the memory.
    pub fn memory(self, memory: Memory) -> Options {
        Options { memory, ..self }
    }

    /// Whether known curves are coded as they are, for which rotations stay quaternions where the source has them so.
    pub fn keeps_quaternions(&self) -> bool {
        self.channels == Some(ChannelBound::Exact) || self.makes_quaternions()
    }

    /// Whether joints get quaternions in place of Euler angles. Where each angle has a bound, they keep their angles.
    pub(crate) fn makes_quaternions(&self) -> bool {
        self.rotations == Rotations::Quaternion && matches!(self.channels, None | Some(ChannelBound::Exact))
    }
}
