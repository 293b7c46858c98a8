//! A motion whose keys are known as a key clip, which holds the keys themselves.

use crate::encode::keys::{Curve, KeyMotion, KeyedChannel, encode, rests};
use crate::events;
use crate::expand::expand_made;
use crate::motion::{Interpolation, Keys, Kind, Motion, Piece};
use anyhow::{Context, Result, bail, ensure};
use pantin::Clip;
use pantin::codec::keys::{MAX_KEY_FRAMES, MAX_THOUSANDTHS, interpolation};

/// How far a channel may be from the source's curve: in degrees, and in cm for positions.
const EXACT: f64 = 0.001;
/// The same for scalars and components of quaternions, as a part of their range.
const EXACT_PART: f64 = 1e-5;

/// The key clip of `motion`, played by the device's own decoder and found within [`EXACT`] at every frame. An error says why there is none.
pub fn key_clip(motion: &Motion, rig: &[u8], (frame_time_ns, length_exponent): (u32, i8), apart: bool) -> Result<Vec<u8>> {
    let keyed = key_motion(motion, rig, frame_time_ns, length_exponent)?;
    let bytes = encode(&keyed, rig, apart)?;
    let clip = Clip::with_rig(&bytes, rig).context("the key clip that was just made does not open")?;
    check(motion, &clip)?;
    Ok(bytes)
}

fn key_motion(motion: &Motion, rig: &[u8], frame_time_ns: u32, length_exponent: i8) -> Result<KeyMotion> {
    let frames = u32::try_from(motion.frames).ok().filter(|&frames| frames <= MAX_KEY_FRAMES);
    let frames = frames.with_context(|| format!("{} frames; a key clip holds {MAX_KEY_FRAMES}", motion.frames))?;
    let parsed = pantin::Rig::new_checked(rig)?;
    let channels = rests(&parsed).enumerate().map(|(channel, (_, rest))| {
        let (values, keys) = (&motion.values[channel], &motion.keys[channel]);
        keyed(values, keys.as_ref(), rest, frames, motion.looped).with_context(|| motion.rig.channel_name(channel))
    });
    let channels = channels.collect::<Result<_>>()?;
    let (events, event_names) = events::to_clip(&motion.events);
    Ok(KeyMotion { frames, frame_time_ns, length_exponent, channels, events, event_names, looped: motion.looped })
}

/// A channel's keys, as few as give the same curve.
fn keyed(values: &[f64], keys: Option<&Keys>, rest: i32, frames: u32, looped: bool) -> Result<KeyedChannel> {
    if values.iter().all(|value| *value == values[0]) {
        let value = thousandths(values[0])?;
        return Ok(if value == rest { KeyedChannel::Rest } else { KeyedChannel::Constant(value) });
    }
    let Some(Keys::OnFrames { interpolation, pieces, .. }) = keys else { bail!("its curve has no keys on frames") };
    let last = if looped { frames } else { frames - 1 };
    let mut curve = curve(*interpolation, pieces, last)?;
    if curve.interpolation == interpolation::LINEAR {
        straighten(&mut curve, frames, looped);
    }
    Ok(match curve.values[..] {
        [value, ref others @ ..] if others.iter().all(|&other| other == value) => KeyedChannel::Constant(value),
        _ => KeyedChannel::Keyed(curve),
    })
}

fn curve(by: Interpolation, pieces: &[Piece], last: u32) -> Result<Curve> {
    let interpolation = match by {
        Interpolation::Linear => interpolation::LINEAR,
        Interpolation::CatmullRom => interpolation::CATMULL_ROM,
        Interpolation::Natural => interpolation::NATURAL,
        Interpolation::Discrete => interpolation::DISCRETE,
    };
    let (mut times, mut values) = (Vec::new(), Vec::new());
    for piece in pieces {
        ensure!(piece.start.fract() == 0.0 && piece.start >= 0.0, "a key between frames");
        times.push(piece.start as u32);
        values.push(thousandths(piece.p)?);
    }
    let end = pieces.last().context("its curve has no keys")?;
    ensure!(end.start < f64::from(last), "a key behind the last frame");
    times.push(last);
    values.push(thousandths(end.at(f64::from(last) - end.start))?);
    Ok(Curve { interpolation, times, values })
}

fn thousandths(value: f64) -> Result<i32> {
    let rounded = (value * 1000.0).round();
    ensure!(rounded.abs() < MAX_THOUSANDTHS as f64, "a key of {value}; the greatest is {}", MAX_THOUSANDTHS / 1000);
    Ok(rounded as i32)
}

