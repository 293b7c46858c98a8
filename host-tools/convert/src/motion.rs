//! Motion as every stage of the host tool shares it: a rig, and one value a channel a frame.
//!
//! Units are the source's: degrees for rotations, source units (times `cm_per_unit` gives cm) for positions,
//! degrees (axis times angle) for exponential maps, 1 for quaternion components.

pub use pantin::{Kind, Up};

/// A joint, or an End Site.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Name in the source; empty for an End Site.
    pub name: String,
    /// Index of the parent, smaller than the joint's own; `None` for the root.
    pub parent: Option<usize>,
    /// Where it stands in its parent, in source units. Position channels replace it, axis by axis.
    pub offset: [f64; 3],
    /// Channels in the order in which they apply.
    pub kinds: Vec<Kind>,
    /// Whether this is an End Site: no channels, no name, only a bone's end.
    pub end_site: bool,
    /// Whether it only steers other joints in the program that made the figure: not drawn, nor what hangs on it.
    pub helper: bool,
}

/// A channel that moves no joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Scalar {
    /// Name in the source.
    pub name: String,
    /// Full scale: the value stays within -full_scale..full_scale.
    pub full_scale: f64,
}

/// The figure: everything but the motion.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Rig {
    /// Parents before children; the root first.
    pub joints: Vec<Joint>,
    /// Scalars; their channels follow those of the joints.
    pub scalars: Vec<Scalar>,
    /// Length of the source's unit in cm.
    pub cm_per_unit: f64,
    /// The direction of the world that is vertical.
    pub up: Up,
}

impl Rig {
    /// Channels of the joints.
    pub fn joint_channels(&self) -> usize {
        self.joints.iter().map(|joint| joint.kinds.len()).sum()
    }

    /// All channels.
    pub fn channels(&self) -> usize {
        self.joint_channels() + self.scalars.len()
    }

    /// Index of each joint's first channel.
    pub fn first_channels(&self) -> Vec<usize> {
        let mut next = 0;
        self.joints
            .iter()
            .map(|joint| {
                let first = next;
                next += joint.kinds.len();
                first
            })
            .collect()
    }

    /// Joint and kind of every channel; scalars have no joint.
    pub fn channel_kinds(&self) -> Vec<(Option<usize>, Kind)> {
        let joints = self.joints.iter().enumerate();
        let of_joints = joints.flat_map(|(index, joint)| joint.kinds.iter().map(move |&kind| (Some(index), kind)));
        of_joints.chain(self.scalars.iter().map(|_| (None, Kind::Scalar))).collect()
    }

    /// What a channel without keys stays at: 0, a position its offset, the first component of a quaternion 1.
    pub fn rest(&self, (joint, kind): (Option<usize>, Kind)) -> f64 {
        match (joint, kind.axis()) {
            (Some(joint), Some(axis)) if kind.is_position() => self.joints[joint].offset[axis],
            _ if kind == Kind::Wquaternion => 1.0,
            _ => 0.0,
        }
    }

    /// The channels that have keys at the same times as `first`, the first one of them: a joint's components of a quaternion or an exponential map, or
    /// that channel alone.
    pub fn key_group(&self, first: usize) -> std::ops::Range<usize> {
        let kinds = self.channel_kinds();
        let same = |kind: Kind| [kind.is_quaternion(), kind.is_exponential()];
        let Some(&(joint, kind)) = kinds.get(first).filter(|(_, kind)| same(*kind) != [false; 2]) else {
            return first..first + 1;
        };
        first..first + kinds[first..].iter().take_while(|(own, other)| *own == joint && same(*other) == same(kind)).count()
    }

    /// What a person would call a channel: `hip.Xrotation`, or the scalar's name.
    pub fn channel_name(&self, channel: usize) -> String {
        match self.channel_kinds().get(channel) {
            Some(&(Some(joint), kind)) => format!("{}.{kind:?}", self.joints[joint].name),
            _ => self
                .scalars
                .get(channel.wrapping_sub(self.joint_channels()))
                .map_or_else(String::new, |scalar| scalar.name.clone()),
        }
    }

    /// What a person would call a joint: an End Site by its parent's name.
    pub fn joint_name(&self, joint: usize) -> String {
        let entry = &self.joints[joint];
        match entry.parent {
            Some(parent) if entry.end_site => format!("{}/end", self.joints[parent].name),
            _ => entry.name.clone(),
        }
    }
}

/// A motion that is read frame by frame, so that a long one need not be in memory.
pub trait Frames {
    /// The figure.
    fn rig(&self) -> &Rig;

    /// Seconds a frame.
    fn frame_time(&self) -> f64;

    /// Number of frames.
    fn frames(&self) -> usize;

