//! Shows how joints are turned by places alone.

use pantin_convert::motion::{Joint, Motion};

/// The motion with two End Sites a joint, `length` along its own x and y: they show how it is turned.
pub fn probed(motion: &Motion, length: f64) -> Motion {
    let mut probed = motion.clone();
    for parent in 0..motion.rig.joints.len() {
        for offset in [[length, 0.0, 0.0], [0.0, length, 0.0]] {
            let end =
                Joint { name: String::new(), parent: Some(parent), offset, kinds: Vec::new(), end_site: true, helper: false };
            probed.rig.joints.push(end);
        }
    }
    probed
}
