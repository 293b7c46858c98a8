//! Poses of a clip's rig from rotations of its joints: motion that comes joint by joint while it is captured.

use crate::edit::display_names::found;
use crate::encode::rig;
use crate::euler;
use crate::fit::figure::exponential_near;
use crate::fit::raw;
use crate::fk::{Matrix, from_quaternion, quaternion};
use crate::motion::{Joint, Kind, Rig};
use anyhow::Result;
use pantin::{ChannelState, Clip, Player, Up};

/// A pose of a clip's rig, joint by joint, in the clip's form.
#[derive(Clone, Debug)]
pub struct Posing {
    /// Kinds of channels are those that the clip codes.
    rig: Rig,
    first: Vec<usize>,
    /// Units of a channel in a raw unit.
    scales: Vec<f64>,
    values: Vec<f64>,
}

impl Posing {
    /// The rig of `clip`, in the pose of its first frame.
    pub fn new(clip: &Clip<'_>) -> Result<Posing> {
        let mut rig = rig::decode(&clip.rig());
        for (index, joint) in rig.joints.iter_mut().enumerate() {
            joint.kinds = clip.kinds(index).collect();
        }
        let scales = raw::scales(&rig, clip.length_exponent());
        let mut states = vec![ChannelState::default(); clip.moving()];
        let mut pose = vec![0; rig.channels()];
        let player = Player::new(*clip, &mut states, &mut pose)?;
        let values = player.pose().values.iter().zip(&scales).map(|(raw, scale)| f64::from(*raw) * scale).collect();
        Ok(Posing { first: rig.first_channels(), rig, scales, values })
    }

    /// The joints, End Sites included.
    pub fn joints(&self) -> &[Joint] {
        &self.rig.joints
    }

    /// The length of a unit of places in cm.
    pub fn cm_per_unit(&self) -> f64 {
        self.rig.cm_per_unit
    }

    /// The direction of the world that is vertical.
    pub fn up(&self) -> Up {
        self.rig.up
    }

    /// The joint that stands for each of the display body's 15 joints, by the usual names.
    pub fn body_joints(&self) -> [Option<usize>; 15] {
        found(&self.rig)
    }

    /// Turns a joint in its parent: w, x, y, z of any length but 0. Channels that it lacks do not turn.
    pub fn set_turn(&mut self, joint: usize, components: [f64; 4]) {
        let Some(entry) = self.rig.joints.get(joint) else { return };
        let turn = from_quaternion(components);
        let of = |is: fn(Kind) -> bool| -> Vec<(usize, usize)> {
            let slots = entry.kinds.iter().enumerate().filter(|(_, kind)| is(**kind));
            slots
                .map(|(slot, kind)| {
                    (self.first[joint] + slot, kind.axis().map_or(0, |axis| axis + usize::from(kind.is_quaternion())))
                })
                .collect()
        };
        let values = &mut self.values;
        set_euler(values, &of(Kind::is_rotation), &turn);
        if let [(x, _), (y, _), (z, _)] = of(Kind::is_exponential)[..] {
            let vector = exponential_near(&turn, [x, y, z].map(|channel| values[channel]));
            [x, y, z].into_iter().zip(vector).for_each(|(channel, value)| values[channel] = value);
        }
        let [x, y, z, w] = quaternion(&turn);
        let slots = of(Kind::is_quaternion);
        // Of the two that turn alike, the one nearer to the last.
        let along: f64 = slots.iter().map(|&(channel, part)| values[channel] * [w, x, y, z][part]).sum();
        let sign = if along < 0.0 { -1.0 } else { 1.0 };
        slots.iter().for_each(|&(channel, part)| values[channel] = sign * [w, x, y, z][part]);
    }

    /// Puts a joint at a place in its parent, in the rig's units, along the axes on which it has position channels.
    pub fn set_place(&mut self, joint: usize, place: [f64; 3]) {
        let Some(entry) = self.rig.joints.get(joint) else { return };
        for (slot, kind) in entry.kinds.iter().enumerate().filter(|(_, kind)| kind.is_position()) {
            if let Some(axis) = kind.axis() {
                self.values[self.first[joint] + slot] = place[axis];
            }
        }
    }

    /// The pose as a player has it: one raw value a channel. Angles wrap, other values are limited to what 32 bits hold.
    pub fn raw(&self) -> Vec<i32> {
        let raw = |((value, scale), wraps): ((&f64, &f64), bool)| {
            let raw = (value / scale).round();
            if wraps { raw as i64 as i32 } else { raw as i32 }
        };
        self.values.iter().zip(&self.scales).zip(self.wraps()).map(raw).collect()
    }

