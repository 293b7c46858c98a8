//! Why a build script fails.

use pantin_convert::{Error as Failure, Remedy};
use std::fmt;
use std::path::Path;

/// Why a build script fails: what is wrong, where, and what to do.
///
/// `Debug` prints the same text as `Display`, because that is what a `main` that returns the error prints.
#[derive(Clone, PartialEq, Eq)]
pub struct Error {
    text: String,
    help: String,
}

impl Error {
    /// A problem of the file `path`.
    pub(crate) fn of_file(path: &Path, text: impl fmt::Display, help: impl Into<String>) -> Error {
        Error { text: format!("{}: {text}", path.display()), help: help.into() }
    }

    /// A failed conversion of the file `path`.
    pub(crate) fn of_conversion(path: &Path, failure: &Failure) -> Error {
        let (text, place) = (failure.to_string(), path.display().to_string());
        let text = if text.starts_with(&place) { text } else { format!("{place}: {text}") };
        Error { text, help: help(failure) }
    }
}

/// What to do about a failed conversion.
fn help(failure: &Failure) -> String {
    match (failure.problem().remedy.map(Remedy::text), failure) {
        (Some(remedy), _) => format!("{remedy} in the recipe"),
        (None, Failure::Read(_)) => "check the path; relative paths start at the folder of the package".into(),
        (None, Failure::Setting(setting, _)) => format!("change this setting of the recipe: {}", setting.text()),
        (None, Failure::Bound(_)) => "allow a larger error in the recipe".into(),
        (None, _) => "mend the file, or choose another one".into(),
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}\n  help: {}", self.text, self.help)
    }
}

impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for Error {}
