//! What a conversion reports beside its result: data first, with an English sentence that names no option of any front end.

use crate::error::Setting;
use std::fmt;
use std::path::PathBuf;

/// How much a note matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// States what was done. No action is needed.
    Info,
    /// The result may not be what the user wants, or a part of the source was left out.
    Warning,
}

/// What a note is about. Front ends choose their own words by it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum NoteKind {
    /// The source's unit of length: stated, given by the user, or guessed.
    Unit,
    /// The frame rate: assumed, measured, or as the user says.
    FrameRate,
    /// The direction that is vertical.
    Up,
    /// Which of several animations was read.
    Animation,
    /// Which skeleton belongs to the motion.
    Skeleton,
    /// Names that had to change, or that several joints share.
    Names,
    /// Joints or their channels that were changed or left out.
    Joints,
    /// Columns, interpolators, layers or other parts of the file that were left out.
    Unread,
    /// Scales that change and became scalars.
    Scale,
    /// Frames that are missing, doubled or interpolated.
    Frames,
    /// The source moves nothing.
    Still,
    /// Events that were merged or left out.
    Events,
    /// The motion is a loop, became one, or is none any more.
    Loop,
    /// Footsteps that were found.
    Footsteps,
    /// Joints that were put on another body, and how far they are off.
    Retarget,
    /// The way of a figure, and the joint by which it travels.
    Travel,
    /// Scalars of another file were added.
    Joined,
    /// A setting that has no effect on this motion.
    NoEffect,
    /// A bound that is wider than asked for.
    BoundRaised,
    /// Rotations or other parts of the motion that the bound does not hold, and how far they are off.
    Unbounded,
    /// What seeking costs in bytes.
    Index,
    /// Which files became one clip, or were not used.
    Sources,
    /// Whether the clip holds keys or segments, and what the other one takes.
    Keys,
}

impl NoteKind {
    /// All kinds.
    pub const ALL: [NoteKind; 23] = [
        NoteKind::Unit,
        NoteKind::FrameRate,
        NoteKind::Up,
        NoteKind::Animation,
        NoteKind::Skeleton,
        NoteKind::Names,
        NoteKind::Joints,
        NoteKind::Unread,
        NoteKind::Scale,
        NoteKind::Frames,
        NoteKind::Still,
        NoteKind::Events,
        NoteKind::Loop,
        NoteKind::Footsteps,
        NoteKind::Retarget,
        NoteKind::Travel,
        NoteKind::Joined,
        NoteKind::NoEffect,
        NoteKind::BoundRaised,
        NoteKind::Unbounded,
        NoteKind::Index,
        NoteKind::Sources,
        NoteKind::Keys,
    ];

    /// The name in reports: lower case, with hyphens.
    pub fn name(self) -> &'static str {
        match self {
            NoteKind::Unit => "unit",
            NoteKind::FrameRate => "frame-rate",
            NoteKind::Up => "up",
            NoteKind::Animation => "animation",
            NoteKind::Skeleton => "skeleton",
            NoteKind::Names => "names",
            NoteKind::Joints => "joints",
            NoteKind::Unread => "unread",
            NoteKind::Scale => "scale",
            NoteKind::Frames => "frames",
            NoteKind::Still => "still",
            NoteKind::Events => "events",
            NoteKind::Loop => "loop",
            NoteKind::Footsteps => "footsteps",
            NoteKind::Retarget => "retarget",
            NoteKind::Travel => "travel",
            NoteKind::Joined => "joined",
            NoteKind::NoEffect => "no-effect",
            NoteKind::BoundRaised => "bound-raised",
            NoteKind::Unbounded => "unbounded",
            NoteKind::Index => "index",
            NoteKind::Sources => "sources",
            NoteKind::Keys => "keys",
        }
    }
}

/// What would change what a note or an error is about. Each front end has its own words for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Remedy {
    /// State the frame rate: the source has none.
    StateFrameRate,
    /// State another frame rate.
    ChangeFrameRate,
    /// Take fewer frames a second.
    LowerFrameRate,
    /// State the length of the source's unit.
    StateUnit,
    /// State that the source's unit is the centimetre.
    StateCentimetre,
    /// Choose another animation of the file.
    ChooseAnimation,
    /// Give the motion's skeleton.
    GiveSkeleton,
    /// Choose another skeleton.
    ChooseSkeleton,
    /// Allow more memory.
    RaiseMemory,
    /// Ask for a looser bound.
    LoosenBound,
    /// Bound the shells of joints, not their places alone.
    BoundShell,
    /// Choose other first and last frames.
    ChooseFrames,
    /// Close the seam to a loop, or take the motion as one cycle.
    MakeLoop,
    /// Take the motion as one cycle.
    CloseLoop,
    /// Leave out the scalars of scales.
    DropScales,
    /// Name the joints that were not recognized.
    MapJoints,
    /// Convert the motions of a state machine with one form.
    ShareForm,
    /// Find the footsteps of the motions.
    FindFootsteps,
    /// Turn the motion about the vertical.
    TurnMotion,
    /// Put all motions of a bank on one body.
    ShareBody,
    /// Write segments, which players without feature `keys` play, too.
    WriteSegments,
    /// Allow segments where a motion has no key clip.
    AllowSegments,
    /// Convert fewer joints.
    LeaveOutJoints,
}