    /// For each channel whether it is an angle, whose raw values wrap.
    pub fn wraps(&self) -> Vec<bool> {
        self.rig.channel_kinds().iter().map(|(_, kind)| kind.is_rotation()).collect()
    }

    /// For each channel the raw value of an error: `degrees` of angles and exponential maps, `cm` of places, and `part` of the full scale of the rest.
    pub fn raw_errors(&self, degrees: f64, cm: f64, part: f64) -> Vec<i32> {
        let error = |((_, kind), scale): (&(Option<usize>, Kind), &f64)| {
            let error = match kind {
                kind if kind.is_position() => cm / self.rig.cm_per_unit,
                kind if kind.is_rotation() || kind.is_exponential() => degrees,
                _ => part,
            };
            ((error / scale).round() as i32).max(1)
        };
        self.rig.channel_kinds().iter().zip(&self.scales).map(error).collect()
    }
}

/// Sets one to three angles, given as channels with their axes, so that they turn as `turn` does, or as near as a joint with fewer than three turns.
fn set_euler(values: &mut [f64], slots: &[(usize, usize)], turn: &Matrix) {
    let mut axes: Vec<usize> = slots.iter().map(|(_, axis)| *axis).collect();
    if let [(channel, axis)] = *slots {
        let [x, y, z, w] = quaternion(turn);
        let angle = 2.0 * [x, y, z][axis].atan2(w).to_degrees();
        values[channel] = euler::nearest(angle, values[channel]);
        return;
    }
    axes.extend((0..3).filter(|axis| !slots.iter().any(|(_, own)| own == axis)));
    // Angles that come twice have no order of three axes.
    let Ok(axes) = <[usize; 3]>::try_from(axes) else { return };
    if slots.is_empty() || axes.iter().fold(0, |seen, axis| seen | 1 << axis) != 7 {
        return;
    }
    let mut before = [0.0; 3];
    slots.iter().zip(&mut before).for_each(|((channel, _), before)| *before = values[*channel]);
    let angles = euler::near(turn, axes, before);
    slots.iter().zip(angles).for_each(|((channel, _), angle)| values[*channel] = angle);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fk::rotations;
    use crate::import::{ImportOptions, InMemory, import};
    use crate::{Options, Rotations, convert};

    const FIGURE: &str = "HIERARCHY ROOT hip { OFFSET 0 0 0 CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation \
        JOINT knee { OFFSET 0 -40 0 CHANNELS 1 Xrotation JOINT foot { OFFSET 0 -40 0 CHANNELS 2 Xrotation Zrotation End Site { OFFSET 0 0 20 } } } } \
        MOTION Frames: 2 Frame Time: 0.04  1 90 2 10 20 30 5 6 7  1 91 2 11 21 31 6 7 8";

    #[test]
    fn turns_become_the_channels_of_every_form() {
        let files = InMemory::new().with("a.bvh", FIGURE.as_bytes());
        let motion = import(&files, "a.bvh".as_ref(), &ImportOptions::new().cm_per_unit(1.0)).unwrap().motion;
        for form in [Rotations::Euler, Rotations::Exponential, Rotations::Quaternion] {
            let made = convert(&motion, &Options::new().rotations(form), &mut |_| ()).unwrap();
            let mut posing = Posing::new(&Clip::new_checked(&made.clip).unwrap()).unwrap();
            let half = |degrees: f64| (degrees / 2.0).to_radians();
            let turns = [
                [0.8, 0.4, -0.2, 0.4],
                [half(50.0).cos(), half(50.0).sin(), 0.0, 0.0],
                [half(-20.0).cos(), 0.0, 0.0, half(-20.0).sin()],
            ];
            for (joint, turn) in turns.into_iter().enumerate() {
                posing.set_turn(joint, turn);
            }
            posing.set_place(0, [3.0, 88.0, -4.0]);
            let values: Vec<Vec<f64>> = posing.values.iter().map(|value| vec![*value]).collect();
            for (found, wanted) in rotations(&posing.rig, &values, 0).iter().zip(turns) {
                let along: f64 = found.iter().zip(wanted).map(|(a, b)| a * b).sum();
                assert!(along.abs() > 1.0 - 1e-9, "{form:?}: {found:?} is not {wanted:?}");
            }
            assert_eq!(posing.values[..3], [3.0, 88.0, -4.0]);
            let back: Vec<f64> = posing.raw().iter().zip(&posing.scales).map(|(raw, scale)| f64::from(*raw) * scale).collect();
            assert!(back.iter().zip(&posing.values).all(|(a, b)| (a - b).abs() < 1e-5), "{form:?}: {back:?}");
        }
    }
}
