//! `pantin stream --live vmc:PORT` and `--live bvh:-`: a body over a line while it is captured.

use super::convert_stream::{next_chunk, read_chunks};
use super::stream::{Arguments, closing, sender};
use crate::output::note;
use anyhow::{Context, Result};
use pantin::Clip;
use pantin_line::sender::{LineSettings, Live, LiveChannel, LiveTiming, Source};
use pantin_line::stream::address::Output;
use pantin_line::stream::body::Body;
use pantin_line::stream::pace;
use std::io;
use std::net::UdpSocket;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError};
use std::time::{Duration, Instant};

/// Frames that packets are ahead of their time beside what coding takes. The receiver's clock gives the line's jitter a few more.
const AHEAD: u32 = 2;
/// About what a refresh takes, in bytes, and the part of the line that all of them may.
const REFRESH_BYTES: f64 = 4.3;
const REFRESHES: f64 = 0.1;
/// How far places may be off, in cm, and how far they go, in cm.
const PLACE_CM: f64 = 0.5;
const WAY_CM: f64 = 100.0;
/// Most bytes of a datagram over UDP.
const MOST_DATAGRAM: usize = 65_536;

/// Whether `--live FROM` is a body.
pub(super) fn is_body(from: &str) -> bool {
    from.starts_with("vmc:") || from.starts_with("bvh:")
}

/// Where a body comes from.
enum Feed {
    Datagrams(UdpSocket),
    Bytes { chunks: Receiver<io::Result<Vec<u8>>>, ended: bool },
}

/// Runs the command.
pub(super) fn run(arguments: &Arguments, clip: &Clip<'_>, from: &str, stop: &AtomicBool) -> Result<()> {
    let (mut feed, mut body) = open(clip, from).with_context(|| format!("--live {from}"))?;
    let channels = channels(&body, arguments);
    let source = Source::live(clip.form(), clip.frame_time_ns(), &channels);
    let line = line_settings(arguments, channels.len(), &source)?;
    let milliseconds = |frames: u32| 1000.0 * f64::from(frames) * source.frame_seconds();
    note!(
        "live: {} channels; shown {:.0} ms after they came, and up to 5 frames later; all of them refreshed within {:.0} ms",
        channels.len(),
        milliseconds(LiveTiming::BODY.delay(&line)),
        milliseconds(line.cycle)
    );
    let mut live = sender().live(&source, line, LiveTiming::BODY, &channels);
    let mut output = arguments.to.open()?;
    let start = Instant::now();
    let frame = Duration::from_nanos(u64::from(clip.frame_time_ns()));
    let sent = send(&mut feed, &mut body, &mut live, &mut output, (start, frame, LiveTiming::BODY.delay(&line)), stop);
    sent.with_context(|| format!("--live {from}"))?;
    note!("{}", closing(live.bytes(), start.elapsed().as_secs_f64()));
    note_losses(&body, &live);
    Ok(())
}

fn open(clip: &Clip<'_>, from: &str) -> Result<(Feed, Body)> {
    if from == "bvh:-" {
        return Ok((Feed::Bytes { chunks: read_chunks(Path::new("-"))?, ended: false }, Body::bvh(clip, Path::new("-"))?));
    }
    let port = from.strip_prefix("vmc:").and_then(|port| port.parse::<u16>().ok());
    let port = port.context("expected vmc:PORT, or bvh:- for rows on stdin")?;
    let body = Body::vmc(clip)?;
    let socket = UdpSocket::bind(("0.0.0.0", port)).context("the port cannot be had")?;
    Ok((Feed::Datagrams(socket), body))
}

fn channels(body: &Body, arguments: &Arguments) -> Vec<LiveChannel> {
    let posing = body.posing();
    let bounds = posing.raw_errors(arguments.max_turn_error, PLACE_CM, arguments.max_scalar_error / 100.0);
    let ways = posing.raw_errors(180.0, WAY_CM, 1.0);
    let of = |((bound, way), wraps): ((i32, i32), bool)| LiveChannel { bound, way: way as u32, wraps };
    bounds.into_iter().zip(ways).zip(posing.wraps()).map(of).collect()
}