/// Leaves out the keys of straight lines that lie on the line between their neighbours. The last key of a loop, which no frame shows, goes on as the
/// frame before it does.
fn straighten(curve: &mut Curve, frames: u32, looped: bool) {
    let Curve { times, values, .. } = curve;
    let count = times.len();
    if looped && count > 2 && times[count - 2] == frames - 1 {
        let [a, b] = [count - 3, count - 2];
        let (rise, length) = (values[b] - values[a], (times[b] - times[a]) as i32);
        if rise % length == 0 {
            values[count - 1] = values[b] + rise / length;
        }
    }
    let mut key = 1;
    while key + 1 < times.len() {
        let (left, right) = (i64::from(times[key] - times[key - 1]), i64::from(times[key + 1] - times[key]));
        let rise = |from: usize| i64::from(values[from + 1]) - i64::from(values[from]);
        if rise(key - 1) * right == rise(key) * left {
            times.remove(key);
            values.remove(key);
        } else {
            key += 1;
        }
    }
}

/// Plays the clip, and compares every channel at every frame.
fn check(motion: &Motion, clip: &Clip<'_>) -> Result<()> {
    let mut states = vec![pantin::ChannelState::default(); clip.moving()];
    let mut pose = vec![0; clip.rig().channels()];
    ensure!(!pantin::Player::new(*clip, &mut states, &mut pose)?.is_malformed(), "an acceleration beyond 32 bits");
    let played = expand_made(clip)?;
    for (channel, (_, kind)) in motion.rig.channel_kinds().into_iter().enumerate() {
        let bound = match kind {
            _ if kind.is_position() => EXACT / motion.rig.cm_per_unit,
            Kind::Scalar => EXACT_PART * motion.rig.scalars[channel - motion.rig.joint_channels()].full_scale,
            _ if kind.is_quaternion() => EXACT_PART,
            _ => EXACT,
        };
        let wrap = |off: f64| if kind.is_rotation() { off - 360.0 * (off / 360.0).round() } else { off };
        for (frame, (value, other)) in motion.values[channel].iter().zip(&played.values[channel]).enumerate() {
            let off = wrap(value - other).abs();
            ensure!(off <= bound, "{} is {off:.6} off at frame {frame}", motion.rig.channel_name(channel));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::encode::rig;
    use crate::fit::raw::clip_length_exponent;
    use crate::import::{ImportOptions, load};
    use std::path::Path;

    fn made(motion: &Motion) -> Result<Vec<u8>> {
        let rig = rig::encode(&motion.rig).unwrap();
        let time = (motion.frame_time * 1e9).round() as u32;
        key_clip(motion, &rig, (time, clip_length_exponent(&motion.rig, &motion.values)), false)
    }

    fn own(name: &str) -> Motion {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions").join(name).with_extension("keys");
        load(&path, &ImportOptions::new()).unwrap().motion
    }

    #[test]
    fn the_walk_and_the_run_take_fewer_bytes_than_the_papers() {
        for (name, most) in [("walk", 90), ("run", 110)] {
            let bytes = made(&own(name)).unwrap();
            let motion_len = Clip::new_checked(&bytes).unwrap().motion_len();
            assert!(motion_len <= most, "{name}: {motion_len} bytes");
        }
    }

    #[test]
    fn a_motion_without_a_key_clip_says_why() {
        let reason = |change: fn(&mut Motion)| {
            let mut motion = own("greet");
            change(&mut motion);
            format!("{:#}", made(&motion).unwrap_err())
        };
        fn second(motion: &mut Motion) -> &mut Piece {
            let pieces = motion.keys.iter_mut().flatten().find_map(|keys| match keys {
                Keys::OnFrames { pieces, .. } => pieces.get_mut(1),
                _ => None,
            });
            pieces.unwrap()
        }
        assert!(reason(|motion| second(motion).start += 0.5).ends_with("a key between frames"));
        assert!(reason(|motion| second(motion).p = 1e6).ends_with("a key of 1000000; the greatest is 67108"));
        assert!(reason(|motion| second(motion).p += 0.5).contains(" off at frame "));
        assert!(reason(|motion| motion.frames = 8192).starts_with("8192 frames"));
        assert!(
            reason(|motion| motion.keys.iter_mut().for_each(|keys| *keys = None)).ends_with("its curve has no keys on frames")
        );
    }
}
