//! Key-frame text (docs/KEYFRAMES.md) of a key clip: the keys with the numbers that were written.

use crate::conversion::convert;
use crate::encode::rig;
use crate::events;
use crate::expand::expand_made;
use crate::fit::raw;
use crate::keys::{cubics, sample_pieces, within};
use crate::motion::{self, Rig};
use crate::options::{ChannelBound, Options};
use anyhow::{Context, Result, ensure};
use pantin::{ChannelState, Clip, Interpolation, Kind, Player};
use std::fmt::Write;

/// The keys of one channel.
#[derive(Clone, Debug, PartialEq)]
struct Curve {
    interpolation: Interpolation,
    /// Frame, and value in thousandths.
    keys: Vec<(u32, i32)>,
}

/// Channels that share their key times and interpolation, and the keys of each.
struct Block {
    first: usize,
    curves: Vec<Curve>,
}

/// The text of a key clip. Fails for a clip of segments, and for names that the text cannot hold.
pub fn write(clip: &Clip<'_>) -> Result<String> {
    ensure!(clip.has_keys(), "the clip holds segments, no keys; `pantin convert --keys` makes clips of keys");
    let rig = rig::decode(&clip.rig());
    let mut text = head(clip, &rig)?;
    let curves = curves(clip, &rig)?;
    let mut channel = 0;
    while channel < curves.len() {
        let Some(mut block) = block(&rig, &curves, channel)? else {
            channel += rig.key_group(channel).len();
            continue;
        };
        let mut next = channel + block.curves.len();
        // Groups that follow with the same key times share the rows.
        while next < curves.len()
            && let Some(more) = self::block(&rig, &curves, next)?
            && times(&more.curves[0]).eq(times(&block.curves[0]))
            && more.curves[0].interpolation == block.curves[0].interpolation
        {
            next += more.curves.len();
            block.curves.extend(more.curves);
        }
        put(&mut text, clip, &rig, &block)?;
        channel = next;
    }
    Ok(text)
}

/// A key clip's curves as a clip of segments, for players without feature `keys`: every channel as it is, but for rounding
/// ([`ChannelBound::Exact`]). Its rig stays out if the key clip has none.
pub fn to_segments(clip: &Clip<'_>) -> Result<Vec<u8>> {
    ensure!(clip.has_keys(), "the clip holds segments already");
    let mut motion = expand_made(clip)?;
    for (channel, curve) in curves(clip, &motion.rig)?.into_iter().enumerate() {
        let Some(Curve { interpolation, keys }) = curve.filter(|curve| curve.keys.len() > 1) else { continue };
        let keys: Vec<(usize, f64)> = keys.iter().map(|&(frame, value)| (frame as usize, f64::from(value) / 1000.0)).collect();
        let interpolation = match interpolation {
            Interpolation::Linear => motion::Interpolation::Linear,
            Interpolation::CatmullRom => motion::Interpolation::CatmullRom,
            Interpolation::Natural => motion::Interpolation::Natural,
            Interpolation::Discrete => motion::Interpolation::Discrete,
        };
        let pieces = cubics(&keys, interpolation, clip.looped());
        let values = sample_pieces(&pieces, motion.frames);
        motion.keys[channel] = Some(within(keys, interpolation, pieces, &values));
        motion.values[channel] = values;
    }
    let options = Options::new().channels(ChannelBound::Exact).rig_apart(clip.rig_len() == 0);
    Ok(convert(&motion, &options, &mut |_| ())?.clip)
}

fn times(curve: &Curve) -> impl Iterator<Item = u32> + '_ {
    curve.keys.iter().map(|&(time, _)| time)
}

/// A name as a word of the text.
fn word(name: &str) -> Result<&str> {
    let holds = !name.is_empty() && !name.contains(|c: char| c.is_whitespace() || c.is_control() || c == '#');
    ensure!(holds, "key-frame text holds no name with white space, control characters or `#`: `{}`", name.escape_debug());
    Ok(name)
}

/// The number of fewest decimals within half a step of a value.
fn decimal(value: f64, step: f64) -> String {
    let near = |decimals: usize| format!("{value:.decimals$}");
    let fits = |text: &String| text.parse::<f64>().is_ok_and(|read| (read - value).abs() <= step / 2.0);
    let text = (0..17).map(near).find(fits).unwrap_or_else(|| value.to_string());
    if text.strip_prefix('-').is_some_and(|rest| rest.bytes().all(|byte| b"0.".contains(&byte))) {
        text[1..].into()
    } else {
        text
    }
}

/// Thousandths as a number.
fn thousandths(value: i32) -> String {
    decimal(f64::from(value) / 1000.0, 0.0005)
}

