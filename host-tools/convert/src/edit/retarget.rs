//! `--retarget display`: any humanoid figure's motion on the display's 15 joints.
//!
//! Each joint turns as the source joint that it stands for has turned since the rest pose, and from there by the least that aims its
//! bones at the places of the source's joints; the hips stand where the source's do. So places are met but for what the 15 bones
//! cannot do (a spine that bends, collars that lift), and [`Retargeted`] says how far they are off.

use super::display::{Body, aim, body, pose, subtract, transposed};
use super::display_names::{DISPLAY, sources};
use crate::euler;
use crate::fk::{Matrix, apply, product};
use crate::motion::{Joint, Motion};
use anyhow::Result;

/// A motion of the display's body.
#[derive(Clone, Debug)]
pub struct Retargeted {
    /// The motion; the source's scalars go on.
    pub motion: Motion,
    /// Greatest distance, in cm, of a display's joint from the source joint that it stands for.
    pub max_cm: f64,
    /// The joint that has it.
    pub joint: &'static str,
    /// When it has it.
    pub frame: usize,
    /// Names of the source's joints, as the display's stand for them.
    pub sources: Vec<(&'static str, String)>,
}

/// Puts `motion` on the display's body. `map` is the text of a map file, or nothing. Errors name the joints that were not found.
pub fn display(motion: &Motion, map: &str) -> Result<Retargeted> {
    let sources = sources(&motion.rig, map)?;
    let body = body(motion, &sources);
    let channels = body.rig.joint_channels();
    let named = sources.iter().zip(&DISPLAY).map(|(&source, entry)| (entry.0, motion.rig.joints[source].name.clone()));
    let mut out = Retargeted { motion: motion.clone(), max_cm: 0.0, joint: "Hips", frame: 0, sources: named.collect() };
    let mut values: Vec<Vec<f64>> = vec![Vec::with_capacity(motion.frames); channels];
    let mut angles = [[0.0; 3]; 15];
    for frame in 0..motion.frames {
        let source = pose(motion, Some(frame));
        let turned: [Matrix; 15] =
            std::array::from_fn(|index| product(&source[sources[index]].0, &transposed(&body.turns[index])));
        let goals = sources.map(|joint| source[joint].1);
        let (turns, places) = follow(&body, turned, &goals);
        for index in 0..15 {
            let off = subtract(places[index], goals[index]);
            let cm = off.iter().map(|x| x * x).sum::<f64>().sqrt() * motion.rig.cm_per_unit;
            if cm > out.max_cm {
                (out.max_cm, out.joint, out.frame) = (cm, DISPLAY[index].0, frame);
            }
        }
        write(&body.rig.joints, &turns, goals[0], &mut angles, &mut values);
    }
    values.extend_from_slice(&motion.values[motion.rig.joint_channels()..]);
    let mut keys = vec![None; channels];
    keys.extend_from_slice(&motion.keys[motion.rig.joint_channels()..]);
    out.motion = Motion { rig: body.rig, values, keys, events: motion.events.clone(), ..*motion };
    Ok(out)
}

/// World turns and places of the display's joints with the source's at `goals`; `turned` are the source's own turns since the rest.
fn follow(body: &Body, turned: [Matrix; 15], goals: &[[f64; 3]; 15]) -> ([Matrix; 15], [[f64; 3]; 15]) {
    let mut turns = turned;
    let mut places = *goals;
    for index in 0..15 {
        let children: Vec<usize> = (0..15).filter(|&child| DISPLAY[child].1 == Some(index)).collect();
        let bones: Vec<[f64; 3]> = children.iter().map(|&child| subtract(body.rest[child], body.rest[index])).collect();
        let aims: Vec<[f64; 3]> = children.iter().map(|&child| subtract(goals[child], places[index])).collect();
        if !children.is_empty() {
            turns[index] = aim(turns[index], &bones, &aims);
        }
        for (&child, bone) in children.iter().zip(&bones) {
            places[child] = super::display::add(places[index], apply(&turns[index], *bone));
        }
    }
    (turns, places)
}

/// Adds a frame's channels.
fn write(joints: &[Joint], turns: &[Matrix; 15], hips: [f64; 3], angles: &mut [[f64; 3]; 15], values: &mut [Vec<f64>]) {
    hips.iter().zip(&mut *values).for_each(|(x, values)| values.push(*x));
    let mut next = 3;
    for (index, joint) in joints.iter().filter(|joint| !joint.end_site).enumerate() {
        let own = match DISPLAY[index].1 {
            Some(parent) => product(&transposed(&turns[parent]), &turns[index]),
            None => turns[index],
        };
        let axes: Vec<usize> = joint.kinds.iter().filter(|kind| kind.is_rotation()).filter_map(|kind| kind.axis()).collect();
        angles[index] = euler::near(&own, [axes[0], axes[1], axes[2]], angles[index]);
        for angle in angles[index] {
            values[next].push(angle);
            next += 1;
        }
    }
}
