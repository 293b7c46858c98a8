//! A way for a figure that treads on the spot.

use super::contacts::feet;
use super::display::{norm, pose, transposed};
use super::facing::{carriers, facing};
use super::footsteps::{goes_over, ground, tracks};
use crate::error::{Error, Setting, require};
use crate::fk::{all_positions, apply};
use crate::memory::Memory;
use crate::motion::Motion;
use anyhow::Result;
use std::str::FromStr;

/// How fast a figure goes that treads on the spot.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Pace {
    /// In cm a second, in the direction in which the figure faces in the mean; backwards below 0.
    CmPerSecond(f64),
    /// As fast as feet on the ground slide, and in the opposite direction: they then stand.
    Feet,
}

impl FromStr for Pace {
    type Err = String;

    /// `feet`, or a speed with a unit: cm/s, mm/s, m/s or in/s; without one, cm/s.
    fn from_str(text: &str) -> Result<Pace, String> {
        let text = text.trim();
        if text == "feet" {
            return Ok(Pace::Feet);
        }
        let units = [("cm/s", 1.0), ("mm/s", 0.1), ("in/s", 2.54), ("m/s", 100.0), ("", 1.0)];
        let split = |(unit, factor): &(&str, f64)| Some((text.strip_suffix(unit)?, *factor));
        let (number, factor) = units.iter().find_map(split).unwrap_or((text, 1.0));
        let speed = number.trim().parse().ok().map(|number: f64| number * factor);
        let speed = speed.filter(|speed| speed.is_finite() && speed.abs() <= Pace::GREATEST);
        speed.map(Pace::CmPerSecond).ok_or_else(|| "expected a speed, like 120cm/s or 1.2m/s, or `feet`".into())
    }
}

impl Pace {
    /// The greatest speed in cm a second: 1 km a second.
    pub const GREATEST: f64 = 1e5;
}

/// Lets the joint that carries the figure go with a steady pace. Returns the motion and the speed in cm a second.
pub fn pace(motion: &Motion, pace: Pace, memory: Memory) -> Result<(Motion, f64)> {
    let refused = |text: &str| Error::setting(Setting::Pace, text);
    let velocity = match pace {
        Pace::CmPerSecond(speed) => {
            let valid = speed.is_finite() && speed.abs() <= Pace::GREATEST;
            require!(valid, refused("expected a speed of at most 1 km a second"));
            let ahead = facing(motion).ok_or_else(|| {
                refused("no direction in which the figure faces: no names tell left from right, or it turns to all sides")
            })?;
            ahead.map(|x| x * speed)
        }
        Pace::Feet => feet_velocity(motion, memory)?,
    };
    let step = velocity.map(|x| x * motion.frame_time / motion.rig.cm_per_unit);
    let walking = carriers(motion).into_iter().find_map(|carrier| moved(motion, carrier, step));
    let walking = walking.ok_or_else(|| refused("no joint has the positions that the way takes"))?;
    Ok((walking, norm(velocity)))
}

/// Part of the way that may be lost where a joint has not all positions: a walk whose root goes straight ahead faces a little to the side in the mean.
const LOST: f64 = 0.1;

/// The motion with a joint that goes one step farther in each frame; `None` if its channels cannot do that.
fn moved(motion: &Motion, carrier: usize, step: [f64; 3]) -> Option<Motion> {
    let (joint, first) = (&motion.rig.joints[carrier], motion.rig.first_channels()[carrier]);
    let slots: [Option<usize>; 3] =
        std::array::from_fn(|axis| joint.kinds.iter().position(|kind| kind.is_position() && kind.axis() == Some(axis)));
    let mut out = motion.clone();
    for frame in 0..motion.frames {
        let way = step.map(|x| x * frame as f64);
        let local = match joint.parent {
            None => way,
            Some(parent) => apply(&transposed(&pose(motion, Some(frame))[parent].0), way),
        };
        for (slot, part) in slots.iter().zip(local) {
            match slot {
                Some(slot) => out.values[first + slot][frame] += part,
                None if part.abs() > LOST * norm(way) => return None,
                None => {}
            }
        }
    }
    for slot in slots.into_iter().flatten().filter(|slot| out.values[first + slot] != motion.values[first + slot]) {
        out.keys[first + slot] = None;
    }
    Some(out)
}

/// Speed in cm a second below which feet on the ground stand.
const STANDING: f64 = 3.0;

/// The horizontal velocity in cm a second that lets the feet stand which are on the ground.
fn feet_velocity(motion: &Motion, memory: Memory) -> Result<[f64; 3]> {
    let feet = feet(&motion.rig, [None, None])
        .map_err(|error| Error::setting(Setting::Pace, Error::of(&error, Error::source).problem().text.clone()))?;
    let poses = all_positions(&motion.rig, &motion.values, motion.frames, memory)?;
    let tracks: Vec<_> = feet.iter().map(|foot| tracks(motion, &poses, foot.ankle)).collect();
    let mut velocity = ground(&tracks).map(|x| -x);
    velocity[motion.rig.up.axis()] = 0.0;
    let goes = goes_over(norm(velocity), &poses, motion, STANDING);
    Ok(if goes { [0.0; 3] } else { velocity })
}