impl Remedy {
    /// What to do, for a program without words of its own: `state the frame rate`.
    pub fn text(self) -> &'static str {
        match self {
            Remedy::StateFrameRate => "state the frame rate",
            Remedy::ChangeFrameRate => "state another frame rate",
            Remedy::LowerFrameRate => "choose a lower frame rate",
            Remedy::StateUnit => "state the length of the unit",
            Remedy::StateCentimetre => "state that the unit is the centimetre",
            Remedy::ChooseAnimation => "choose another animation",
            Remedy::GiveSkeleton => "give the skeleton's file",
            Remedy::ChooseSkeleton => "choose another skeleton",
            Remedy::RaiseMemory => "raise the limit of memory",
            Remedy::LoosenBound => "allow a larger error",
            Remedy::BoundShell => "bound the shells of joints",
            Remedy::ChooseFrames => "choose a first and a last frame that are alike",
            Remedy::CloseLoop => "take the motion as one cycle",
            Remedy::MakeLoop => "close the ends to a loop",
            Remedy::DropScales => "leave out the scalars of scales",
            Remedy::MapJoints => "map the names of the joints",
            Remedy::ShareForm => "convert the motions with one form",
            Remedy::FindFootsteps => "find the footsteps of the motions",
            Remedy::TurnMotion => "turn the motion about the vertical",
            Remedy::ShareBody => "put all of the motions on the same body",
            Remedy::WriteSegments => "write segments for players without feature `keys`",
            Remedy::AllowSegments => "allow segments",
            Remedy::LeaveOutJoints => "leave out joints",
        }
    }
}

/// Where in a source a note belongs. What is not known is `None`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// The file.
    pub file: Option<PathBuf>,
    /// Its line, from 1.
    pub line: Option<usize>,
    /// The joint, scalar or channel, by its name in the source.
    pub joint: Option<String>,
    /// The frame, from 0.
    pub frame: Option<usize>,
}

/// One sentence about a conversion.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Note {
    /// What it is about.
    pub kind: NoteKind,
    /// How much it matters.
    pub severity: Severity,
    /// Where it belongs.
    pub place: Place,
    /// The sentence in English, without a full stop.
    pub text: String,
    /// What would change it.
    pub remedy: Option<Remedy>,
    /// The setting that it is about.
    pub setting: Option<Setting>,
}

impl Note {
    /// A note that needs no action.
    pub fn info(kind: NoteKind, text: impl Into<String>) -> Note {
        Note { kind, severity: Severity::Info, place: Place::default(), text: text.into(), remedy: None, setting: None }
    }

    /// A note about what may be wrong or was left out.
    pub fn warning(kind: NoteKind, text: impl Into<String>) -> Note {
        Note { severity: Severity::Warning, ..Note::info(kind, text) }
    }

    /// A setting without effect, and why.
    pub fn no_effect(setting: Setting, why: impl fmt::Display) -> Note {
        let text = format!("{} has no effect: {why}", setting.text());
        Note { setting: Some(setting), ..Note::info(NoteKind::NoEffect, text) }
    }

    /// The same with what would change it.
    pub fn remedy(self, remedy: Remedy) -> Note {
        Note { remedy: Some(remedy), ..self }
    }

    /// The same about a file.
    pub fn in_file(mut self, file: impl Into<PathBuf>) -> Note {
        self.place.file = Some(file.into());
        self
    }

    /// The same about a line, from 1.
    pub fn at_line(mut self, line: usize) -> Note {
        self.place.line = Some(line);
        self
    }

    /// The same about a joint, scalar or channel.
    pub fn of_joint(mut self, joint: impl Into<String>) -> Note {
        self.place.joint = Some(joint.into());
        self
    }

    /// The same about a frame, from 0.
    pub fn at_frame(mut self, frame: usize) -> Note {
        self.place.frame = Some(frame);
        self
    }

    /// Whether it is a warning.
    pub fn is_warning(&self) -> bool {
        self.severity == Severity::Warning
    }
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// The first `most` of some texts, and how many more there are: `a, b and 3 more`.
pub(crate) fn first_of(texts: &[String], most: usize) -> String {
    let shown = texts[..most.min(texts.len())].join(", ");
    match texts.len().saturating_sub(most) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_have_names_of_their_own() {
        let names: std::collections::HashSet<&str> = NoteKind::ALL.iter().map(|kind| kind.name()).collect();
        assert_eq!(names.len(), NoteKind::ALL.len());
    }
}
