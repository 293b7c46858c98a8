//! What a clip asks of the camera: how far the figure gets and where it faces. Gathered from some of its poses.

use crate::kinematics::Kinematics;
use crate::root::direction;
use crate::rotation::{RotationBackend, Vector, vector};
use crate::skeleton::Skeleton;
use crate::trig::ONE;
use pantin::Up;

/// Gathers what a clip's poses show, axis by axis. Lengths are figure units.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// Least coordinates of any joint.
    pub low: Vector,
    /// Greatest coordinates of any joint.
    pub high: Vector,
    /// Sum over the poses of left minus right.
    leftward: Vector,
}

/// Which way is up and where the figure faces, in Q15 of the world's axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Orientation {
    /// The axis that is vertical.
    pub axis: usize,
    /// Up: 1 along that axis, forwards or backwards.
    pub up: Vector,
    /// Horizontal.
    pub facing: Vector,
}

impl Orientation {
    /// Up along y, looking along z.
    pub(crate) const UPRIGHT: Orientation = Orientation { axis: 1, up: [0, ONE, 0], facing: [0, 0, ONE] };
}

/// Sums of lengths up to 2^19 over a few hundred poses stay below 2^31.
const SUM_SHIFT: u32 = 6;

impl Bounds {
    /// Nothing seen yet.
    pub const fn new() -> Self {
        Bounds { low: [i32::MAX; 3], high: [i32::MIN; 3], leftward: [0; 3] }
    }

    /// Takes in a pose.
    pub fn include<const N: usize, R: RotationBackend>(&mut self, skeleton: &Skeleton<N>, joints: &Kinematics<N, R>) {
        let mut low = [i32::MAX; 3];
        let mut high = [i32::MIN; 3];
        for &position in joints.positions().iter().take(skeleton.bones.len()).skip(skeleton.hips) {
            low = vector(|axis| low[axis].min(position[axis]));
            high = vector(|axis| high[axis].max(position[axis]));
        }
        if let Some([left, right]) = skeleton.sides {
            add(&mut self.leftward, joints.position(usize::from(left)), joints.position(usize::from(right)));
        }
        self.low = vector(|axis| low[axis].min(self.low[axis]));
        self.high = vector(|axis| high[axis].max(self.high[axis]));
    }

    /// The middle of everything seen.
    pub fn middle(&self) -> Vector {
        vector(|axis| (self.low[axis] >> 1).wrapping_add(self.high[axis] >> 1))
    }

    /// Half the extent along an axis.
    pub fn half_extent(&self, axis: usize) -> i32 {
        let axis = axis % 3;
        (self.high[axis] >> 1).saturating_sub(self.low[axis] >> 1)
    }

    /// Up, as the rig states it, and facing: a figure that names no left and right is taken to look along z, or against y if z is up.
    pub fn orientation(&self, rig_up: Up) -> Orientation {
        // At most 2 already; this keeps the checks out of the image.
        let axis = rig_up.axis() % 3;
        let mut up = [0; 3];
        up[axis] = if rig_up.is_negative() { -ONE } else { ONE };
        let mut level = self.leftward;
        level[axis] = 0;
        let ahead = if axis == 2 { [0, -ONE, 0] } else { [0, 0, ONE] };
        let facing = direction(level).map_or(ahead, |left| cross(left, up));
        Orientation { axis, up, facing }
    }
}

impl Default for Bounds {
    fn default() -> Self {
        Bounds::new()
    }
}

fn add(sum: &mut Vector, to: Vector, from: Vector) {
    for axis in 0..3 {
        sum[axis] = sum[axis].saturating_add(to[axis].saturating_sub(from[axis]) >> SUM_SHIFT);
    }
}

/// The cross product of two Q15 vectors of length 1.
pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    vector(|axis| {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        (a[next] * b[last] - a[last] * b[next]) >> 15
    })
}
