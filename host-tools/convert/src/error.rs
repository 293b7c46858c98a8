//! Why a motion could not be read, changed or converted: one variant for each thing that a caller can act on.
//!
//! Inside this crate errors travel as [`anyhow::Error`], with an [`Error`] as their cause where a caller can do more than show the text;
//! [`Error::of`] makes one of them at the crate's surface.

use crate::note::Remedy;
use std::fmt;

/// A failed conversion.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// A file cannot be read.
    Read(Problem),
    /// The source is damaged, of an unknown format, or has what a clip cannot hold.
    Source(Problem),
    /// A setting is out of range, or does not fit the motion.
    Setting(Setting, Problem),
    /// The motion takes more memory than the limit.
    Memory(Problem),
    /// No clip within the bound was found.
    Bound(Problem),
}

/// What is wrong, and where.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Problem {
    /// The file, line, joint or frame, as in `walk.bvh:12`; empty if none is known.
    pub place: String,
    /// The value of the setting that is refused, as the user gave it; empty if the text says all.
    pub value: String,
    /// The reason in English, without a full stop.
    pub text: String,
    /// What would help.
    pub remedy: Option<Remedy>,
}

/// A setting of a conversion. Each front end has its own name for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Setting {
    /// The frame rate of the clip.
    FrameRate,
    /// The rate that the source's frames have.
    SourceRate,
    /// The length of the source's unit.
    Unit,
    /// The direction that is vertical.
    Up,
    /// The animation of a file with several.
    Animation,
    /// The skeleton of a motion without one.
    Skeleton,
    /// The first frame.
    From,
    /// The last frame.
    To,
    /// The joints to keep.
    Joints,
    /// The joints to drop.
    Drop,
    /// Exchange left and right.
    Mirror,
    /// Put the motion on another body.
    Retarget,
    /// The figure of another file, on which the motion is put.
    Body,
    /// The names of joints for another body.
    Map,
    /// Scalars of another file.
    With,
    /// The factor of the speed.
    Speed,
    /// The stretch between two events.
    Between,
    /// Other names of joints.
    Rename,
    /// Play backwards.
    Reverse,
    /// The factor of the size.
    Scale,
    /// The frequency above which motion is smoothed away.
    Smooth,
    /// Take the way out.
    InPlace,
    /// Turn about the vertical.
    Turn,
    /// A way for a figure that treads on the spot.
    Pace,
    /// Motions that follow.
    Append,
    /// The time from one motion to the next.
    Blend,
    /// An event marker.
    Event,
    /// Events of footsteps.
    Footsteps,
    /// Close the seam of a loop.
    Loop,
    /// Take the motion as one cycle.
    CloseLoop,
    /// Propose loops.
    FindLoop,
    /// The bound of joints.
    MaxError,
    /// The mean error of joints.
    MeanError,
    /// The bound of scalars.
    MaxScalarError,
    /// The bound of rotations in the world.
    MaxRotationError,
    /// The bound of rotations against the parent.
    MaxJointError,
    /// The distance of the shell's points.
    Shell,
    /// Bound places alone.
    PlacesOnly,
    /// The bound of channels.
    MaxChannelError,
    /// The bound of accelerations.
    MaxAccelError,
    /// Exact coding.
    Exact,
    /// Keys instead of segments.
    Keys,
    /// How rotations are coded.
    Rotations,
    /// The encoder's effort.
    Effort,
    /// The spacing of snapshots.
    Index,
}

impl Setting {
    /// The setting in plain words, for a program without names of its own: `frame rate`.
    pub fn text(self) -> &'static str {
        match self {
            Setting::FrameRate => "frame rate",
            Setting::SourceRate => "source rate",
            Setting::Unit => "unit",
            Setting::Up => "up",
            Setting::Animation => "animation",
            Setting::Skeleton => "skeleton",
            Setting::From => "first frame",
            Setting::To => "last frame",
            Setting::Joints => "joints to keep",
            Setting::Drop => "joints to drop",
            Setting::Mirror => "mirror",
            Setting::Retarget => "retarget",
            Setting::Body => "body",
            Setting::Map => "joint map",
            Setting::With => "other file",
            Setting::Speed => "speed",
            Setting::Between => "between",
            Setting::Rename => "rename",
            Setting::Reverse => "reverse",
            Setting::Scale => "scale",
            Setting::Smooth => "smooth",
            Setting::InPlace => "in place",
            Setting::Turn => "turn",
            Setting::Pace => "pace",
            Setting::Append => "append",
            Setting::Blend => "blend",
            Setting::Event => "event",
            Setting::Footsteps => "footsteps",
            Setting::Loop => "loop",
            Setting::CloseLoop => "close loop",
            Setting::FindLoop => "find loop",
            Setting::MaxError => "largest error",
            Setting::MeanError => "mean error",
            Setting::MaxScalarError => "largest scalar error",
            Setting::MaxRotationError => "largest rotation error",
            Setting::MaxJointError => "largest joint rotation error",
            Setting::Shell => "shell",
            Setting::PlacesOnly => "places only",
            Setting::MaxChannelError => "largest channel error",
            Setting::MaxAccelError => "largest acceleration error",
            Setting::Exact => "exact coding",
            Setting::Keys => "keys",
            Setting::Rotations => "rotations",
            Setting::Effort => "effort",
            Setting::Index => "index",
        }
    }
}

