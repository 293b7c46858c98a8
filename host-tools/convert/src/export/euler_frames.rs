//! A motion whose joints turn by Euler angles alone, for formats that hold no quaternions and no exponential maps.

use crate::euler;
use crate::fk;
use crate::motion::{Event, Frames, Joint, Kind, Rig};
use anyhow::Result;

/// The order of a joint whose rig states none: that of most BVH files.
const ORDER: [Kind; 3] = [Kind::Zrotation, Kind::Xrotation, Kind::Yrotation];

/// A motion with three Euler angles in place of every quaternion and exponential map. From frame to frame the angles are continuous.
pub(super) struct EulerFrames<'a, F> {
    of: &'a F,
    rig: Rig,
    /// The motion's channel of each channel here; `None` for an angle that is computed.
    copied: Vec<Option<usize>>,
    turned: Vec<Turned>,
}

/// A joint whose angles are computed.
struct Turned {
    joint: usize,
    /// Its first channel in the motion.
    first: usize,
    /// The channel here of its first angle.
    angle: usize,
    axes: [usize; 3],
}

impl<'a, F: Frames> EulerFrames<'a, F> {
    pub fn new(of: &'a F) -> EulerFrames<'a, F> {
        let mut rig = of.rig().clone();
        let (mut copied, mut turned) = (Vec::new(), Vec::new());
        for ((index, joint), first) in rig.joints.iter_mut().enumerate().zip(of.rig().first_channels()) {
            if joint.kinds.iter().all(|kind| kind.is_position() || kind.is_rotation()) {
                copied.extend((first..first + joint.kinds.len()).map(Some));
                continue;
            }
            let order = order(joint);
            let places = joint.kinds.iter().enumerate().filter(|(_, kind)| kind.is_position());
            copied.extend(places.map(|(slot, _)| Some(first + slot)));
            turned.push(Turned { joint: index, first, angle: copied.len(), axes: order.map(|kind| kind.axis().unwrap_or(0)) });
            copied.extend([None; 3]);
            joint.kinds.retain(|kind| kind.is_position());
            joint.kinds.extend(order);
        }
        copied.extend((of.rig().joint_channels()..of.rig().channels()).map(Some));
        EulerFrames { of, rig, copied, turned }
    }
}

/// The order of a joint's angles: its own, if it has three about different axes beside its quaternion or exponential map.
fn order(joint: &Joint) -> [Kind; 3] {
    let own: Vec<Kind> = joint.kinds.iter().copied().filter(|kind| kind.is_rotation()).collect();
    match own[..] {
        [a, b, c] if a != b && b != c && a != c => [a, b, c],
        _ => ORDER,
    }
}

impl<F: Frames> Frames for EulerFrames<'_, F> {
    fn rig(&self) -> &Rig {
        &self.rig
    }

    fn frame_time(&self) -> f64 {
        self.of.frame_time()
    }

    fn frames(&self) -> usize {
        self.of.frames()
    }

    fn events(&self) -> Vec<Event> {
        self.of.events()
    }

    fn each(&self, each: &mut dyn FnMut(&[f64]) -> Result<()>) -> Result<()> {
        let joints = &self.of.rig().joints;
        let mut angles = vec![[0.0; 3]; self.turned.len()];
        let mut values = vec![0.0; self.copied.len()];
        self.of.each(&mut |pose| {
            for (value, channel) in values.iter_mut().zip(&self.copied) {
                *value = channel.map_or(0.0, |channel| pose[channel]);
            }
            for (Turned { joint, first, angle, axes }, before) in self.turned.iter().zip(&mut angles) {
                let (turn, _) = fk::local(&joints[*joint], |slot| pose[first + slot]);
                *before = euler::near(&turn, *axes, *before);
                values[*angle..angle + 3].copy_from_slice(before);
            }
            each(&values)
        })
    }
}