/// Figure, timing and events.
fn head(clip: &Clip<'_>, rig: &Rig) -> Result<String> {
    ensure!(!rig.joints.iter().any(|joint| joint.helper), "key-frame text holds no helper joints");
    let time = f64::from(clip.frame_time_ns());
    let fps = 1e9 / time;
    // A step of the rate that changes the frame time by less than 1 ns.
    let fps = decimal(fps, fps / time);
    let mut text = format!("keyframes 1\nfps {fps}\nframes {}\n", clip.frames());
    text += if clip.looped() { "loop\n" } else { "" };
    writeln!(text, "cm-per-unit {}\n", decimal(rig.cm_per_unit, 1e-6))?;
    let step = 2f64.powi(clip.rig().length_exponent().into());
    for joint in &rig.joints {
        let offset = joint.offset.map(|along| decimal(along, step)).join(" ");
        let parent = joint.parent.map(|parent| word(&rig.joints[parent].name)).transpose()?;
        let parent = parent.map_or_else(String::new, |name| format!(" parent {name}"));
        if joint.end_site {
            writeln!(text, "end{parent} offset {offset}")?;
            continue;
        }
        write!(text, "joint {}{parent} offset {offset}", word(&joint.name)?)?;
        let kinds: Vec<String> = joint.kinds.iter().map(|kind| format!("{kind:?}")).collect();
        writeln!(text, "{}{}", if kinds.is_empty() { "" } else { " channels " }, kinds.join(" "))?;
    }
    for scalar in &rig.scalars {
        writeln!(text, "scalar {} scale {}", word(&scalar.name)?, decimal(scalar.full_scale, 0.0))?;
    }
    for event in events::of_clip(clip) {
        writeln!(text, "event {} {}", word(&event.name)?, event.frame)?;
    }
    Ok(text)
}

/// The keys of every channel; a channel that does not move has one, or none if it rests.
fn curves(clip: &Clip<'_>, rig: &Rig) -> Result<Vec<Option<Curve>>> {
    let (mut states, mut pose) = (vec![ChannelState::default(); clip.moving()], vec![0; rig.channels()]);
    let player = Player::new(*clip, &mut states, &mut pose)?;
    ensure!(!player.is_malformed(), "the clip's keys break a rule of the format");
    let scales = raw::scales(rig, clip.length_exponent());
    let constant = |(channel, place): (usize, (Option<usize>, Kind))| {
        let value = f64::from(player.pose().values[channel]) * scales[channel] * 1000.0;
        let keys = vec![(0, value.round() as i32)];
        let rests = (value - 1000.0 * rig.rest(place)).abs() < 0.5;
        (!rests).then_some(Curve { interpolation: Interpolation::Linear, keys })
    };
    let mut curves: Vec<Option<Curve>> = rig.channel_kinds().into_iter().enumerate().map(constant).collect();
    for (index, state) in player.states().iter().enumerate() {
        let keys = player.channel_keys(index).context("a moving channel without keys")?;
        curves[state.slot()] = Some(Curve { interpolation: keys.interpolation(), keys: keys.iter().collect() });
    }
    Ok(curves)
}

/// The block of the group that begins with a channel: the text keys a quaternion or an exponential map as a whole. `None` if it rests.
fn block(rig: &Rig, curves: &[Option<Curve>], first: usize) -> Result<Option<Block>> {
    let group = rig.key_group(first);
    let own = &curves[group.clone()];
    let Some(most) = own.iter().flatten().max_by_key(|curve| curve.keys.len()) else { return Ok(None) };
    let mut all: Vec<u32> = own.iter().flatten().flat_map(times).collect();
    all.sort_unstable();
    all.dedup();
    let kinds = rig.channel_kinds();
    let on_all = |channel: usize| {
        let at_rest = (1000.0 * rig.rest(kinds[channel])).round() as i32;
        let rests = Curve { interpolation: most.interpolation, keys: vec![(0, at_rest)] };
        let curve = curves[channel].as_ref().unwrap_or(&rests);
        let name = || rig.channel_name(channel);
        let linear = curve.interpolation == Interpolation::Linear;
        ensure!(
            curve.keys.len() == 1 || curve.interpolation == most.interpolation && (linear || curve.keys.len() == all.len()),
            "{}: its keys are not at the times of its joint's other channels",
            name()
        );
        let keys = all.iter().map(|&time| Some((time, value_at(&curve.keys, time)?)));
        let keys =
            keys.collect::<Option<_>>().with_context(|| format!("{}: no multiple of 0.001 at another channel's key", name()))?;
        Ok(Curve { interpolation: most.interpolation, keys })
    };
    Ok(Some(Block { first, curves: group.map(on_all).collect::<Result<_>>()? }))
}

/// The value of straight lines at a frame, if it is whole.
fn value_at(keys: &[(u32, i32)], time: u32) -> Option<i32> {
    let after = keys.iter().position(|&(own, _)| own >= time);
    let Some(after) = after.filter(|&after| after > 0 || keys[0].0 == time) else { return keys.last().map(|&(_, value)| value) };
    let (to, value) = keys[after];
    if to == time {
        return Some(value);
    }
    let (from, before) = keys[after - 1];
    let (rise, frames) = (i64::from(value) - i64::from(before), i64::from(to - from));
    let passed = rise * i64::from(time - from);
    (passed % frames == 0).then(|| before + (passed / frames) as i32)
}