/// Settings of the line for this many channels: the shortest cycle in which refreshes take their part of the line.
fn line_settings(arguments: &Arguments, channels: usize, source: &Source) -> Result<LineSettings> {
    let rate = arguments.to.rate();
    let cycle = REFRESH_BYTES * channels as f64 / (REFRESHES * rate) / source.frame_seconds();
    let cycle = cycle.ceil().clamp(8.0, 120.0) as u32;
    Ok(LineSettings { rate, ahead: AHEAD, share: 1.0, cycle, parity: arguments.fec, key: arguments.tag_key()? })
}

/// Sends a pose each frame until the feed has ended and its last frame is shown, or until `stop`.
fn send(
    feed: &mut Feed,
    body: &mut Body,
    live: &mut Live<'_>,
    line: &mut Output,
    (start, frame, delay): (Instant, Duration, u32),
    stop: &AtomicBool,
) -> Result<()> {
    let (mut left, mut at) = (delay, start);
    while !stop.load(Ordering::Relaxed) && left > 0 {
        if !feed.take(body, at, stop)? || body.is_over() {
            // What has been made is still to be shown.
            left -= 1;
        }
        let pose = body.pose();
        body.take_log().iter().for_each(|line| note!("{line}"));
        pace::wait(at, stop);
        for timed in live.push(&pose) {
            line.send(&timed.bytes)?;
        }
        at += frame;
        if at.elapsed() > pace::CATCH_UP {
            at = Instant::now();
        }
    }
    Ok(())
}

impl Feed {
    /// Takes poses until the time of the next frame. Returns whether the sender may send more.
    fn take(&mut self, body: &mut Body, until: Instant, stop: &AtomicBool) -> Result<bool> {
        match self {
            Feed::Datagrams(socket) => {
                let mut room = vec![0; MOST_DATAGRAM];
                loop {
                    let left = until.saturating_duration_since(Instant::now());
                    if left.is_zero() {
                        return Ok(true);
                    }
                    socket.set_read_timeout(Some(left))?;
                    match socket.recv_from(&mut room) {
                        Ok((len, from)) => body.receive(from, &room[..len]),
                        Err(error) if matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut) => {}
                        // On some systems an earlier answer that nobody took.
                        Err(error) if matches!(error.kind(), io::ErrorKind::Interrupted | io::ErrorKind::ConnectionReset) => {}
                        Err(error) => return Err(error.into()),
                    }
                }
            }
            Feed::Bytes { chunks, ended } => {
                // The first row is waited for; then every frame shows what has come.
                while !*ended && !body.has_row() {
                    let chunk = match body.posing_has_begun() {
                        false => next_chunk(chunks, stop),
                        true => match chunks.try_recv() {
                            Ok(chunk) => Some(chunk),
                            Err(TryRecvError::Empty) => break,
                            Err(TryRecvError::Disconnected) => None,
                        },
                    };
                    match chunk {
                        Some(chunk) => body.push(&chunk.context("stdin")?)?,
                        None if stop.load(Ordering::Relaxed) => return Ok(false),
                        None => {
                            *ended = true;
                            body.end()?;
                        }
                    }
                }
                Ok(!*ended || body.has_row())
            }
        }
    }
}

/// Prints what was left out or not sent.
fn note_losses(body: &Body, live: &Live<'_>) {
    if body.left_out() > 0 {
        note!("warning: {} datagrams or rows were left out", body.left_out());
    }
    let omitted = live.omitted_messages();
    if omitted > 0 {
        note!(
            "{omitted} segments found no room on the line: a faster one, a larger --max-turn-error, or a clip with fewer frames a second"
        );
    }
}
