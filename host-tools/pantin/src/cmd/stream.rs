//! `pantin stream`: clips over a line, while they play.

use super::channel_bound::degrees;
use crate::board_clip::as_segments;
use crate::cmd::{Files, rig_is_needed};
use crate::memory;
use crate::output::{note, report};
use anyhow::{Context, Result, bail};
use pantin::Clip;
use pantin_convert::input;
use pantin_line::sender::{ByteCounts, LineSettings, Sender, Source};
use pantin_line::stream::{address::Address, pace};
use pantin_link::packet::TagKey;
use serde_json::json;
use std::hash::{BuildHasher, Hasher, RandomState};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Most bytes of a file that holds a key: comments have no place in it.
const KEY_BYTES: u64 = 256;
/// Longest cycle and look-ahead. The limits in frames are usually shorter.
const MOST_SECONDS: f64 = 60.0;

/// Send clips over a line while they play, each frame a little ahead of its time.
///
/// The receiver must have the clips' rig already, for example in a built-in clip: the reference board with the feature `link`, started with the
/// argument `link` (firmware/link/LINK.md 9). A receiver may join at any time, and is exact again
/// one cycle after any loss; `--cycle` and `--refresh` limit how short a cycle may be.
#[derive(clap::Args)]
pub struct Arguments {
    /// Clips, sent one after the other; with --live, a clip of the face or the figure that the receiver has
    #[arg(required = true)]
    pub(super) clips: Vec<PathBuf>,
    /// The line: serial:DEVICE, tcp:HOST:PORT or udp:HOST:PORT, followed by @BAUD if it is not 38400 (10 bits per byte, for all of them)
    #[arg(long, value_name = "LINE")]
    pub(super) to: Address,
    /// Send motion while it is captured. A face: udp:PORT receives datagrams of Live Link Face, - reads lines of its CSV from stdin, one per frame of the
    /// clip. A body: vmc:PORT receives VMC over OSC from a VRM program (usually port 39539), bvh:- reads BVH from stdin, a row per frame of the clip
    #[arg(long, value_name = "FROM", conflicts_with_all = ["looped", "refresh", "cycle", "ahead"])]
    live: Option<String>,
    /// Largest error of --live for channels that move no joint, in percent of full scale
    #[arg(long, value_name = "PERCENT", default_value_t = 2.0, requires = "live")]
    pub(super) max_scalar_error: f64,
    /// Largest error of a body's angles with --live, in degrees. Places of joints keep half a centimetre
    #[arg(long, value_name = "DEGREES", default_value_t = 1.0, requires = "live", value_parser = degrees)]
    pub(super) max_turn_error: f64,
    /// The rig of clips without one (`pantin convert --rig-out`)
    #[arg(long)]
    pub(super) rig: Option<PathBuf>,
    /// Send the clips again and again
    #[arg(long = "loop")]
    looped: bool,
    /// Share of the line that refreshes may take, in percent: more than 0
    #[arg(long, value_name = "PERCENT", default_value_t = 100.0)]
    refresh: f64,
    /// Shortest cycle in which every channel is refreshed, in seconds: more than 0, at most 60 and 120 frames; longer if the line is too slow
    #[arg(long, value_name = "SECONDS", default_value_t = 0.2, value_parser = seconds)]
    cycle: f64,
    /// Largest look-ahead, in seconds: more than 0, at most 60 and 250 frames. The figure starts later by it, and at most 24 packets wait at the receiver
    #[arg(long, value_name = "SECONDS", default_value_t = 1.5, value_parser = seconds)]
    ahead: f64,
    /// Add 8 bytes of parity to each packet, which correct 4 wrong bytes; the receiver must expect them (the board's argument `fec`)
    #[arg(long)]
    pub(super) fec: bool,
    /// Add a tag of 8 bytes to each packet, in place of its CRC of 2: the receiver, which must have the key, drops all other packets. KEY is a file with
    /// 32 hexadecimal digits, or these digits
    #[arg(long, value_name = "KEY")]
    key: Option<String>,
}

/// A time that the sender plans with.
fn seconds(text: &str) -> Result<f64, String> {
    let seconds = text.trim().parse::<f64>().ok().filter(|&seconds| seconds > 0.0 && seconds <= MOST_SECONDS);
    seconds.ok_or_else(|| format!("expected seconds, more than 0 and at most {MOST_SECONDS}"))
}

