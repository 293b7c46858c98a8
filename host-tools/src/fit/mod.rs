//! From per-frame motion to segments: the fewest bits within the bound.

pub mod bounds;
pub mod chain;
pub mod channelwise;
pub mod cost;
pub mod descent;
pub mod figure;
pub mod parametrize;
pub mod raw;
pub mod refusal;
pub mod search;

use crate::encode::clip::{Channel, Coded};
use crate::encode::rig as rig_bytes;
use crate::motion::Motion;
use anyhow::{Result, anyhow};
use descent::{Descent, Plan};
use figure::Figure;

/// Parts of the bound that first codes may fill, until all channels find one: those that come late need room.
const FIRST_PARTS: [f64; 4] = [0.7, 0.4, 0.2, 0.05];

/// Codes `motion` within the plan's bound. `progress` hears the part that is done, 0 to 1.
pub fn fit(motion: &Motion, plan: Plan, scalar_part: f64, progress: &mut dyn FnMut(f64)) -> Result<Coded> {
    let (chosen, exponentials) = parametrize::parametrize(motion, plan.bound_cm);
    let length_exponent = raw::clip_length_exponent(&motion.rig, &motion.values);
    let scales = raw::scales(&chosen.rig, length_exponent);
    let rests = raw::rests(&motion.rig, length_exponent);
    let targets: Vec<Vec<f64>> =
        chosen.values.iter().zip(&scales).map(|(values, scale)| values.iter().map(|x| x / scale).collect()).collect();
    let original = Figure::new(motion.rig.clone(), motion.frames).poses(&motion.values);
    // What will be played has the rig's rounded offsets.
    let bytes = rig_bytes::encode(&motion.rig)?;
    let mut played = rig_bytes::decode(&pantin::Rig::new_checked(&bytes)?);
    for (joint, source) in played.joints.iter_mut().zip(&chosen.rig.joints) {
        joint.kinds.clone_from(&source.kinds);
    }
    let figure = Figure::new(played, motion.frames);
    let joint_channels = motion.rig.joint_channels();
    let scalar_bound = |channel: usize| {
        channel.checked_sub(joint_channels).map_or(0.0, |s| motion.rig.scalars[s].full_scale * scalar_part / scales[channel])
    };
    let scalar_bounds: Vec<f64> = (0..targets.len()).map(scalar_bound).collect();
    let mut failed = None;
    let mut codes = None;
    for first_part in FIRST_PARTS {
        let descent =
            Descent::new(&figure, plan, first_part, &targets, &scales, &rests, &scalar_bounds, &original, motion.frame_time);
        match descent.run(progress) {
            Ok(found) => {
                codes = Some(found);
                break;
            }
            Err(error) => failed = Some(error),
        }
    }
    let codes = codes.ok_or_else(|| failed.unwrap_or_else(|| anyhow!("no attempt was made")))?;
    Ok(Coded {
        frames: motion.frames as u32,
        frame_time_ns: frame_time_ns(motion.frame_time),
        length_exponent,
        exponentials,
        channels: codes.into_iter().map(|code| Channel { start: code.start, segments: code.segments }).collect(),
        events: Vec::new(),
        looped: motion.looped,
    })
}

/// Frame times are written with few digits: one within this part of a usual rate's is that rate's.
const SAME_RATE: f64 = 1e-4;

fn frame_time_ns(seconds: f64) -> u32 {
    let usual = pantin::layout::FRAME_RATES.iter().skip(1).map(|&rate| 1.0 / f64::from(rate));
    let exact = usual.into_iter().find(|usual| (usual / seconds - 1.0).abs() < SAME_RATE).unwrap_or(seconds);
    (exact * 1e9).round() as u32
}
