//! `pantin stream --live`: a face over a line while it is recorded. Bodies are `stream_body`'s.

use super::live_mapping::Mapping;
use super::stream::{Arguments, closing, sender};
use crate::cmd::Files;
use crate::output::note;
use anyhow::{Context, Result, ensure};
use pantin_line::sender::{LineSettings, Live, LiveTiming, Source};
use pantin_line::stream::address::Output;
use pantin_line::stream::live::Feed;
use pantin_line::stream::pace;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Frames that packets are ahead of their time beside what coding takes: what the line's jitter may be.
const AHEAD: u32 = 6;
/// About what a refresh takes, in bytes, and the part of the line that all of them may.
const REFRESH_BYTES: f64 = 4.3;
const REFRESHES: f64 = 0.35;

/// Runs the command.
pub(super) fn run(arguments: &Arguments, from: &str, stop: &AtomicBool) -> Result<()> {
    let [path] = &arguments.clips[..] else { anyhow::bail!("--live: expected one clip, of the face that the other end has") };
    let files = Files::read(path, arguments.rig.as_deref())?;
    let clip = files.open_alone().with_context(|| path.display().to_string())?;
    if super::stream_body::is_body(from) {
        ensure!(clip.rig().joint_count() > 0, "{}: a clip without joints; --live {from} sends bodies", path.display());
        return super::stream_body::run(arguments, &clip, from, stop);
    }
    let expected = "--live vmc:PORT and --live bvh:- send bodies";
    ensure!(clip.rig().joint_count() == 0, "{}: a clip with joints; {expected}", path.display());
    let feed = Feed::open(from, stop).with_context(|| format!("--live {from}"))?;
    let mapping = Mapping::new(&clip.rig(), feed.names());
    ensure!(mapping.mapped() > 0, "{}: none of its channels is in what --live brings", path.display());
    mapping.warn_of_unmapped(&clip.rig());
    let channels = mapping.live_channels(arguments.max_scalar_error)?;
    let source = Source::live(clip.form(), clip.frame_time_ns(), &channels);
    let line = line_settings(arguments, channels.len(), &source)?;
    note_delays(mapping.mapped(), &line, &source);
    let live = sender().live(&source, line, LiveTiming::FACE, &channels);
    let mut session = Session { feed, mapping, live, line: arguments.to.open()?, delay_frames: LiveTiming::FACE.delay(&line) };
    let start = Instant::now();
    session.send(from, start, Duration::from_nanos(u64::from(clip.frame_time_ns())), stop)?;
    note!("{}", closing(session.live.bytes(), start.elapsed().as_secs_f64()));
    session.note_losses();
    Ok(())
}

/// Settings of the line for this many channels: the shortest cycle in which refreshes take their part of the line.
fn line_settings(arguments: &Arguments, channels: usize, source: &Source) -> Result<LineSettings> {
    let rate = arguments.to.rate();
    let cycle = REFRESH_BYTES * channels as f64 / (REFRESHES * rate) / source.frame_seconds();
    Ok(LineSettings {
        rate,
        ahead: AHEAD,
        share: 1.0,
        cycle: cycle.ceil().clamp(8.0, 120.0) as u32,
        parity: arguments.fec,
        key: arguments.tag_key()?,
    })
}

fn note_delays(channels: usize, line: &LineSettings, source: &Source) {
    let milliseconds = |frames: u32| 1000.0 * f64::from(frames) * source.frame_seconds();
    note!(
        "live: {channels} channels; shown {:.0} ms after they came; all of them refreshed within {:.0} ms",
        milliseconds(LiveTiming::FACE.delay(line)),
        milliseconds(line.cycle)
    );
}

/// A face on its way from a feed to a line.
struct Session<'s> {
    feed: Feed,
    mapping: Mapping,
    live: Live<'s>,
    line: Output,
    /// Frames from when one comes until it is shown.
    delay_frames: u32,
}

impl Session<'_> {
    /// Sends a pose each frame from `start` on, until the feed has ended and its last frame is shown, or until `stop`. Errors of the feed begin
    /// with the option's value `from`.
    fn send(&mut self, from: &str, start: Instant, frame: Duration, stop: &AtomicBool) -> Result<()> {
        let mut values = vec![0.0; self.feed.names().len()];
        let (mut left, mut at) = (self.delay_frames, start);
        while !stop.load(Ordering::Relaxed) && left > 0 {
            let next = self.feed.next(at.saturating_duration_since(Instant::now()), &values, stop);
            match next.with_context(|| format!("--live {from}"))? {
                Some(next) => values = next,
                // What has been made is still to be shown.
                None => left -= 1,
            }
            let pose = self.mapping.pose(&values);
            pace::wait(at, stop);
            for timed in self.live.push(&pose) {
                self.line.send(&timed.bytes)?;
            }
            at += frame;
            if at.elapsed() > pace::CATCH_UP {
                at = Instant::now();
            }
        }
        Ok(())
    }

    /// Prints what was left out, cut or not sent.
    fn note_losses(&self) {
        let (left_out, cut) = (self.feed.left_out(), self.mapping.cut());
        if left_out > 0 {
            note!("warning: {left_out} datagrams held no face, or values that are no numbers, and were left out");
        }
        if cut > 0 {
            note!("warning: {cut} values were outside what the clip's channels hold, and were cut");
        }
        let omitted = self.live.omitted_messages();
        if omitted > 0 {
            note!("{omitted} segments found no room on the line: a faster one, or a larger --max-scalar-error");
        }
    }
}
