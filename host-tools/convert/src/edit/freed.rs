//! A figure for motions of others, from a file that states only what one animation of it turns and moves.

use super::display_names::sources_of_body;
use super::rotation::{local, write};
use crate::fk;
use crate::motion::{Kind, Motion, Rig};
use anyhow::Result;

/// One frame of a motion, its first, in which every joint turns in all directions, and the hips move in all.
pub fn freed(motion: &Motion) -> Result<Motion> {
    let [hips, ..] = sources_of_body(&motion.rig)?;
    let mut rig = Rig { scalars: Vec::new(), ..motion.rig.clone() };
    let mut values: Vec<Vec<f64>> = Vec::new();
    for (index, first) in motion.rig.first_channels().into_iter().enumerate() {
        let old = &motion.rig.joints[index];
        let joint = &mut rig.joints[index];
        joint.offset = fk::local(old, |slot| motion.values[first + slot][0]).1;
        joint.kinds.clear();
        if joint.end_site {
            continue;
        }
        let own = values.len();
        if index == hips {
            joint.kinds.extend([Kind::Xposition, Kind::Yposition, Kind::Zposition]);
            values.extend(joint.offset.map(|place| vec![place]));
        }
        joint.kinds.extend([Kind::Zrotation, Kind::Xrotation, Kind::Yrotation]);
        values.resize(own + joint.kinds.len(), vec![0.0]);
        write(joint, own, &mut values, 0, &local(motion, index, first, 0));
    }
    let keys = vec![None; values.len()];
    Ok(Motion { rig, values, keys, frames: 1, looped: false, events: Vec::new(), ..motion.clone() })
}