    /// The markers, in the order of their frames.
    fn events(&self) -> Vec<Event>;

    /// Calls `each` with the values of all channels at every frame, in order.
    fn each(&self, each: &mut dyn FnMut(&[f64]) -> anyhow::Result<()>) -> anyhow::Result<()>;
}

impl Frames for Motion {
    fn rig(&self) -> &Rig {
        &self.rig
    }

    fn frame_time(&self) -> f64 {
        self.frame_time
    }

    fn frames(&self) -> usize {
        self.frames
    }

    fn events(&self) -> Vec<Event> {
        self.events.clone()
    }

    fn each(&self, each: &mut dyn FnMut(&[f64]) -> anyhow::Result<()>) -> anyhow::Result<()> {
        let mut pose = vec![0.0; self.values.len()];
        (0..self.frames).try_for_each(|frame| {
            pose.iter_mut().zip(&self.values).for_each(|(out, values)| *out = values[frame]);
            each(&pose)
        })
    }
}

/// How a channel runs between its keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// Straight lines.
    Linear,
    /// Cubic Hermite with Catmull-Rom tangents: velocity continuous.
    CatmullRom,
    /// The natural cubic spline: acceleration continuous in time.
    Natural,
    /// The spline whose second difference is continuous and piecewise linear on the frames: coded exactly by slopes alone.
    Discrete,
}

/// What is known of one channel's curve, so that it converts without a fit (docs/METHOD.md 2.3).
#[derive(Clone, Debug, PartialEq)]
pub enum Keys {
    /// Keys on frames: strictly ascending, the first 0 and the last `frames - 1`.
    OnFrames {
        /// How the channel runs between them.
        interpolation: Interpolation,
        /// Frame and value.
        keys: Vec<(usize, f64)>,
        /// The same curve as cubics in time, one a key but for the last: keys that are closer than four frames do not tell it, nor what comes after
        /// the last frame of a loop.
        pieces: Vec<Piece>,
    },
    /// Cubics in time, each from its start to the next one's, which may lie between frames.
    Pieces(Vec<Piece>),
}

/// A cubic `p + c s + w s^2 / 2 + k s^3 / 6`, s frames after `start`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Piece {
    /// Where it begins, in frames.
    pub start: f64,
    /// Value at its start.
    pub p: f64,
    /// First derivative there, a frame.
    pub c: f64,
    /// Second derivative there, a frame^2.
    pub w: f64,
    /// Third derivative, a frame^3.
    pub k: f64,
}

/// A motion: what importers make, what the fit takes, what an expanded clip becomes.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// The figure.
    pub rig: Rig,
    /// Seconds a frame.
    pub frame_time: f64,
    /// Number of frames, at least 1.
    pub frames: usize,
    /// `values[channel][frame]`.
    pub values: Vec<Vec<f64>>,
    /// The keys that the source gave, channel by channel, where it had them.
    pub keys: Vec<Option<Keys>>,
    /// Whether frame 0 follows the last frame.
    pub looped: bool,
    /// Markers, in the order of their frames.
    pub events: Vec<Event>,
    /// What is known of the file that it was read from.
    pub origin: Origin,
}

/// What a motion keeps of the file that it was read from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Origin {
    /// The greatest distance in cm of a joint of the motion from where the file has it, over all frames: a bound against the file is a bound against
    /// the motion less this.
    pub error_cm: f64,
    /// Frames a second at which the file was read by its times, from the first to the last, instead of frame by frame.
    pub sampled_fps: Option<f64>,
    /// Bytes of all files that were read for it.
    pub bytes: u64,
    /// The greatest distance in cm of a joint from the source's joint that it stands for, in a motion that was put on another body.
    pub retarget_max_cm: Option<f64>,
}

impl Motion {
    /// A motion of `frames` values for each channel, without keys, loop or events.
    pub(crate) fn sampled(rig: Rig, frame_time: f64, frames: usize, values: Vec<Vec<f64>>) -> Motion {
        let keys = vec![None; values.len()];
        Motion { rig, frame_time, frames, keys, values, looped: false, events: Vec::new(), origin: Default::default() }
    }

    /// The motion without joints, scalars and their values, for an edit that adds those it keeps.
    pub fn without_figure(&self) -> Motion {
        Motion {
            rig: Rig { cm_per_unit: self.rig.cm_per_unit, up: self.rig.up, ..Rig::default() },
            values: Vec::new(),
            keys: Vec::new(),
            events: self.events.clone(),
            ..*self
        }
    }
}

/// A marker of a moment: a footfall, a sound.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Event {
    /// The frame it stands at.
    pub frame: usize,
    /// Its name. One of digits alone is an id without a name.
    pub name: String,
}
