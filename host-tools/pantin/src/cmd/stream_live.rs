//! `pantin stream --live`: a face over a line while it is recorded.

use super::stream::{Arguments, closing, sender};
use crate::cmd::Files;
use crate::output::note;
use anyhow::{Context, Result, ensure};
use pantin_convert::import::one_line;
use pantin_line::sender::{LineSettings, Live, LiveChannel, Source};
use pantin_line::stream::live::Feed;
use pantin_line::stream::pace;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Frames that packets are ahead of their time beside what coding takes: what the line's jitter may be.
const AHEAD: u32 = 6;
/// Columns that a warning lists.
const LISTED: usize = 20;
/// About what a refresh takes, in bytes, and the part of the line that all of them may.
const REFRESH_BYTES: f64 = 4.3;
const REFRESHES: f64 = 0.35;

/// Where a value of the feed goes in a pose, and what it is multiplied by.
struct Place {
    value: Option<usize>,
    scale: f64,
}

/// The value of a channel, held within what the channel holds; and whether it was.
fn held(value: f64, scale: f64) -> (i32, bool) {
    let raw = (value * scale).round();
    (raw as i32, raw != f64::from(raw as i32))
}

/// Runs the command.
pub(super) fn run(arguments: &Arguments, from: &str, stop: &AtomicBool) -> Result<()> {
    let [path] = &arguments.clips[..] else { anyhow::bail!("--live: expected one clip, of the face that the other end has") };
    let files = Files::read(path, arguments.rig.as_deref())?;
    let clip = files.open_alone().with_context(|| path.display().to_string())?;
    ensure!(clip.rig().joint_count() == 0, "{}: a clip with joints; --live sends faces alone", path.display());
    let form = clip.form();
    let option = || format!("--live {from}");
    let mut feed = Feed::open(from, stop).with_context(option)?;
    let names = feed.names();
    let places: Vec<Place> = clip
        .rig()
        .scalars()
        .map(|scalar| Place {
            value: names.iter().position(|name| name == scalar.name()),
            scale: (31.0 - f64::from(scalar.exponent)).exp2(),
        })
        .collect();
    ensure!(
        places.iter().any(|place| place.value.is_some()),
        "{}: none of its channels is in what --live brings",
        path.display()
    );
    let left_out: Vec<&str> =
        names.iter().filter(|name| !clip.rig().scalars().any(|scalar| scalar.name() == **name)).map(String::as_str).collect();
    if let Some((first, rest)) = left_out.split_at_checked(LISTED).filter(|(_, rest)| !rest.is_empty()) {
        note!(
            "warning: columns that the clip has no channel for are left out: {} and {} more",
            one_line(&first.join(", ")),
            rest.len()
        );
    } else if !left_out.is_empty() {
        note!("warning: columns that the clip has no channel for are left out: {}", one_line(&left_out.join(", ")));
    }
    let part = arguments.max_scalar_error / 100.0;
    ensure!(
        part > 0.0 && part < 1.0,
        "--max-scalar-error {}: expected more than 0 and less than 100 percent",
        arguments.max_scalar_error
    );
    let raw = |place: &Place, value: f64| held(value, place.scale).0;
    let making: Vec<LiveChannel> =
        places.iter().map(|place| LiveChannel { bound: raw(place, part).max(1), way: raw(place, 1.0).max(1) as u32 }).collect();
    let source = Source::live(form, clip.frame_time_ns(), &making);
    let rate = arguments.to.rate();
    let cycle = REFRESH_BYTES * places.len() as f64 / (REFRESHES * rate) / source.frame_seconds();
    let line = LineSettings {
        rate,
        ahead: AHEAD,
        share: 1.0,
        cycle: cycle.ceil().clamp(8.0, 120.0) as u32,
        parity: arguments.fec,
        key: arguments.tag_key()?,
    };
    let milliseconds = |frames: u32| 1000.0 * f64::from(frames) * source.frame_seconds();
    note!(
        "live: {} channels; shown {:.0} ms after they came; all of them refreshed within {:.0} ms",
        places.iter().filter(|place| place.value.is_some()).count(),
        milliseconds(Live::delay(&line)),
        milliseconds(line.cycle)
    );
    let mut live = sender().live(&source, line, &making);
    let mut out = arguments.to.open()?;
    let (start, frame) = (Instant::now(), Duration::from_nanos(u64::from(clip.frame_time_ns())));
    let (mut values, mut left) = (vec![0.0; names.len()], Live::delay(&line));
    let (mut at, mut cut) = (start, 0_u32);
    while !stop.load(Ordering::Relaxed) && left > 0 {
        match feed.next(at.saturating_duration_since(Instant::now()), &values, stop).with_context(option)? {
            Some(next) => values = next,
            // What has been made is still to be shown.
            None => left -= 1,
        }
        let mut pose = Vec::with_capacity(places.len());
        for place in &places {
            let (index, value) = place.value.and_then(|index| Some((index, *values.get(index)?))).unwrap_or_default();
            let (raw, outside) = held(value, place.scale);
            if outside {
                if cut == 0 {
                    let most = 31f64.exp2() / place.scale;
                    note!(
                        "warning: {}: {value} is outside what the clip's channel holds (-{most} to {most}), and is cut",
                        one_line(&names[index])
                    );
                }
                cut = cut.saturating_add(1);
            }
            pose.push(raw);
        }
        pace::wait(at, stop);
        for timed in live.push(&pose) {
            out.send(&timed.bytes)?;
        }
        at += frame;
        if at.elapsed() > pace::CATCH_UP {
            at = Instant::now();
        }
    }
    note!("{}", closing(live.bytes(), start.elapsed().as_secs_f64()));
    if feed.left_out() > 0 {
        note!("warning: {} datagrams held no face, or values that are no numbers, and were left out", feed.left_out());
    }
    if cut > 0 {
        note!("warning: {cut} values were outside what the clip's channels hold, and were cut");
    }
    if live.omitted_messages() > 0 {
        note!("{} segments found no room on the line: a faster one, or a larger --max-scalar-error", live.omitted_messages());
    }
    Ok(())
}
