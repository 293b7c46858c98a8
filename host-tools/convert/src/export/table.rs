//! CSV out: a row of names, then time and values frame by frame, for spreadsheets, plots, and the table importer.

use crate::motion::{Frames, Joint, Kind, Rig};
use anyhow::Result;
use std::collections::HashSet;
use std::io::Write;

/// Significant digits of a channel's greatest value, at least: what rounding takes is at most 5e-8 of it.
const DIGITS: i32 = 7;
/// Decimals at least, so that rounding takes at most 5e-8 of the unit however great the values are: a clip's bound is not of them.
const DECIMALS: i32 = 7;

/// Writes `motion` as CSV: `time` in seconds, joints' channels as `hip.Xrotation` in their units, scalars by their names. A name that
/// stands there already gets a number behind it, so that the table can be read again. A motion with events gets a last column of their names, with `|`
/// between those of one frame.
pub fn write(motion: &impl Frames, out: impl Write) -> Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    writer.write_field("time")?;
    names(motion.rig()).iter().try_for_each(|name| writer.write_field(name))?;
    let events = motion.events();
    if !events.is_empty() {
        writer.write_field(EVENTS)?;
    }
    writer.write_record(None::<&[u8]>)?;
    let mut peaks = vec![0f64; motion.rig().channels()];
    each_pose(motion, &mut |pose| {
        peaks.iter_mut().zip(pose).for_each(|(peak, value)| *peak = peak.max(value.abs()));
        Ok(())
    })?;
    let decimals: Vec<usize> = peaks.into_iter().map(decimals).collect();
    let (mut frame, mut left) = (0u32, events.as_slice());
    each_pose(motion, &mut |pose| {
        writer.write_field(number(f64::from(frame) * motion.frame_time(), 9))?;
        for (&value, &decimals) in pose.iter().zip(&decimals) {
            writer.write_field(number(value, decimals))?;
        }
        if !events.is_empty() {
            let (here, later) = left.split_at(left.iter().take_while(|event| event.frame <= frame as usize).count());
            left = later;
            writer.write_field(here.iter().map(|event| event.name.as_str()).collect::<Vec<_>>().join("|"))?;
        }
        frame += 1;
        Ok(writer.write_record(None::<&[u8]>)?)
    })?;
    Ok(writer.flush()?)
}

/// Calls `each` with the values at every frame, in which a quaternion without length, as a clip has it for a joint at rest, is 1, 0, 0, 0: both turn nothing.
fn each_pose(motion: &impl Frames, each: &mut dyn FnMut(&[f64]) -> Result<()>) -> Result<()> {
    let quaternions = quaternions(motion.rig());
    let mut values = Vec::new();
    motion.each(&mut |pose| {
        values.clear();
        values.extend_from_slice(pose);
        for (real, channels) in &quaternions {
            if channels.iter().all(|&channel| pose[channel] == 0.0) {
                values[*real] = 1.0;
            }
        }
        each(&values)
    })
}

/// The channels of each joint's quaternion, and which of them is w.
fn quaternions(rig: &Rig) -> Vec<(usize, Vec<usize>)> {
    let of_joint = |(joint, first): (&Joint, usize)| {
        let real = joint.kinds.iter().position(|kind| *kind == Kind::Wquaternion)?;
        let channels = (first..).zip(&joint.kinds).filter(|(_, kind)| kind.is_quaternion()).map(|(channel, _)| channel);
        Some((first + real, channels.collect()))
    };
    rig.joints.iter().zip(rig.first_channels()).filter_map(of_joint).collect()
}

/// The name of the column of events.
const EVENTS: &str = "events";

/// A name for every channel, all different from each other and from the columns of times and events.
fn names(rig: &Rig) -> Vec<String> {
    let mut taken: HashSet<String> = HashSet::from(["time".into(), "event".into(), EVENTS.into()]);
    let mut name = |channel: usize| {
        let plain = rig.channel_name(channel);
        let plain = if plain.trim().is_empty() { format!("channel{channel}") } else { plain };
        let numbered = (2..).map(|number| format!("{plain}_{number}"));
        let free = std::iter::once(plain.clone()).chain(numbered).find(|name| !taken.contains(name)).unwrap_or(plain);
        taken.insert(free.clone());
        free
    };
    (0..rig.channels()).map(&mut name).collect()
}

