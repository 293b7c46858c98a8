//! The words of Python for what the library reports: keyword arguments in place of settings and remedies.

use crate::settings::Settings;
use pantin_convert::{Error, Note, Problem, Remedy, Setting};
use serde_json::{Map, Value, json};

/// The keyword argument of `pantin.convert` for a setting; the setting in plain words if there is none.
pub fn keyword(setting: Setting) -> &'static str {
    match setting {
        Setting::FrameRate => "fps",
        Setting::SourceRate => "source_rate",
        Setting::Unit => "cm_per_unit",
        Setting::Up => "up",
        Setting::Animation => "animation",
        Setting::Skeleton => "skeleton",
        Setting::From => "first",
        Setting::To => "last",
        Setting::Joints => "joints",
        Setting::Drop => "drop",
        Setting::Mirror => "mirror",
        Setting::Retarget => "retarget",
        Setting::Body => "body",
        Setting::Map => "joint_map",
        Setting::With => "with_file",
        Setting::Speed => "speed",
        Setting::Between => "between",
        Setting::Rename => "rename",
        Setting::Reverse => "reverse",
        Setting::Scale => "scale",
        Setting::Smooth => "smooth",
        Setting::InPlace => "in_place",
        Setting::Turn => "turn",
        Setting::Pace => "pace",
        Setting::Append => "append",
        Setting::Blend => "blend",
        Setting::Event => "events",
        Setting::Footsteps => "footsteps",
        Setting::Loop => "loop",
        Setting::CloseLoop => "close_loop",
        Setting::MaxError => "max_error_cm",
        Setting::MeanError => "mean_error_cm",
        Setting::MaxScalarError => "max_scalar_error",
        Setting::MaxRotationError => "max_rotation_error",
        Setting::MaxJointError => "max_joint_error",
        Setting::Shell => "shell_cm",
        Setting::PlacesOnly => "places_only",
        Setting::MaxChannelError => "max_channel_error",
        Setting::MaxAccelError => "max_accel_error",
        Setting::Exact => "exact",
        Setting::Keys => "keys",
        Setting::Rotations => "rotations",
        Setting::Effort => "effort",
        Setting::Index => "index",
        other => other.text(),
    }
}

/// The keyword arguments that a remedy needs: `fps=`; empty if Python has none for it.
fn arguments(remedy: Remedy) -> &'static str {
    match remedy {
        Remedy::StateFrameRate | Remedy::ChangeFrameRate | Remedy::LowerFrameRate => "fps=",
        Remedy::StateUnit => "cm_per_unit=",
        Remedy::StateCentimetre => "cm_per_unit=1",
        Remedy::ChooseAnimation => "animation=",
        Remedy::GiveSkeleton | Remedy::ChooseSkeleton => "skeleton=",
        Remedy::RaiseMemory => "memory=",
        Remedy::LoosenBound => "max_error_cm=",
        Remedy::BoundShell => "places_only=False",
        Remedy::ChooseFrames => "first=, last=",
        Remedy::MakeLoop => "loop=True or close_loop=True",
        Remedy::CloseLoop => "close_loop=True",
        Remedy::DropScales => "drop=",
        Remedy::MapJoints => "joint_map=",
        Remedy::FindFootsteps => "footsteps=",
        Remedy::TurnMotion => "turn=",
        Remedy::ShareBody => "body=",
        Remedy::WriteSegments => "segments=True",
        Remedy::AllowSegments => "keys=False",
        Remedy::LeaveOutJoints => "drop=, body=",
        _ => "",
    }
}

/// What to do, with Python's names: `state the frame rate (fps=)`.
fn hint(remedy: Remedy) -> String {
    match arguments(remedy) {
        "" => remedy.text().to_owned(),
        arguments => format!("{} ({arguments})", remedy.text()),
    }
}

/// The message of an exception. `settings` are those of a conversion.
pub fn message(error: &Error, settings: Option<&Settings>) -> String {
    let Problem { place, value, text, remedy } = error.problem();
    let mut message = if place.is_empty() { String::new() } else { format!("{place}: ") };
    match error.refused() {
        Some(setting) => message += &refusal(setting, value, text, settings),
        None => message += text,
    }
    if let Some(remedy) = remedy {
        message += &format!("; {}", hint(*remedy));
    }
    message
}

/// `fps=0: expected a number above 0`.
fn refusal(setting: Setting, value: &str, text: &str, settings: Option<&Settings>) -> String {
    let name = settings.map_or_else(|| keyword(setting), |settings| settings.keyword(setting));
    match settings.and_then(|settings| settings.value(setting)) {
        Some((_, shown)) => format!("{name}={shown}: {text}"),
        None if value.is_empty() => format!("{name}: {text}"),
        None => format!("{name}={value}: {text}"),
    }
}

/// The fields of a note about a bank, with `hint` in Python's words.
pub fn fields_of_bank(note: &Note) -> Map<String, Value> {
    let mut fields = note.fields();
    fields.insert("hint".into(), json!(note.remedy.map(hint)));
    fields
}

/// A note's fields, with `text` in Python's words, `hint` (what to do, or null) and `setting` as a keyword argument.
pub fn fields(note: &Note, settings: &Settings) -> Map<String, Value> {
    let mut fields = note.fields();
    if let Some(setting) = note.setting {
        let name = settings.keyword(setting);
        let rest = note.text.strip_prefix(setting.text());
        fields.insert("text".into(), json!(rest.map_or_else(|| note.text.clone(), |rest| format!("{name}{rest}"))));
        fields.insert("setting".into(), json!(name));
    }
    fields.insert("hint".into(), json!(note.remedy.map(hint)));
    fields
}
