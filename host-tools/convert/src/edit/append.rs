//! One motion after another, with a blend from the one to the other.

use super::rotation::{between, local, turns_freely, twist, write};
use crate::error::{Error, Setting, require};
use crate::fk::{Matrix, about, apply, product};
use crate::motion::{Event, Joint, Motion};
use anyhow::Result;

/// Adds `next` to the end of `motion`: the last `blend` frames of the one go over to the first ones of the other. The figure goes on from where it is: the joint that
/// carries it keeps its horizontal place and, where it can turn any way, its heading. Both must have the same joints.
pub fn append(motion: &Motion, next: &Motion, blend: usize) -> Result<Motion> {
    let differs = |text: String| Error::setting(Setting::Append, text);
    let names =
        |motion: &Motion| motion.rig.joints.iter().map(|joint| (joint.name.clone(), joint.kinds.clone())).collect::<Vec<_>>();
    let (own, other) = (names(motion), names(next));
    if let Some(index) = (0..own.len().max(other.len())).find(|&index| own.get(index) != other.get(index)) {
        let name = |names: &[(String, Vec<_>)]| names.get(index).map_or_else(|| "no more joints".into(), |joint| joint.0.clone());
        let text = format!("joint {index} is {} in the one and {} in the other, or has other channels", name(&own), name(&other));
        return Err(differs(text).into());
    }
    let scalars = motion.rig.scalars.iter().map(|scalar| &scalar.name).eq(next.rig.scalars.iter().map(|scalar| &scalar.name));
    require!(scalars, differs("the two have other scalars".into()));
    let shortest = motion.frames.min(next.frames);
    let room = || differs(format!("a blend of {blend} frames does not fit the shorter motion, which has {shortest}"));
    require!(blend <= shortest, room());

    let start = motion.frames - blend;
    let placed = placed(motion, next, start.min(motion.frames - 1));
    let mut out = motion.clone();
    out.frames = start + next.frames;
    for (values, more) in out.values.iter_mut().zip(&placed.values) {
        values.truncate(start);
        values.extend_from_slice(more);
    }
    blend_frames(motion, &placed, start, blend, &mut out);
    out.keys = vec![None; out.values.len()];
    out.looped = false;
    out.events.retain(|event| event.frame < start);
    out.add_events(next.events.iter().map(|event| Event { frame: event.frame + start, name: event.name.clone() }));
    out.origin.error_cm = motion.origin.error_cm.max(next.origin.error_cm);
    Ok(out)
}

/// `next`, moved and turned about the vertical so that its first frame stands where `motion` stands at a frame.
fn placed(motion: &Motion, next: &Motion, at: usize) -> Motion {
    let mut out = next.clone();
    let rig = &motion.rig;
    let carrier = rig.joints.iter().position(|joint| joint.kinds.iter().any(|kind| kind.is_position()));
    let Some(carrier) = carrier else { return out };
    let (joint, first, up) = (&rig.joints[carrier], rig.first_channels()[carrier], rig.up.axis());
    let all_places = (0..3).all(|axis| slot(joint, axis).is_some());
    let turns = turns_freely(joint) && all_places && joint.parent.is_none();
    let turn = if turns {
        about(up, twist(&local(motion, carrier, first, at), up) - twist(&local(next, carrier, first, 0), up))
    } else {
        about(up, 0.0)
    };
    let from = place(joint, first, next, 0);
    let to = place(joint, first, motion, at);
    for frame in 0..next.frames {
        let now = place(joint, first, next, frame);
        let way = apply(&turn, [0, 1, 2].map(|axis| if axis == up { 0.0 } else { now[axis] - from[axis] }));
        for axis in (0..3).filter(|&axis| axis != up) {
            if let Some(slot) = slot(joint, axis) {
                out.values[first + slot][frame] = to[axis] + way[axis];
            }
        }
        if turns {
            let turned = product(&turn, &local(next, carrier, first, frame));
            write(joint, first, &mut out.values, frame, &turned);
        }
    }
    out
}

