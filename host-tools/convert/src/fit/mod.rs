//! From per-frame motion to segments: the fewest bits within the bound.

mod beam;
pub mod bounds;
pub mod chain;
pub mod channelwise;
pub mod cost;
pub mod descent;
mod extend;
pub mod figure;
pub mod level;
mod measure;
pub mod raw;
pub mod refusal;
pub mod rotation_coding;
pub mod scalars;
pub mod search;
mod segment_price;
pub mod start_cost;

use crate::encode::clip::{Channel, Coded};
use crate::encode::rig as rig_bytes;
use crate::error::{Error, require};
use crate::events;
use crate::motion::Motion;
use crate::note::Remedy;
use crate::number::Number;
use anyhow::Result;
use descent::{Descent, Plan};
use figure::Figure;
use pantin::codec::layout::MAX_FRAMES;
use rotation_coding::Coding;
use scalars::Aim;

/// Parts of the bound that first codes may fill, until all channels find one: those that come late need room.
const FIRST_PARTS: [f64; 4] = [0.7, 0.4, 0.2, 0.05];

/// Codes `motion` within the plan's bound, in the coding that is cheapest for it. `progress` receives the fraction that is
/// done, 0 to 1.
pub fn fit(motion: &Motion, plan: Plan, scalar_part: f64, progress: &mut dyn FnMut(f64)) -> Result<Coded> {
    fit_coding(motion, &Coding::of(&[(motion, plan.bound)], plan.rotations), plan, scalar_part, progress)
}

/// Codes `motion` in a given coding, which clips of its rig can share.
pub fn fit_coding(
    motion: &Motion,
    coding: &Coding,
    plan: Plan,
    scalar_part: f64,
    progress: &mut dyn FnMut(f64),
) -> Result<Coded> {
    let frame_time_ns = time(motion)?;
    let plan = plan.with_time_for(motion.frames * motion.rig.joint_channels());
    let Motion { rig: chosen, values: chosen_values, .. } = coding.apply(motion);
    let length_exponent = coding.length_exponent;
    let scales = raw::scales(&chosen, length_exponent);
    let rests = raw::rests(&motion.rig, length_exponent);
    let kinds = chosen.channel_kinds();
    let file_kinds: Vec<_> = motion.rig.channel_kinds().into_iter().map(|(_, kind)| kind).collect();
    // In turn, so that a long take is not held twice.
    let channels = chosen_values.into_iter().zip(kinds).zip(&scales);
    let targets: Vec<_> = channels.map(|((values, (_, kind)), &scale)| raw::target(&values, kind, scale)).collect();
    let original = Figure::new(motion.rig.clone(), motion.frames).poses(|channel, frame| motion.values[channel][frame]);
    // What will be played has the rig's rounded offsets.
    let bytes = rig_bytes::encode(&motion.rig)?;
    let mut played = rig_bytes::decode(&pantin::Rig::new_checked(&bytes)?);
    for (joint, source) in played.joints.iter_mut().zip(&chosen.joints) {
        joint.kinds.clone_from(&source.kinds);
    }
    let figure = Figure::new(played, motion.frames);
    let joint_channels = motion.rig.joint_channels();
    let aim = |channel: usize| {
        let full_scale = motion.rig.scalars[channel - joint_channels].full_scale;
        Aim { target: targets[channel].clone(), bound: full_scale * scalar_part / scales[channel] }
    };
    let aims: Vec<Aim> = (joint_channels..targets.len()).map(aim).collect();
    let targets = &targets[..joint_channels];
    let mut attempt = |part: f64| {
        let kinds = &file_kinds[..joint_channels];
        Descent::new(&figure, plan, part, targets, &scales, &rests, kinds, &original, motion.frame_time).run(progress)
    };
    let mut found = attempt(FIRST_PARTS[0]);
    for part in &FIRST_PARTS[1..] {
        found = found.or_else(|_| attempt(*part));
    }
    let mut codes = found?;
    codes.extend(scalars::fit(&motion.rig, &aims, plan.effort)?);
    let (events, event_names) = events::to_clip(&motion.events);
    Ok(Coded {
        frames: motion.frames as u32,
        frame_time_ns,
        length_exponent,
        exponentials: coding.exponentials.clone(),
        channels: codes.into_iter().map(|code| Channel { start: code.start, segments: code.segments }).collect(),
        events,
        event_names,
        looped: motion.looped,
    })
}

/// Frame times are written with few digits: one within this part of a usual rate's is that rate's.
const SAME_RATE: f64 = 1e-4;

/// The frame time in ns of a motion whose length in frames and in time a clip can hold.
fn time(motion: &Motion) -> Result<u32> {
    let too_many = || Error::source(format!("{} frames; a clip holds 1 to {MAX_FRAMES}", motion.frames));
    require!((1..=MAX_FRAMES as usize).contains(&motion.frames), too_many().remedy(Remedy::LowerFrameRate));
    let seconds = motion.frame_time;
    let usual = pantin::codec::layout::FRAME_RATES.iter().skip(1).map(|&rate| 1.0 / f64::from(rate));
    let exact = usual.into_iter().find(|usual| (usual / seconds - 1.0).abs() < SAME_RATE).unwrap_or(seconds);
    let ns = (exact * 1e9).round();
    let most = f64::from(u32::MAX) * 1e-9;
    let wrong = || Error::source(format!("a frame time of {} s; a clip holds 1 ns to {most} s", Number(seconds)));
    require!((1.0..=f64::from(u32::MAX)).contains(&ns), wrong().remedy(Remedy::ChangeFrameRate));
    Ok(ns as u32)
}

#[cfg(test)]
mod tests {
    use super::level::Level;
    use super::rotation_coding::Rotations;
    use crate::import::{ImportOptions, InMemory, import};
    use crate::{Length, Options, convert};
    use std::f64::consts::TAU;

    /// Near half a turn a single component of a quaternion is left, whose size turns nothing: nothing but the decoder's range limits it.
    #[test]
    fn components_of_quaternions_stay_within_the_decoders_range() {
        let row = |frame: u32| {
            let (time, wave) = (f64::from(frame), 0.5 - 0.5 * (TAU * f64::from(frame) / 11.932245064526796).cos());
            let (a, b) = (0.18694448145106435 * (0.7 * time).sin(), 0.18694448145106435 * (0.45 * time).sin());
            format!("{a:.2} {:.2} {b:.2}\n", 180.0 - 87.87138149142265 * wave.powi(4))
        };
        let rows: String = (0..111).map(row).collect();
        let knee = format!(
            "HIERARCHY ROOT knee {{ OFFSET 0 0 0 CHANNELS 3 Zrotation Xrotation Yrotation End Site {{ OFFSET 0 10 0 }} }} \
             MOTION Frames: 111 Frame Time: 0.033333\n{rows}"
        );
        let files = InMemory::new().with("knee.bvh", knee.as_bytes());
        let knee = import(&files, "knee.bvh".as_ref(), &ImportOptions::new().cm_per_unit(1.0)).unwrap().motion;
        for max_cm in [0.5, 1.0] {
            let options = Options::new().max_error(Length::cm(max_cm)).rotations(Rotations::Quaternion).effort(Level::FAST);
            let made = convert(&knee, &options, &mut |_| ());
            assert!(made.is_ok(), "{max_cm} cm: {:?}", made.map(|_| ()));
        }
    }
}
