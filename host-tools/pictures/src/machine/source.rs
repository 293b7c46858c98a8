//! The text file of a state machine.

use anyhow::{Result, anyhow};
use serde::de::{Error, IgnoredAny, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;
use std::marker::PhantomData;
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
    /// Planted feet are held: absent, they are not.
    pub feet: Option<Spanned<Feet>>,
    /// Transitions from any state.
    #[serde(default)]
    pub any: Vec<Spanned<Transition>>,
    /// Clips that inputs play over the states'.
    #[serde(default, rename = "layer")]
    pub layers: Vec<Spanned<Layer>>,
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
    #[serde(deserialize_with = "pair")]
    pub range: (i16, i16),
    /// Its value at the start: the least one without it.
    pub first: Option<i16>,
}

/// The joints of the feet, where the usual names do not find them.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Feet {
    /// The left ankle.
    pub left: Option<String>,
    /// The right ankle.
    pub right: Option<String>,
}

/// A clip that an input plays over some joints.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Layer {
    /// The clip.
    pub clip: String,
    /// The input.
    pub input: String,
    /// Patterns of the joints' names.
    pub joints: Vec<String>,
    /// States in which it plays: all without it.
    pub states: Option<Vec<String>>,
    /// How long it takes to come, and to go.
    pub seconds: Option<f64>,
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
    /// The least time from one clip to the other, however fast the parameter changes.
    pub seconds: Option<f64>,
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
    #[serde(default, deserialize_with = "some_pair")]
    pub above: Option<(String, i16)>,
    /// Cause: a parameter is less than a number.
    #[serde(default, deserialize_with = "some_pair")]
    pub below: Option<(String, i16)>,
    /// How the difference of the poses goes away.
    #[serde(default)]
    pub kind: Kind,
    /// The length in frames of the new clip.
    pub frames: Option<u32>,
    /// The length in seconds.
    pub seconds: Option<f64>,
    /// Where it may begin: at once without it.
    pub sync: Option<Sync>,
    /// The longest that it waits to begin, in seconds.
    pub within: Option<f64>,
    /// The new clip's first frame. Without it: 0, or in step in a loop that is waited for, for players that hold no feet.
    pub start: Option<Start>,
}

/// What a transition waits for.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Sync {
    /// Poses, and feet on the ground, that match.
    Feet,
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
#[serde(untagged, expecting = "expected a frame's number or \"in-step\"")]
pub enum Start {
    /// A frame's number.
    Frame(u32),
    /// `in-step`: the frame that is in step with the old clip, by the events of footsteps.
    Named(String),
}

impl Source {
    /// Reads the file's text. Errors have a [`Location`].
    pub fn parse(file: &Text) -> Result<Source> {
        toml::from_str(file.text).map_err(|error| {
            let location = error.span().map_or(file.whole(), |span| file.at(span));
            location.error(error.message())
        })
    }

    /// Transitions, those from any state included.
    pub fn transition_count(&self) -> usize {
        self.any.len() + self.states.iter().map(|state| state.transitions.len()).sum::<usize>()
    }
}

/// A file's text, and the name of the file as errors have it.
#[derive(Clone, Copy, Debug)]
pub struct Text<'t> {
    /// The name.
    pub name: &'t str,
    /// The text.
    pub text: &'t str,
}

impl<'t> Text<'t> {
    /// The text of a file's bytes. A byte order mark is skipped. Fails for bytes that are not UTF-8.
    pub fn new(name: &'t str, bytes: &'t [u8]) -> Result<Text<'t>> {
        let text = std::str::from_utf8(bytes).map_err(|_| anyhow!("{name}: not text (UTF-8)"))?;
        Ok(Text { name, text: text.strip_prefix('\u{feff}').unwrap_or(text) })
    }

    /// The location of a span of bytes of the text: where it begins.
    pub fn at(&self, span: Range<usize>) -> Location {
        let before = self.text.get(..span.start).unwrap_or(self.text);
        let column = before.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
        Location { file: self.name.into(), at: Some((self.line(span), column)) }
    }

    /// The file as a whole.
    pub fn whole(&self) -> Location {
        Location { file: self.name.into(), at: None }
    }

    /// The line on which a span of bytes begins, from 1.
    pub fn line(&self, span: Range<usize>) -> usize {
        self.text.as_bytes().iter().take(span.start).filter(|&&byte| byte == b'\n').count() + 1
    }
}

/// Where in a file an error or a warning belongs. It is the outermost context of errors: `error.downcast_ref::<Location>()`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Location {
    /// The name of the file, as in [`Text::name`].
    pub file: String,
    /// The line and the column, both from 1; a column counts characters. `None`: the file as a whole.
    pub at: Option<(usize, usize)>,
}

impl fmt::Display for Location {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.at {
            Some((line, _)) => write!(out, "{}:{line}", self.file),
            None => out.write_str(&self.file),
        }
    }
}

impl Location {
    /// An error at this location.
    pub(super) fn error(&self, text: impl fmt::Display) -> anyhow::Error {
        anyhow!("{text}").context(self.clone())
    }
}

/// What makes a transition happen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause<'s> {
    /// The clip's end; `end = false` is none.
    End(bool),
    /// An input is fired or held.
    Input(&'s str),
    /// An input is not held.
    Released(&'s str),
    /// An event is passed.
    Event(&'s str),
    /// A parameter is greater.
    Above(&'s str, i16),
    /// A parameter is less.
    Below(&'s str, i16),
}

impl Transition {
    /// The causes that the file gives; one is right.
    pub fn causes(&self) -> Vec<Cause<'_>> {
        let causes = [
            self.end.map(Cause::End),
            self.input.as_deref().map(Cause::Input),
            self.released.as_deref().map(Cause::Released),
            self.event.as_deref().map(Cause::Event),
            self.above.as_ref().map(|(name, threshold)| Cause::Above(name, *threshold)),
            self.below.as_ref().map(|(name, threshold)| Cause::Below(name, *threshold)),
        ];
        causes.into_iter().flatten().collect()
    }
}

/// Two values and no more: what follows would be passed over.
fn pair<'de, D: Deserializer<'de>, A: Deserialize<'de>, B: Deserialize<'de>>(from: D) -> Result<(A, B), D::Error> {
    struct Two<A, B>(PhantomData<(A, B)>);
    impl<'de, A: Deserialize<'de>, B: Deserialize<'de>> Visitor<'de> for Two<A, B> {
        type Value = (A, B);

        fn expecting(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
            out.write_str("two values")
        }

        fn visit_seq<S: SeqAccess<'de>>(self, mut values: S) -> Result<(A, B), S::Error> {
            let missing = |count| Error::invalid_length(count, &"two values");
            let one = values.next_element()?.ok_or_else(|| missing(0))?;
            let other = values.next_element()?.ok_or_else(|| missing(1))?;
            match values.next_element::<IgnoredAny>()? {
                None => Ok((one, other)),
                Some(_) => Err(missing(3)),
            }
        }
    }
    from.deserialize_seq(Two(PhantomData))
}

fn some_pair<'de, D: Deserializer<'de>, A: Deserialize<'de>, B: Deserialize<'de>>(from: D) -> Result<Option<(A, B)>, D::Error> {
    pair(from).map(Some)
}