/// The channel of a joint's place on an axis.
fn slot(joint: &Joint, axis: usize) -> Option<usize> {
    joint.kinds.iter().position(|kind| kind.is_position() && kind.axis() == Some(axis))
}

/// Where a joint's channels place it.
fn place(joint: &Joint, first: usize, motion: &Motion, frame: usize) -> [f64; 3] {
    [0, 1, 2].map(|axis| slot(joint, axis).map_or(joint.offset[axis], |slot| motion.values[first + slot][frame]))
}

/// Mixes the frames that both have: rotations on the shortest way, the weight with velocity 0 at both ends.
fn blend_frames(motion: &Motion, next: &Motion, start: usize, blend: usize, out: &mut Motion) {
    let firsts = motion.rig.first_channels();
    let free: Vec<bool> = motion.rig.joints.iter().map(turns_freely).collect();
    for ahead in 0..blend {
        let part = (ahead as f64 + 1.0) / (blend as f64 + 1.0);
        let weight = part * part * (3.0 - 2.0 * part);
        for channel in 0..out.values.len() {
            let (a, b) = (motion.values[channel][start + ahead], next.values[channel][ahead]);
            out.values[channel][start + ahead] = a + weight * (b - a);
        }
        for (index, joint) in motion.rig.joints.iter().enumerate().filter(|(index, _)| free[*index]) {
            let turns: [Matrix; 2] =
                [local(motion, index, firsts[index], start + ahead), local(next, index, firsts[index], ahead)];
            let mixed = between(&turns[0], &turns[1], weight);
            write(joint, firsts[index], &mut out.values, start + ahead, &mixed);
        }
    }
    // The second one goes on from the values that the blend ended with, not from others that turn alike.
    for (index, joint) in motion.rig.joints.iter().enumerate().filter(|(index, _)| free[*index] && blend > 0) {
        for frame in start + blend..out.frames {
            let turn = local(next, index, firsts[index], frame - start);
            write(joint, firsts[index], &mut out.values, frame, &turn);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::{Kind, Rig};

    /// A figure of one joint that goes along z with 1 a frame, turned about y by `heading` degrees.
    fn walk(frames: usize, heading: f64) -> Motion {
        use Kind::*;
        let kinds = vec![Xposition, Yposition, Zposition, Zrotation, Xrotation, Yrotation];
        let joint = Joint { name: "hips".into(), parent: None, offset: [0.0; 3], kinds, end_site: false, helper: false };
        let (s, c) = f64::to_radians(heading).sin_cos();
        let values = (0..6).map(|channel| {
            let of = |frame: usize| [frame as f64 * s, 9.0, frame as f64 * c, 0.0, 0.0, heading][channel];
            (0..frames).map(of).collect()
        });
        Motion {
            rig: Rig { joints: vec![joint], cm_per_unit: 1.0, ..Rig::default() },
            frame_time: 0.1,
            frames,
            values: values.collect(),
            keys: vec![None; 6],
            looped: false,
            events: vec![Event { frame: 2, name: "clap".into() }],
            origin: Default::default(),
        }
    }

    #[test]
    fn the_figure_goes_on_from_where_it_is_and_where_it_looks() {
        let both = append(&walk(20, 30.0), &walk(30, -100.0), 5).unwrap();
        let straight = walk(45, 30.0);
        assert_eq!((both.frames, both.events.iter().map(|event| event.frame).collect::<Vec<_>>()), (45, vec![2, 17]));
        for (channel, (a, b)) in both.values.iter().zip(&straight.values).enumerate() {
            assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9), "channel {channel}: {a:?} is not {b:?}");
        }
    }

    #[test]
    fn without_a_blend_one_follows_the_other_and_too_long_a_blend_is_refused() {
        assert_eq!(append(&walk(20, 0.0), &walk(30, 0.0), 0).unwrap().frames, 50);
        let error = append(&walk(20, 0.0), &walk(30, 0.0), 21).unwrap_err().to_string();
        assert!(error.contains("does not fit the shorter motion, which has 20"), "{error}");
    }
}
