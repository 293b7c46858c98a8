//! All edits of a motion, as settings.

use super::in_place::InPlace;
use super::pace::Pace;
use crate::memory::Memory;
use crate::moment::Moment;
use crate::motion::Motion;
use crate::note::Note;
use std::path::PathBuf;

/// A body that motions can be put on.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Body {
    /// 15 joints: hips, chest, head, and upper arm, forearm, hand, thigh, shin, foot of both sides, in the motion's own proportions.
    Display,
    /// The figure of another file: any motion that can be read, a clip, or the first clip of a bank. Motions on one body can be in one bank.
    Of(PathBuf),
}

/// Changes of a motion between import and conversion. They apply in the order of the fields. The default changes nothing.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Edits {
    /// Frames a second that the source's frames have, whatever the source states: all frames stay, and the motion gets slower or faster.
    pub rate: Option<f64>,
    /// How many times faster the motion goes; all frames stay.
    pub speed: Option<f64>,
    /// Frames a second of the result: the motion is resampled.
    pub fps: Option<f64>,
    /// Event markers to add, by name and moment. Frames count after `fps` and before `from`.
    pub events: Vec<(String, Moment)>,
    /// The first frame to keep, counted after `fps`.
    pub from: Option<Moment>,
    /// The last frame to keep.
    pub to: Option<Moment>,
    /// Names of the two events to keep what is between: the first event of the one, and the next one of the other after it.
    pub between: Option<(String, String)>,
    /// Globs of joints and scalars to keep, in any case of letters; all if there is none.
    pub joints: Vec<String>,
    /// Globs of joints and scalars to drop.
    pub drop: Vec<String>,
    /// Other names for joints and scalars: pairs of the old and the new one, in which one `*` stands for the same letters.
    pub rename: Vec<(String, String)>,
    /// Whether left and right are exchanged.
    pub mirror: bool,
    /// The body that the motion is put on.
    pub retarget: Option<Body>,
    /// A file with the names of joints that `retarget` does not recognize.
    pub map: Option<PathBuf>,
    /// Whether the motion is played backwards.
    pub reverse: bool,
    /// How many times larger the figure becomes, with its way.
    pub scale: Option<f64>,
    /// The frequency in Hz above which motion is smoothed away: it keeps 0.707 of its size there, a quarter at twice as much.
    pub smooth: Option<f64>,
    /// What is taken out of a motion that goes somewhere.
    pub in_place: Option<InPlace>,
    /// Degrees by which the whole motion is turned about the vertical, to the figure's left.
    pub turn: Option<f64>,
    /// The way that a figure gets which treads on the spot.
    pub pace: Option<Pace>,
    /// Other motions that follow, one after the other.
    pub append: Vec<PathBuf>,
    /// Seconds in which a motion goes over to the next of `append`; 0.25 by default.
    pub blend: Option<f64>,
    /// Another file whose scalars are added, such as a face recorded with the body.
    pub with: Option<PathBuf>,
    /// Whether the motion is one cycle, whose first frame follows its last.
    pub close_loop: bool,
    /// The memory that the edits may take; 1 GiB by default.
    pub memory: Memory,
}

/// A motion after its edits.
#[derive(Clone, Debug)]
pub struct Edited {
    /// The motion.
    pub motion: Motion,
    /// What the edits did.
    pub notes: Vec<Note>,
}

impl Edits {
    /// Nothing is changed.
    pub fn new() -> Edits {
        Edits::default()
    }

    /// States the rate of the source's frames.
    pub fn rate(self, fps: impl Into<Option<f64>>) -> Edits {
        Edits { rate: fps.into(), ..self }
    }

    /// Makes the motion `speed` times faster.
    pub fn speed(self, speed: impl Into<Option<f64>>) -> Edits {
        Edits { speed: speed.into(), ..self }
    }

    /// Resamples to `fps` frames a second.
    pub fn fps(self, fps: impl Into<Option<f64>>) -> Edits {
        Edits { fps: fps.into(), ..self }
    }

    /// Adds an event marker.
    pub fn event(mut self, name: impl Into<String>, moment: Moment) -> Edits {
        self.events.push((name.into(), moment));
        self
    }

    /// Keeps the frames from `from` on.
    pub fn from(self, from: impl Into<Option<Moment>>) -> Edits {
        Edits { from: from.into(), ..self }
    }

    /// Keeps the frames up to `to`, this one included.
    pub fn to(self, to: impl Into<Option<Moment>>) -> Edits {
        Edits { to: to.into(), ..self }
    }

    /// Keeps what is between two events.
    pub fn between(self, first: impl Into<String>, last: impl Into<String>) -> Edits {
        Edits { between: Some((first.into(), last.into())), ..self }
    }

    /// Keeps only joints and scalars whose names match the glob, or another one that is given.
    pub fn joints(mut self, glob: impl Into<String>) -> Edits {
        self.joints.push(glob.into());
        self
    }

    /// Drops joints and scalars whose names match the glob.
    pub fn drop(mut self, glob: impl Into<String>) -> Edits {
        self.drop.push(glob.into());
        self
    }

    /// Gives joints and scalars another name.
    pub fn rename(mut self, old: impl Into<String>, new: impl Into<String>) -> Edits {
        self.rename.push((old.into(), new.into()));
        self
    }

    /// Exchanges left and right.
    pub fn mirror(self, mirror: bool) -> Edits {
        Edits { mirror, ..self }
    }

    /// Puts the motion on a body.
    pub fn retarget(self, body: impl Into<Option<Body>>) -> Edits {
        Edits { retarget: body.into(), ..self }
    }

    /// Names joints for [`Edits::retarget`].
    pub fn map(self, file: impl Into<PathBuf>) -> Edits {
        Edits { map: Some(file.into()), ..self }
    }

    /// Plays the motion backwards.
    pub fn reverse(self, reverse: bool) -> Edits {
        Edits { reverse, ..self }
    }

    /// Makes the figure `factor` times as large.
    pub fn scale(self, factor: impl Into<Option<f64>>) -> Edits {
        Edits { scale: factor.into(), ..self }
    }

    /// Smooths away what is faster than a frequency in Hz.
    pub fn smooth(self, hertz: impl Into<Option<f64>>) -> Edits {
        Edits { smooth: hertz.into(), ..self }
    }

    /// Takes the way out.
    pub fn in_place(self, what: impl Into<Option<InPlace>>) -> Edits {
        Edits { in_place: what.into(), ..self }
    }

    /// Turns the whole motion about the vertical by degrees, to the figure's left.
    pub fn turn(self, degrees: impl Into<Option<f64>>) -> Edits {
        Edits { turn: degrees.into(), ..self }
    }

    /// Lets a figure that treads on the spot go somewhere.
    pub fn pace(self, pace: impl Into<Option<Pace>>) -> Edits {
        Edits { pace: pace.into(), ..self }
    }

    /// Adds another motion to the end.
    pub fn append(mut self, file: impl Into<PathBuf>) -> Edits {
        self.append.push(file.into());
        self
    }

    /// Goes over to appended motions in this many seconds.
    pub fn blend(self, seconds: impl Into<Option<f64>>) -> Edits {
        Edits { blend: seconds.into(), ..self }
    }

    /// Adds the scalars of another file.
    pub fn with(self, file: impl Into<PathBuf>) -> Edits {
        Edits { with: Some(file.into()), ..self }
    }

    /// Takes the motion as one cycle.
    pub fn close_loop(self, close_loop: bool) -> Edits {
        Edits { close_loop, ..self }
    }

    /// Limits the memory.
    pub fn memory(self, memory: Memory) -> Edits {
        Edits { memory, ..self }
    }
}
