//! `pantin convert - --stream`: clips of a motion while it is captured.

use super::convert::Arguments;
use super::edits::Edits;
use crate::output::{self, note};
use crate::words;
use anyhow::{Context, Result, ensure};
use pantin_convert::input::is_stdin;
use pantin_convert::{Errors, RecordedClip, Recording};
use serde_json::json;
use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::thread;
use std::time::Duration;

/// Bytes that are read at a time, and how often as many wait while a clip is encoded: then the writer has to wait.
const CHUNK_BYTES: usize = 1 << 14;
const CHUNKS_AHEAD: usize = 64;
/// How often a wait for bytes looks whether it was stopped.
const STOP_CHECK: Duration = Duration::from_millis(50);
/// The file of the clips' rig in their folder.
const RIG: &str = "figure.rig";

/// Records until the stream ends, is damaged or the program is interrupted. The frames until then are in clips in every case.
pub fn run(arguments: &Arguments) -> Result<()> {
    ensure!(
        arguments.edits == Edits::default(),
        "--stream: frames are converted as they come, so it takes none of the changes of the motion"
    );
    let folder = arguments.output();
    ensure!(folder.as_os_str() != "-", "-o -: a recording has several clips, and standard output takes one; name a folder");
    ensure!(!folder.is_file(), "{}: a file; the clips of a recording need a folder", folder.display());
    let is_empty = !folder.is_dir() || folder.read_dir().with_context(|| folder.display().to_string())?.next().is_none();
    ensure!(is_empty, "{}: is not empty; a recording needs a folder of its own", folder.display());
    let recipe = arguments.recipe();
    let mut recording = Recording::new(&arguments.input, &recipe.import, &recipe.options, arguments.delay)?;
    let stop = output::end_on_signals()?;
    let chunks = read_chunks(&arguments.input)?;
    output::make_folder(folder)?;
    let mut written = Written::new(folder);
    let recorded = record(&mut recording, &chunks, &stop, &mut written);
    written.say();
    recorded
}

/// Writes each clip as soon as its frames have come.
fn record(
    recording: &mut Recording,
    chunks: &Receiver<io::Result<Vec<u8>>>,
    stop: &AtomicBool,
    written: &mut Written,
) -> Result<()> {
    let mut read = Ok(());
    while let Some(chunk) = next_chunk(chunks, stop) {
        read = match chunk {
            Ok(chunk) => recording.push(&chunk).map_err(Into::into),
            Err(error) => Err(error).context("the stream cannot be read"),
        };
        written.put_all(recording)?;
        if read.is_err() {
            break;
        }
    }
    if read.is_ok() && !stop.load(Ordering::Relaxed) {
        read = recording.end().map_err(Into::into);
        written.put_all(recording)?;
    }
    if let Some(clip) = recording.rest()? {
        written.put(recording, &clip)?;
    }
    read
}

/// Reads in a thread of its own: a read that waits cannot be stopped. The thread ends with the program.
pub(super) fn read_chunks(path: &Path) -> Result<Receiver<io::Result<Vec<u8>>>> {
    let mut source: Box<dyn Read + Send> = match is_stdin(path) {
        true => Box::new(io::stdin()),
        false => Box::new(File::open(path).with_context(|| path.display().to_string())?),
    };
    let (sender, chunks) = sync_channel(CHUNKS_AHEAD);
    thread::spawn(move || {
        let mut room = vec![0; CHUNK_BYTES];
        loop {
            let chunk = match source.read(&mut room) {
                Ok(0) => break,
                Ok(len) => Ok(room[..len].to_vec()),
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                Err(error) => Err(error),
            };
            let failed = chunk.is_err();
            if sender.send(chunk).is_err() || failed {
                break;
            }
        }
    });
    Ok(chunks)
}

/// The next bytes; `None` at the end, and where `stop` is set.
pub(super) fn next_chunk(chunks: &Receiver<io::Result<Vec<u8>>>, stop: &AtomicBool) -> Option<io::Result<Vec<u8>>> {
    while !stop.load(Ordering::Relaxed) {
        match chunks.recv_timeout(STOP_CHECK) {
            Ok(chunk) => return Some(chunk),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break,
        }
    }
    None
}

/// The clips that were written.
struct Written {
    folder: PathBuf,
    clips: u64,
    frames: u64,
    bytes: u64,
    clip_frames: usize,
    frame_seconds: f64,
    /// The greatest errors: of the shell and of places in cm, of rotations in degrees.
    errors: [f64; 3],
}

impl Written {
    fn new(folder: &Path) -> Written {
        Written { folder: folder.into(), clips: 0, frames: 0, bytes: 0, clip_frames: 0, frame_seconds: 0.0, errors: [0.0; 3] }
    }

    /// Writes the clips whose frames have come.
    fn put_all(&mut self, recording: &mut Recording) -> Result<()> {
        while let Some(clip) = recording.next_clip()? {
            self.put(recording, &clip)?;
        }
        Ok(())
    }

    /// Writes a clip, the first one together with the rig.
    fn put(&mut self, recording: &Recording, clip: &RecordedClip) -> Result<()> {
        clip.notes.iter().for_each(|note| note!("{}", words::line(note)));
        // Eight digits keep the order of names for 9 days at 120 frames a second.
        let path = self.folder.join(format!("{:08}.ptn", clip.first_frame));
        let rig = self.folder.join(RIG);
        let clip_file = (path.as_path(), clip.clip.as_slice());
        match self.clips {
            0 => output::write_together(&[(&rig, recording.rig()), clip_file])?,
            _ => output::write_together(&[clip_file])?,
        }
        self.clips += 1;
        self.frames += clip.frames as u64;
        self.bytes += clip.clip.len() as u64;
        self.clip_frames = recording.clip_frames().unwrap_or(0);
        self.frame_seconds = f64::from(clip.report.frame_time_ns) * 1e-9;
        if let Errors::Joints(report) = &clip.report.errors {
            let errors = [report.shell_cm.error, report.place_cm.error, report.rotation_deg.error];
            self.errors.iter_mut().zip(errors).for_each(|(most, error)| *most = most.max(error));
        }
        Ok(())
    }

    /// Reports what was written.
    fn say(&self) {
        let Written { clips, frames, bytes, clip_frames, errors: [shell, place, rotation], .. } = *self;
        output::report(json!({
            "clips_in_recording": clips,
            "frames": frames,
            "bytes": bytes,
            "delay_frames": clip_frames.saturating_sub(1),
            "shell_max_cm": shell,
            "max_cm": place,
            "max_rotation_deg": rotation,
        }));
        let folder = self.folder.display();
        if clips == 0 {
            return note!("{folder}: nothing was written");
        }
        let seconds = frames as f64 * self.frame_seconds;
        note!(
            "{folder}: {clips} clips and {RIG}; frames 0 to {}, {seconds:.1} s; {bytes} bytes; a frame waited for at most {} others; error max {place:.4} cm, shell error max {shell:.4} cm, rotation error max {rotation:.3} degrees",
            frames - 1,
            clip_frames.saturating_sub(1)
        );
    }
}
