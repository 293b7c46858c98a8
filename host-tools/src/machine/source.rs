//! The text file of a state machine.

use anyhow::{Result, anyhow};
use serde::Deserialize;
use std::ops::Range;
use std::path::PathBuf;
use toml::Spanned;

/// A state machine as its file states it. Names are not checked yet.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Source {
    /// The bank with the clips, beside the file.
    pub bank: Option<PathBuf>,
    /// The state in which the machine starts: the first one without it.
    pub start: Option<Spanned<String>>,
    /// Parameters.
    #[serde(default, rename = "parameter")]
    pub parameters: Vec<Parameter>,
    /// Transitions from any state.
    #[serde(default)]
    pub any: Vec<Spanned<Transition>>,
    /// States, in the order of their indices.
    #[serde(rename = "state")]
    pub states: Vec<State>,
}

/// A number that a program sets.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameter {
    /// Its name.
    pub name: Spanned<String>,
    /// Its least and greatest value.
    pub range: [i16; 2],
    /// Its value at the start: the least one without it.
    pub first: Option<i16>,
}

/// A state.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct State {
    /// Its name.
    pub name: Spanned<String>,
    /// The clip that it plays: the one of its name without it.
    pub clip: Option<Spanned<String>>,
    /// A second clip, and the parameter that blends into it.
    pub blend: Option<Spanned<Blend>>,
    /// The speed: -4 to 4.
    pub speed: Option<f64>,
    /// Its transitions: the first whose cause is there is made.
    #[serde(default)]
    pub transitions: Vec<Spanned<Transition>>,
}

/// A second clip of a state.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Blend {
    /// The clip.
    pub clip: String,
    /// The parameter: at its greatest value the second clip plays alone.
    pub by: String,
}

/// A transition: one cause, where it leads, and how.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Transition {
    /// The state that it leads to.
    pub to: String,
    /// Cause: the clip, which is no loop, has ended. Only `true`.
    pub end: Option<bool>,
    /// Cause: an input is fired or held.
    pub input: Option<String>,
    /// Cause: an input is not held.
    pub released: Option<String>,
    /// Cause: the clip's event of this name is passed.
    pub event: Option<String>,
    /// Cause: a parameter is greater than a number.
    pub above: Option<(String, i16)>,
    /// Cause: a parameter is less than a number.
    pub below: Option<(String, i16)>,
    /// How the difference of the poses goes away.
    #[serde(default)]
    pub kind: Kind,
    /// The length in frames of the new clip.
    pub frames: Option<u32>,
    /// The length in seconds.
    pub seconds: Option<f64>,
    /// The new clip's first frame: 0 without it.
    #[serde(default)]
    pub start: Start,
}

/// How the difference of the poses goes away.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// It does not: the pose jumps.
    Cut,
    /// With the difference of the velocities.
    #[default]
    Inertialized,
    /// That of the poses alone.
    Faded,
}

/// The frame at which a clip starts.
#[derive(Clone, Debug, Deserialize, PartialEq, Eq)]
#[serde(untagged)]
pub enum Start {
    /// A frame's number.
    Frame(u32),
    /// `in-step`: the frame that is in step with the old clip, by the events of footsteps.
    Named(String),
}

impl Default for Start {
    fn default() -> Start {
        Start::Frame(0)
    }
}

impl Source {
    /// Reads the file's text. Errors name the line.
    pub fn parse(text: &str) -> Result<Source> {
        toml::from_str(text).map_err(|error| match error.span() {
            Some(span) => anyhow!("{}: {}", line(text, &span), error.message()),
            None => anyhow!("{}", error.message()),
        })
    }
}

/// The line of a place in a text, from 1.
pub fn line(text: &str, span: &Range<usize>) -> usize {
    text.as_bytes().iter().take(span.start).filter(|&&byte| byte == b'\n').count() + 1
}
