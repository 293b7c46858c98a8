//! The command line's words for what the library reports: the option of each setting, and the option that helps.

use anyhow::Error;
use pantin_convert::{Note, NoteKind, Remedy, Setting};

/// The option of a setting.
pub fn option(setting: Setting) -> &'static str {
    match setting {
        Setting::FrameRate => "--fps",
        Setting::SourceRate => "--rate",
        Setting::Unit => "--cm-per-unit",
        Setting::Up => "--up",
        Setting::Animation => "--animation",
        Setting::Skeleton => "--skeleton",
        Setting::From => "--from",
        Setting::To => "--to",
        Setting::Joints => "--joints",
        Setting::Drop => "--drop",
        Setting::Mirror => "--mirror",
        Setting::Retarget => "--retarget",
        Setting::Body => "--body",
        Setting::Map => "--map",
        Setting::With => "--with",
        Setting::Speed => "--speed",
        Setting::Between => "--between",
        Setting::Rename => "--rename",
        Setting::Reverse => "--reverse",
        Setting::Scale => "--scale",
        Setting::Smooth => "--smooth",
        Setting::InPlace => "--in-place",
        Setting::Turn => "--turn",
        Setting::Pace => "--pace",
        Setting::Append => "--append",
        Setting::Blend => "--blend",
        Setting::Event => "--event",
        Setting::Footsteps => "--footsteps",
        Setting::Loop => "--loop",
        Setting::CloseLoop => "--close-loop",
        Setting::FindLoop => "--find-loop",
        Setting::MaxError => "--max-error",
        Setting::MeanError => "--mean-error",
        Setting::MaxScalarError => "--max-scalar-error",
        Setting::MaxRotationError => "--max-rotation-error",
        Setting::MaxJointError => "--max-joint-error",
        Setting::Shell => "--shell",
        Setting::PlacesOnly => "--places-only",
        Setting::MaxChannelError => "--max-channel-error",
        Setting::MaxAccelError => "--max-accel-error",
        Setting::Exact => "--exact",
        Setting::Keys => "--keys",
        Setting::Rotations => "--rotations",
        Setting::Effort => "--effort",
        Setting::Index => "--index",
        other => other.text(),
    }
}

/// The option that helps, as a clause; nothing where the text says all.
pub fn advice(remedy: Remedy) -> &'static str {
    match remedy {
        Remedy::StateFrameRate => "--fps gives the frames a second",
        Remedy::ChangeFrameRate => "--fps overrides",
        Remedy::LowerFrameRate => "--fps takes fewer",
        Remedy::StateUnit => "--cm-per-unit overrides",
        Remedy::StateCentimetre => "--cm-per-unit 1 if the unit is the cm",
        Remedy::ChooseAnimation => "--animation takes another, --list shows all",
        Remedy::GiveSkeleton => "--skeleton FILE gives one",
        Remedy::ChooseSkeleton => "--skeleton overrides",
        Remedy::RaiseMemory => "--max-memory raises it",
        Remedy::LoosenBound => "--max-error and --mean-error loosen the bound",
        Remedy::BoundShell => "without --places-only they are kept",
        Remedy::ChooseFrames => "--from and --to choose frames that are alike",
        Remedy::MakeLoop => "--loop or --close-loop makes one",
        Remedy::CloseLoop => "--close-loop makes one",
        Remedy::DropScales => "--drop '*.scale.*' leaves them out",
        Remedy::MapJoints => "--map FILE names them",
        Remedy::ShareForm => "`pantin convert --same-form` gives them one form",
        Remedy::FindFootsteps => "`pantin convert --footsteps` finds them",
        Remedy::TurnMotion => "--turn turns it",
        Remedy::ShareBody => {
            "`pantin convert` with the same --body FILE for all motions (on all lines of a list) puts them on one figure"
        }
        Remedy::WriteSegments => "--segments writes a clip for players without feature `keys`",
        Remedy::AllowSegments => "without --keys it gets segments",
        Remedy::LeaveOutJoints => "--drop PATTERN leaves joints out, --body FILE puts the motion on another figure",
        other => other.text(),
    }
}

/// A note as a sentence, without the word `warning`.
pub fn sentence(note: &Note) -> String {
    let text = match note.setting.filter(|_| note.kind == NoteKind::NoEffect) {
        Some(setting) => note.text.replacen(setting.text(), option(setting), 1),
        None => note.text.clone(),
    };
    with_advice(&text, note.remedy)
}

/// A sentence with the option that helps.
pub fn with_advice(text: &str, remedy: Option<Remedy>) -> String {
    match remedy {
        Some(remedy) => format!("{text}; {}", advice(remedy)),
        None => text.into(),
    }
}

/// A note as a line for a person.
pub fn line(note: &Note) -> String {
    let warning = if note.is_warning() { "warning: " } else { "" };
    format!("{warning}{}", sentence(note))
}

/// An error with its causes, and the option that helps. Some libraries print a cause as their own error: it is printed once.
pub fn explanation(error: &Error) -> String {
    let mut parts: Vec<String> = Vec::new();
    let mut remedy = None;
    for cause in error.chain() {
        match cause.downcast_ref::<pantin_convert::Error>() {
            Some(typed) => {
                let problem = typed.problem();
                parts.extend((!problem.place.is_empty()).then(|| problem.place.clone()));
                parts.push(match typed {
                    pantin_convert::Error::Setting(setting, _) => {
                        let value = if problem.value.is_empty() { String::new() } else { format!(" {}", problem.value) };
                        format!("{}{value}: {}", option(*setting), problem.text)
                    }
                    _ => problem.text.clone(),
                });
                remedy = problem.remedy;
            }
            None => parts.push(cause.to_string()),
        }
    }
    parts.dedup();
    // A command and the library may both name the file.
    with_advice(&parts.join(": "), remedy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_setting_has_its_option_and_every_remedy_its_advice() {
        let error = pantin_convert::Error::value(Setting::To, 9, "the last frame is 3").remedy(Remedy::ChooseFrames);
        let error = Error::new(error).context("walk.bvh");
        let expected = "walk.bvh: --to 9: the last frame is 3; --from and --to choose frames that are alike";
        assert_eq!(explanation(&error), expected);
        let note = Note::no_effect(Setting::Effort, "nothing is searched");
        assert_eq!(line(&note), "--effort has no effect: nothing is searched");
        let note = Note::warning(NoteKind::Unit, "a guess").remedy(Remedy::StateUnit);
        assert_eq!(line(&note), "warning: a guess; --cm-per-unit overrides");
    }
}
