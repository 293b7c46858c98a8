//! Notes and errors as fields of a JSON object, for front ends that hand them on as data: a binding, a page.

use crate::error::{Error, Problem, Setting};
use crate::note::{Note, Place, Remedy};
use serde_json::{Map, Value, json};

impl Note {
    /// All fields: `kind`, `severity` (`info` or `warning`), `text`, `file`, `line`, `joint`, `frame`, `remedy` and `setting`, by their names. A
    /// field of which nothing is known is null.
    pub fn fields(&self) -> Map<String, Value> {
        let Place { file, line, joint, frame } = &self.place;
        let fields = json!({
            "kind": self.kind.name(),
            "severity": if self.is_warning() { "warning" } else { "info" },
            "text": self.text,
            "file": file.as_ref().map(|file| file.display().to_string()),
            "line": line,
            "joint": joint,
            "frame": frame,
            "remedy": self.remedy.map(Remedy::name),
            "setting": self.setting.map(Setting::name),
        });
        fields.as_object().cloned().unwrap_or_default()
    }
}

impl Error {
    /// The variant in reports: `read`, `source`, `setting`, `memory` or `bound`.
    pub fn kind(&self) -> &'static str {
        match self {
            Error::Read(_) => "read",
            Error::Source(_) => "source",
            Error::Setting(..) => "setting",
            Error::Memory(_) => "memory",
            Error::Bound(_) => "bound",
        }
    }

    /// The setting that is refused, if one is.
    pub fn refused(&self) -> Option<Setting> {
        match self {
            Error::Setting(setting, _) => Some(*setting),
            _ => None,
        }
    }

    /// All fields: `kind`, `setting`, `remedy`, `place`, `value` and `text`. A field of which nothing is known is null.
    pub fn fields(&self) -> Map<String, Value> {
        let Problem { place, value, text, remedy } = self.problem();
        let fields = json!({
            "kind": self.kind(),
            "setting": self.refused().map(Setting::name),
            "remedy": remedy.map(Remedy::name),
            "place": (!place.is_empty()).then_some(place),
            "value": (!value.is_empty()).then_some(value),
            "text": text,
        });
        fields.as_object().cloned().unwrap_or_default()
    }
}

impl Remedy {
    /// The name in reports: lower case, with hyphens.
    pub fn name(self) -> &'static str {
        match self {
            Remedy::StateFrameRate => "state-frame-rate",
            Remedy::ChangeFrameRate => "change-frame-rate",
            Remedy::LowerFrameRate => "lower-frame-rate",
            Remedy::StateUnit => "state-unit",
            Remedy::StateCentimetre => "state-centimetre",
            Remedy::ChooseAnimation => "choose-animation",
            Remedy::GiveSkeleton => "give-skeleton",
            Remedy::ChooseSkeleton => "choose-skeleton",
            Remedy::RaiseMemory => "raise-memory",
            Remedy::LoosenBound => "loosen-bound",
            Remedy::BoundShell => "bound-shell",
            Remedy::ChooseFrames => "choose-frames",
            Remedy::MakeLoop => "make-loop",
            Remedy::CloseLoop => "close-loop",
            Remedy::DropScales => "drop-scales",
            Remedy::MapJoints => "map-joints",
            Remedy::ShareForm => "share-form",
            Remedy::FindFootsteps => "find-footsteps",
            Remedy::TurnMotion => "turn-motion",
            Remedy::ShareBody => "share-body",
            Remedy::WriteSegments => "write-segments",
            Remedy::AllowSegments => "allow-segments",
            Remedy::LeaveOutJoints => "leave-out-joints",
        }
    }
}

impl Setting {
    /// The name in reports: lower case, with hyphens.
    pub fn name(self) -> &'static str {
        match self {
            Setting::FrameRate => "frame-rate",
            Setting::SourceRate => "source-rate",
            Setting::Unit => "unit",
            Setting::Up => "up",
            Setting::Animation => "animation",
            Setting::Skeleton => "skeleton",
            Setting::From => "from",
            Setting::To => "to",
            Setting::Joints => "joints",
            Setting::Drop => "drop",
            Setting::Mirror => "mirror",
            Setting::Retarget => "retarget",
            Setting::Body => "body",
            Setting::Map => "map",
            Setting::With => "with",
            Setting::Speed => "speed",
            Setting::Between => "between",
            Setting::Rename => "rename",
            Setting::Reverse => "reverse",
            Setting::Scale => "scale",
            Setting::Smooth => "smooth",
            Setting::InPlace => "in-place",
            Setting::Turn => "turn",
            Setting::Pace => "pace",
            Setting::Append => "append",
            Setting::Blend => "blend",
            Setting::Event => "event",
            Setting::Footsteps => "footsteps",
            Setting::Loop => "loop",
            Setting::CloseLoop => "close-loop",
            Setting::FindLoop => "find-loop",
            Setting::MaxError => "max-error",
            Setting::MeanError => "mean-error",
            Setting::MaxScalarError => "max-scalar-error",
            Setting::MaxRotationError => "max-rotation-error",
            Setting::MaxJointError => "max-joint-error",
            Setting::Shell => "shell",
            Setting::PlacesOnly => "places-only",
            Setting::MaxChannelError => "max-channel-error",
            Setting::MaxAccelError => "max-accel-error",
            Setting::Exact => "exact",
            Setting::Keys => "keys",
            Setting::Rotations => "rotations",
            Setting::Effort => "effort",
            Setting::Index => "index",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::note::NoteKind;

    #[test]
    fn notes_and_errors_are_told_by_names() {
        let note = Note::warning(NoteKind::Unit, "odd").remedy(Remedy::StateUnit).of_joint("hip").at_frame(3).at_line(7);
        let note = Value::from(note.in_file("walk.bvh").fields());
        let expected = json!({
            "kind": "unit", "severity": "warning", "text": "odd", "file": "walk.bvh", "line": 7, "joint": "hip", "frame": 3,
            "remedy": "state-unit", "setting": null,
        });
        assert_eq!(note, expected);
        let error = Error::setting(Setting::CloseLoop, "open").remedy(Remedy::ChooseFrames);
        let expected = json!({ "kind": "setting", "setting": "close-loop", "remedy": "choose-frames", "place": null, "value": null, "text": "open" });
        assert_eq!(Value::from(error.fields()), expected);
    }
}