fn put(text: &mut String, clip: &Clip<'_>, rig: &Rig, Block { first, curves }: &Block) -> Result<()> {
    let names = (0..curves.len()).map(|place| rig.channel_name(first + place));
    let names = names.map(|name| word(&name).map(str::to_owned)).collect::<Result<Vec<_>>>()?.join(" ");
    let by = match curves[0].interpolation {
        Interpolation::Linear => "linear",
        Interpolation::CatmullRom => "catmull-rom",
        Interpolation::Natural => "natural",
        Interpolation::Discrete => "discrete",
    };
    writeln!(text, "\nkeys {by} {names}")?;
    let rows = curves[0].keys.len();
    // A loop's first key comes again by itself at its end.
    let closed = clip.looped() && rows > 2 && curves.iter().all(|curve| curve.keys[rows - 1].1 == curve.keys[0].1);
    for row in 0..rows - usize::from(closed) {
        let values: Vec<String> = curves.iter().map(|curve| thousandths(curve.keys[row].1)).collect();
        writeln!(text, "{:5}  {}", curves[0].keys[row].0, values.join(" "))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::{ImportOptions, Imported, load};
    use crate::key_clip;
    use crate::motion::Motion;
    use std::path::{Path, PathBuf};

    fn loaded(path: &Path) -> Motion {
        let Imported { motion, .. } = load(path, &ImportOptions::new()).unwrap();
        motion
    }

    fn made(motion: &Motion) -> Vec<u8> {
        let rig = rig::encode(&motion.rig).unwrap();
        let time = (motion.frame_time * 1e9).round() as u32;
        key_clip(motion, &rig, (time, raw::clip_length_exponent(&motion.rig, &motion.values)), false).unwrap()
    }

    /// Text, clip and text again of every motion of ours; the values of the text that was written by hand are within their rounding.
    #[test]
    fn keys_come_back_as_they_were_written() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions");
        let folders = ["", "library", "face", "emotes"].map(|folder| root.join(folder));
        let files = folders.iter().flat_map(|folder| std::fs::read_dir(folder).unwrap()).map(|entry| entry.unwrap().path());
        let files: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|extension| extension == "keys")).collect();
        assert_eq!(files.len(), 59);
        let out = tempfile::tempdir().unwrap();
        for file in files {
            let written = loaded(&file);
            let clip = made(&written);
            let text = write(&Clip::new_checked(&clip).unwrap()).unwrap();
            let path = out.path().join("back.keys");
            std::fs::write(&path, &text).unwrap();
            let back = loaded(&path);
            assert_eq!(
                (back.frames, back.looped, &back.events),
                (written.frames, written.looped, &written.events),
                "{}",
                file.display()
            );
            assert!((back.frame_time - written.frame_time).abs() < 1e-9, "{}", file.display());
            for (channel, (values, others)) in back.values.iter().zip(&written.values).enumerate() {
                let off = values.iter().zip(others).map(|(value, other)| (value - other).abs()).fold(0.0, f64::max);
                // Values of the faces have four decimals; a constant angle comes back by its 32 bits.
                assert!(off < 0.0006, "{}: {} is {off} off", file.display(), written.rig.channel_name(channel));
            }
            assert!(made(&back) == clip, "{}: the text makes another clip", file.display());
        }
    }

    #[test]
    fn segments_play_the_curves_of_a_key_clip() {
        let files = ["walk", "greet", "face/yawn"].map(|name| format!("../../motions/{name}.keys"));
        for file in files.map(|file| Path::new(env!("CARGO_MANIFEST_DIR")).join(file)) {
            let keyed = made(&loaded(&file));
            let keyed = Clip::new_checked(&keyed).unwrap();
            let segments = to_segments(&keyed).unwrap();
            let segments = Clip::new_checked(&segments).unwrap();
            assert!(!segments.has_keys() && segments.rig_len() == keyed.rig_len() && segments.looped() == keyed.looped());
            assert!(segments.events().eq(keyed.events()));
            let [played, exact] = [segments, keyed].map(|clip| expand_made(&clip).unwrap());
            for (values, others) in played.values.iter().zip(&exact.values) {
                let off = values.iter().zip(others).map(|(value, other)| (value - other).abs()).fold(0.0, f64::max);
                assert!(off < 0.007, "{}: {off} off", file.display());
            }
        }
    }

    #[test]
    fn a_clip_of_segments_has_no_keys() {
        let motion = loaded(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions/run.keys"));
        let options = crate::Options::new();
        let converted = crate::convert(&motion, &options, &mut |_| {}).unwrap();
        let error = write(&Clip::new_checked(&converted.clip).unwrap()).unwrap_err();
        assert!(error.to_string().starts_with("the clip holds segments"), "{error}");
    }
}