/// Decimals that leave values up to `peak` their digits.
fn decimals(peak: f64) -> usize {
    if peak == 0.0 { 0 } else { DECIMALS.max(DIGITS - 1 - peak.log10().floor() as i32) as usize }
}

fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let short = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if short == "-0" { "0".into() } else { short.into() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::{Event, Motion, Scalar};

    #[test]
    fn every_channel_has_a_column() {
        let joint = Joint {
            name: "hip".into(),
            parent: None,
            offset: [0.0; 3],
            kinds: vec![Kind::Xrotation],
            end_site: false,
            helper: false,
        };
        let scalars = ["jaw, open", "still"].map(|name| Scalar { name: name.into(), full_scale: 1.0 });
        let rig = Rig { joints: vec![joint], scalars: scalars.to_vec(), cm_per_unit: 1.0, ..Rig::default() };
        let values = vec![vec![-370.125, 12.0], vec![1.0 / 3.0, -1e-12], vec![0.0; 2]];
        let motion = Motion {
            rig,
            frame_time: 1.0 / 30.0,
            frames: 2,
            keys: vec![None; 3],
            values,
            looped: false,
            events: Vec::new(),
            origin: Default::default(),
        };
        let mut out = Vec::new();
        write(&motion, &mut out).unwrap();
        let expected = "time,hip.Xrotation,\"jaw, open\",still\n0,-370.125,0.3333333,0\n0.033333333,12,0,0\n";
        assert_eq!(String::from_utf8(out).unwrap(), expected);
        let event = |name: &str| Event { frame: 1, name: name.into() };
        let mut out = Vec::new();
        write(&Motion { events: vec![event("step"), event("clap")], ..motion }, &mut out).unwrap();
        let expected = "time,hip.Xrotation,\"jaw, open\",still,events\n0,-370.125,0.3333333,0,\n0.033333333,12,0,0,step|clap\n";
        assert_eq!(String::from_utf8(out).unwrap(), expected);
    }

    #[test]
    fn a_quaternion_at_rest_is_the_identity() {
        use Kind::{Wquaternion, Xquaternion, Yquaternion, Zquaternion};
        let joint = |name: &str, kinds: &[Kind]| Joint {
            name: name.into(),
            parent: None,
            offset: [0.0; 3],
            kinds: kinds.to_vec(),
            end_site: false,
            helper: false,
        };
        let joints = vec![
            joint("still", &[Wquaternion, Xquaternion, Yquaternion, Zquaternion]),
            joint("turned", &[Xquaternion, Yquaternion, Zquaternion, Wquaternion]),
        ];
        let rig = Rig { joints, cm_per_unit: 1.0, ..Rig::default() };
        let values = [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0].map(|value| vec![value]).to_vec();
        let mut out = Vec::new();
        write(&Motion::sampled(rig, 0.1, 1, values), &mut out).unwrap();
        assert_eq!(String::from_utf8(out).unwrap().lines().nth(1), Some("0,1,0,0,0,1,0,0,0"));
    }

    /// Places far from the origin, of which a bound may be a millionth.
    #[test]
    fn great_values_keep_small_parts() {
        for value in [40_453.148_7, -9_208.5, 1_234_567.890_123_4, 1e-3 / 3.0] {
            let text = number(value, decimals(value.abs()));
            assert!((text.parse::<f64>().unwrap() - value).abs() <= 6e-8, "{value}: {text}");
        }
    }

    #[test]
    fn many_events_take_linear_time() {
        let frames = 100_000;
        let rig = Rig { scalars: vec![Scalar { name: "a".into(), full_scale: 1.0 }], cm_per_unit: 1.0, ..Rig::default() };
        let events = (0..frames).map(|frame| Event { frame, name: "step".into() }).collect();
        let values = vec![vec![0.0; frames]];
        let motion = Motion {
            rig,
            frame_time: 0.001,
            frames,
            keys: vec![None],
            values,
            looped: false,
            events,
            origin: Default::default(),
        };
        let (mut out, begun) = (Vec::new(), std::time::Instant::now());
        write(&motion, &mut out).unwrap();
        assert!(begun.elapsed().as_secs_f64() < 3.0, "{:?}", begun.elapsed());
        assert_eq!(String::from_utf8(out).unwrap().lines().filter(|line| line.ends_with(",step")).count(), frames);
    }
}
