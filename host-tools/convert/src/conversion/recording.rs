//! Clips of a motion that is still being captured: [`Recording`].
//!
//! **Why several clips.** A clip of version 1 cannot be begun before its last frame is known. Its symbols are one rANS stream, and an rANS encoder
//! works from the last symbol to the first: the first byte depends on the last frame. The number of frames and the length of the motion stand in
//! the head, and the CRC of the first block covers the length. No byte can be written early and patched later, because the coder's state runs
//! through all of them. (A stream that sends each segment by itself is the link's, `firmware/link/LINK.md`.)
//!
//! So a recording is a chain of whole clips. A clip holds at most as many frames as the delay has, and the next one begins with the frame behind its last one.
//! Played one after the other, the clips show every frame of the source once, within the bound. The device's own decoder verifies each clip before it is
//! handed out, as [`convert`](super::convert) does.
//!
//! **What is settled once.** All clips have one rig, one unit, one direction that is up, and one bound in cm: a percentage of the figure's height and the default
//! shell are computed from the first clip's frames. They also have one form, so that one figure renderer plays them all: which joints are exponential maps is
//! what is cheapest for the first clip, and positions are multiples of a 65536th of the bound, which reaches 16384 times as far as the bound is wide: 82 m at 0.5 cm. Where a
//! later frame does not fit in the form (a joint beyond half a turn, a figure that walks farther), the form changes from that clip on, with a note.
//!
//! **Delay.** Frame k of a clip of n frames waits for n - 1 - k frames. A shorter delay costs bytes, because each clip has the start of each channel again.
//! The time that the encoder takes is added to it; frames that arrive meanwhile must wait outside.
//!
//! **Memory** is that of two clips' rows and one clip's fit, however long the stream is.

use super::distance::Distance;
use super::prepared::{Prepared, prepare, shared_coding};
use super::report::Report;
use crate::error::{Error, Setting};
use crate::fit::rotation_coding::Coding;
use crate::import::{BvhStream, ImportOptions, units, unwrap_angles, up};
use crate::length::Length;
use crate::motion::{Motion, Rig};
use crate::note::{Note, NoteKind};
use crate::number::Number;
use crate::options::{Options, UseKeys};
use anyhow::Result;
use pantin::codec::layout::MAX_FRAMES;
use std::path::{Path, PathBuf};

/// Positions have at least this many steps in the bound.
const STEPS_OF_BOUND: f64 = 65536.0;
/// The longest delay, in seconds.
const MOST_DELAY: f64 = 3600.0;

/// A motion that is still being captured, on its way to clips.
///
/// ```
/// use pantin_convert::import::ImportOptions;
/// use pantin_convert::{Options, Recording};
///
/// let head = "HIERARCHY ROOT hips { OFFSET 0 0 0 CHANNELS 3 Xrotation Yrotation Zrotation End Site { OFFSET 0 100 0 } } \
///             MOTION Frames: 0 Frame Time: 0.04\n";
/// let mut recording = Recording::new("-".as_ref(), &ImportOptions::new(), &Options::new(), 0.5)?;
/// recording.push(head.as_bytes())?;
/// let mut frames = 0;
/// for frame in 0..30 {
///     recording.push(format!("{frame} 0 0\n").as_bytes())?;
///     while let Some(clip) = recording.next_clip()? {
///         frames += clip.frames;
///     }
/// }
/// recording.end()?;
/// frames += recording.rest()?.map_or(0, |clip| clip.frames);
/// assert_eq!(frames, 30);
/// # Ok::<(), pantin_convert::Error>(())
/// ```
#[derive(Debug)]
pub struct Recording {
    name: PathBuf,
    stream: BvhStream,
    import: ImportOptions,
    options: Options,
    delay_seconds: f64,
    settled: Option<Settled>,
    /// Frames of the clips that were handed out.
    frames: u64,
}

/// What all clips share.
#[derive(Debug)]
struct Settled {
    rig: Rig,
    /// With lengths in cm.
    options: Options,
    coding: Coding,
    rig_bytes: Vec<u8>,
}

/// A clip of a recording, verified.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RecordedClip {
    /// The stream's frame with which it begins, from 0.
    pub first_frame: u64,
    /// Number of frames.
    pub frames: usize,
    /// Its bytes, without the rig: [`Recording::rig`] has it.
    pub clip: Vec<u8>,
    /// How far it is from the source.
    pub report: Report,
    /// Notes: with the first clip those about the figure and the unit, later those about a changed form.
    pub notes: Vec<Note>,
}

impl Recording {
    /// A BVH stream from which nothing has come; `name` begins its errors. A frame is in a clip before `delay_seconds` of later frames have come: 1 frame to
    /// 3600 seconds. Fails for options that need all frames: bounds of channels, loops, footsteps and keys.
    pub fn new(name: &Path, import: &ImportOptions, options: &Options, delay_seconds: f64) -> Result<Recording, Error> {
        options.check()?;
        let refused = [
            (Setting::MaxChannelError, options.channels.is_some()),
            (Setting::Loop, options.looped),
            (Setting::Footsteps, options.footsteps),
            (Setting::Keys, options.keys == UseKeys::Always),
            (Setting::FrameRate, import.fps.is_some()),
        ];
        if let Some((setting, _)) = refused.into_iter().find(|(_, given)| *given) {
            return Err(Error::setting(setting, "it needs all frames, and a stream's last ones are still to come"));
        }
        if !(delay_seconds > 0.0 && delay_seconds <= MOST_DELAY) {
            return Err(Error::source(format!(
                "a delay of {} s; expected more than 0 and at most {MOST_DELAY} s",
                Number(delay_seconds)
            )));
        }
        let options = Options { rig_apart: true, keys: UseKeys::Never, ..options.clone() };
        let (name, stream) = (name.to_path_buf(), BvhStream::new(name));
        Ok(Recording { name, stream, import: import.clone(), options, delay_seconds, settled: None, frames: 0 })
    }