impl Arguments {
    /// The key of the packets' tags.
    pub(super) fn tag_key(&self) -> Result<Option<TagKey>> {
        let Some(key) = &self.key else { return Ok(None) };
        if let Some(key) = TagKey::from_hex(key) {
            return Ok(Some(key));
        }
        // An error does not print the key.
        let text = input::read_short_text(Path::new(key), KEY_BYTES)
            .context("--key: neither 32 hexadecimal digits nor a file with them")?;
        let key =
            TagKey::from_hex(text.trim()).with_context(|| format!("--key {key}: expected 32 hexadecimal digits in the file"))?;
        Ok(Some(key))
    }
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    if !(arguments.refresh > 0.0 && arguments.refresh <= 100.0) {
        bail!("--refresh {}: expected more than 0, and at most 100 percent", arguments.refresh);
    }
    if let Some(from) = &arguments.live {
        let stop = stopped_by_signal()?;
        return super::stream_live::run(arguments, from, &stop);
    }
    let files = arguments.clips.iter().map(|path| Files::read(path, arguments.rig.as_deref())).collect::<Result<Vec<_>>>()?;
    let clips = files.iter().zip(&arguments.clips).map(|(files, path)| files.open().with_context(|| path.display().to_string()));
    let clips = clips.collect::<Result<Vec<_>>>()?;
    rig_is_needed(arguments.rig.as_deref(), &clips)?;
    let sources =
        clips.iter().zip(&files).map(|(clip, files)| source(clip, &files.path, &files.rig)).collect::<Result<Vec<_>>>()?;
    let lines =
        sources.iter().zip(&arguments.clips).map(|(source, path)| fitted(arguments, source, path)).collect::<Result<Vec<_>>>()?;
    let mut line = arguments.to.open()?;
    let stop = stopped_by_signal()?;
    let mut sender = sender();
    let (mut bytes, mut seconds) = (ByteCounts::default(), 0.0);
    let one = sources.len() == 1;
    while !stop.load(Ordering::Relaxed) {
        for ((source, fit), path) in sources.iter().zip(&lines).zip(&arguments.clips) {
            let rounds = if arguments.looped && one { None } else { Some(1) };
            let mut schedule = sender.clip(source, *fit, rounds);
            let start = Instant::now();
            note!("{}", opening(source, fit, path));
            let delay = pace::send(&mut line, &mut schedule, &stop).with_context(|| path.display().to_string())?;
            let length = source.seconds();
            // What was sent ahead is still to be shown.
            let end = start + delay + Duration::from_secs_f64(length + f64::from(fit.ahead) * source.frame_seconds());
            if rounds.is_some() && !pace::wait(end, &stop) {
                break;
            }
            sender.end_clip(&schedule);
            bytes = bytes + schedule.bytes();
            seconds += start.elapsed().as_secs_f64();
        }
        if !arguments.looped {
            break;
        }
    }
    note!("{}", closing(bytes, seconds));
    Ok(())
}

/// A session of its own: no clock or process number is as unlikely to come again.
pub(super) fn sender() -> Sender {
    Sender::new(RandomState::new().build_hasher().finish() as u16)
}

fn source(clip: &Clip, path: &Path, rig: &[u8]) -> Result<Source> {
    // The sender keeps the state of every channel at every frame.
    memory::limit().check(clip.frames() as usize, clip.rig().channels()).with_context(|| path.display().to_string())?;
    let segments;
    let mut clip = *clip;
    if clip.has_keys() {
        segments = as_segments(path, &clip)?;
        clip = if clip.rig_len() == 0 { Clip::with_rig(&segments, rig)? } else { Clip::new_checked(&segments)? };
    }
    Source::new(&clip).with_context(|| path.display().to_string())
}

fn fitted(arguments: &Arguments, source: &Source, path: &Path) -> Result<LineSettings> {
    let frames = |seconds: f64| (seconds / source.frame_seconds()).round();
    let wanted = LineSettings {
        rate: arguments.to.rate(),
        ahead: frames(arguments.ahead).clamp(4.0, 250.0) as u32,
        share: arguments.refresh / 100.0,
        cycle: frames(arguments.cycle).clamp(1.0, 120.0) as u32,
        parity: arguments.fec,
        key: arguments.tag_key()?,
    };
    wanted.fitted(source).with_context(|| {
        if (LineSettings { share: 1.0, ..wanted }).fitted(source).is_some() {
            let share = arguments.refresh;
            return format!("{}: refreshes take more than {share} % of the line; a larger --refresh, or a faster line", path.display());
        }
        format!(
            "{}: too much for {:.0} bytes a second; a faster line, a larger --max-error or --fps 30 when it is converted, or a larger --ahead may do",
            path.display(),
            wanted.rate
        )
    })
}

fn opening(source: &Source, fit: &LineSettings, path: &Path) -> String {
    let (off, _) = source.deviation(fit.cycle);
    let milliseconds = |frames: u32| 1000.0 * f64::from(frames) * source.frame_seconds();
    format!(
        "{}: {} frames, {} channels; all of them refreshed within {:.0} ms; sent up to {:.0} ms ahead; at most {off:.2} of a channel's step from the clip",
        path.display(),
        source.frames(),
        source.moving_channels(),
        milliseconds(fit.cycle),
        milliseconds(fit.ahead)
    )
}

/// What was sent, for the report and as a sentence.
pub(super) fn closing(bytes: ByteCounts, seconds: f64) -> String {
    report(json!({
        "packets": bytes.packets,
        "line_bytes": bytes.line,
        "motion_bytes": bytes.motion,
        "refresh_bytes": bytes.refresh,
        "seconds": seconds,
    }));
    let part = |part: f64| 100.0 * part / bytes.line.max(1.0);
    format!(
        "{} packets, {:.0} bytes in {seconds:.1} s: motion {:.1} %, refresh {:.1} %, heads and starts {:.1} %, framing and CRC {:.1} %, parity {:.1} %",
        bytes.packets,
        bytes.line,
        part(bytes.motion),
        part(bytes.refresh),
        part(bytes.announced),
        part(bytes.framing),
        part(bytes.parity)
    )
}

/// Set by the signals that end a program, so that what was sent is still reported.
fn stopped_by_signal() -> Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    #[cfg(unix)]
    for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
        signal_hook::flag::register(signal, stop.clone())?;
    }
    Ok(stop)
}