impl Error {
    /// A file that cannot be read.
    pub fn read(text: impl Into<String>) -> Error {
        Error::Read(Problem::new(text))
    }

    /// A source that is damaged or of no use.
    pub fn source(text: impl Into<String>) -> Error {
        Error::Source(Problem::new(text))
    }

    /// A setting that is out of range, or does not fit.
    pub fn setting(setting: Setting, text: impl Into<String>) -> Error {
        Error::Setting(setting, Problem::new(text))
    }

    /// A setting whose value is out of range, or does not fit.
    pub fn value(setting: Setting, value: impl fmt::Display, text: impl Into<String>) -> Error {
        Error::Setting(setting, Problem { value: value.to_string(), ..Problem::new(text) })
    }

    /// A motion that takes too much memory.
    pub fn memory(text: impl Into<String>) -> Error {
        Error::Memory(Problem { remedy: Some(Remedy::RaiseMemory), ..Problem::new(text) })
    }

    /// A bound that cannot be kept.
    pub fn bound(text: impl Into<String>) -> Error {
        Error::Bound(Problem::new(text))
    }

    /// Sets what would help.
    pub fn remedy(mut self, remedy: Remedy) -> Error {
        self.problem_mut().remedy = Some(remedy);
        self
    }

    /// The reason and its place.
    pub fn problem(&self) -> &Problem {
        match self {
            Error::Read(problem)
            | Error::Source(problem)
            | Error::Setting(_, problem)
            | Error::Memory(problem)
            | Error::Bound(problem) => problem,
        }
    }

    fn problem_mut(&mut self) -> &mut Problem {
        match self {
            Error::Read(problem)
            | Error::Source(problem)
            | Error::Setting(_, problem)
            | Error::Memory(problem)
            | Error::Bound(problem) => problem,
        }
    }

    /// Puts the name of a file in front of the place.
    pub(crate) fn in_file(mut self, file: &std::path::Path) -> Error {
        let problem = self.problem_mut();
        problem.place = match problem.place.is_empty() {
            true => file.display().to_string(),
            false => format!("{}: {}", file.display(), problem.place),
        };
        self
    }

    /// The error at the surface: the typed cause, if `error` has one, with the contexts around it as its place; otherwise the whole text
    /// as `otherwise` has it.
    pub fn of(error: &anyhow::Error, otherwise: fn(String) -> Error) -> Error {
        let mut place = Vec::new();
        for cause in error.chain() {
            if let Some(typed) = cause.downcast_ref::<Error>() {
                let mut typed = typed.clone();
                let problem = typed.problem_mut();
                place.extend((!problem.place.is_empty()).then(|| problem.place.clone()));
                problem.place = place.join(": ");
                return typed;
            }
            place.push(cause.to_string());
        }
        otherwise(format!("{error:#}"))
    }
}

impl Problem {
    /// A problem without a place.
    pub fn new(text: impl Into<String>) -> Problem {
        Problem { text: text.into(), ..Problem::default() }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.place.is_empty() {
            write!(f, "{}: ", self.place)?;
        }
        f.write_str(&self.text)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let problem = self.problem();
        if !problem.place.is_empty() {
            write!(f, "{}: ", problem.place)?;
        }
        if let Error::Setting(setting, _) = self {
            let value = if problem.value.is_empty() { String::new() } else { format!(" {}", problem.value) };
            write!(f, "{}{value}: ", setting.text())?;
        }
        f.write_str(&problem.text)
    }
}

impl std::error::Error for Error {}

/// Sets what would help in an error, which becomes an [`Error`].
pub(crate) fn with_remedy(error: &anyhow::Error, remedy: Remedy) -> anyhow::Error {
    Error::of(error, Error::source).remedy(remedy).into()
}

/// Returns an [`Error`] as [`anyhow::Error`] unless a condition holds.
macro_rules! require {
    ($condition:expr, $error:expr) => {
        // NaN fails a comparison, and so is refused.
        let holds: bool = $condition;
        if !holds {
            return Err($error.into());
        }
    };
}
pub(crate) use require;

#[cfg(test)]
mod tests {
    use super::*;
    use anyhow::Context;

    #[test]
    fn a_typed_cause_keeps_its_contexts_as_its_place() {
        let failed: anyhow::Result<()> = Err(Error::setting(Setting::Mirror, "no names tell left from right").into());
        let error = failed.context("joint 3").context("walk.bvh").unwrap_err();
        let typed = Error::of(&error, Error::source);
        assert!(matches!(&typed, Error::Setting(Setting::Mirror, problem) if problem.place == "walk.bvh: joint 3"));
        assert_eq!(typed.to_string(), "walk.bvh: joint 3: mirror: no names tell left from right");
        let plain = anyhow::anyhow!("odd").context("walk.bvh");
        assert_eq!(Error::of(&plain, Error::source), Error::source("walk.bvh: odd"));
    }
}