    /// Takes the next bytes of the stream, cut anywhere. Call [`next_clip`](Recording::next_clip) until it has none before the next bytes. After an error no
    /// more bytes can be pushed; the frames before it are still handed out, by `next_clip` and [`rest`](Recording::rest).
    pub fn push(&mut self, bytes: &[u8]) -> Result<(), Error> {
        self.stream.push(bytes)
    }

    /// Takes the end of the stream. Fails if it ends within a row or the header, or before as many frames as its header states; as after every error,
    /// the frames before it are still handed out.
    pub fn end(&mut self) -> Result<(), Error> {
        self.stream.end()
    }

    /// Frames of every clip but the last; `None` before the header has come.
    pub fn clip_frames(&self) -> Option<usize> {
        let frame_time = self.stream.head()?.frame_time;
        // A delay that is a multiple of the frame's time but for rounding is that multiple.
        let frames = (self.delay_seconds / frame_time + 1e-6).floor();
        Some(frames.clamp(1.0, f64::from(MAX_FRAMES)) as usize)
    }

    /// The next clip, if all of its frames have come.
    pub fn next_clip(&mut self) -> Result<Option<RecordedClip>, Error> {
        match self.clip_frames() {
            Some(frames) if self.stream.ready() >= frames => self.clip(frames).map(Some),
            _ => Ok(None),
        }
    }

    /// The clip of the frames that are left, if there are any, once there is no [next clip](Recording::next_clip).
    pub fn rest(&mut self) -> Result<Option<RecordedClip>, Error> {
        match self.stream.ready() {
            0 => Ok(None),
            frames => self.clip(frames).map(Some),
        }
    }

    /// The bytes of the rig that all clips share; empty before the first clip.
    pub fn rig(&self) -> &[u8] {
        self.settled.as_ref().map_or(&[], |settled| &settled.rig_bytes)
    }

    fn clip(&mut self, frames: usize) -> Result<RecordedClip, Error> {
        let last = self.frames + frames as u64 - 1;
        let place = format!("{}: frames {} to {last}", self.name.display(), self.frames);
        let coded = self.coded(frames).map_err(|error| Error::of(&error, Error::source).in_file(Path::new(&place)));
        self.frames += frames as u64;
        coded
    }

    fn coded(&mut self, frames: usize) -> Result<RecordedClip> {
        let values = self.stream.take(frames);
        let Some(head) = self.stream.head() else { return Err(Error::source("no header").into()) };
        let mut motion = Motion::sampled(head.rig.clone(), head.frame_time, frames, values);
        unwrap_angles(&mut motion);
        let (mut notes, prepared) = match &self.settled {
            Some(settled) => {
                motion.rig.clone_from(&settled.rig);
                (Vec::new(), prepare(motion, &settled.options)?)
            }
            None => self.settle(motion, head.notes.clone())?,
        };
        let Some(settled) = &mut self.settled else { return Err(Error::source("no frames").into()) };
        let coding = settled.coding.widened_for(&prepared.motion);
        if coding != settled.coding {
            notes.push(form_note(&settled.coding, &coding));
            settled.coding = coding;
        }
        let made = prepared.code(&settled.coding, &mut |_| ())?;
        Ok(RecordedClip { first_frame: self.frames, frames, clip: made.clip, report: made.report, notes })
    }

    /// Settles what all clips share, by the frames of the first one.
    fn settle(&mut self, mut motion: Motion, mut notes: Vec<Note>) -> Result<(Vec<Note>, Prepared)> {
        let (unit, note) = units::settle(&motion, self.import.cm_per_unit, None)?;
        notes.push(note);
        motion.rig.cm_per_unit = unit;
        motion.rig.up = self.import.up.unwrap_or_else(|| up::guess(&motion));
        let rig = motion.rig.clone();
        let mut options = self.options.clone();
        let Distance { pose, .. } = Distance::of(&options, &motion)?;
        options.max_error = Some(Length::Cm(pose.max_cm));
        options.mean_error = pose.mean_cm.map(Length::Cm);
        options.shell = pose.shell_cm().map(Length::Cm);
        let mut prepared = prepare(motion, &options)?;
        notes.append(&mut prepared.notes);
        let mut coding = shared_coding(std::slice::from_ref(&prepared));
        coding.length_exponent = coding.length_exponent.max(finest_exponent(pose.max_cm / unit));
        let rig_bytes = prepared.rig.clone();
        self.settled = Some(Settled { rig, options, coding, rig_bytes });
        Ok((notes, prepared))
    }
}

/// The exponent of positions that are as fine as a bound, in the source's units, needs.
fn finest_exponent(bound: f64) -> i8 {
    (bound / STEPS_OF_BOUND).log2().floor().clamp(-63.0, 31.0) as i8
}

fn form_note(before: &Coding, now: &Coding) -> Note {
    let text = match before.exponential_joints() - now.exponential_joints() {
        0 => "form: the figure is so far from its origin that positions have coarser steps from here on".to_owned(),
        joints => format!("form: {joints} joints turn so far that they are coded as Euler angles from here on"),
    };
    Note::info(NoteKind::Joints, text)
}
