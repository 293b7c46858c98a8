//! The rows of transitions.

use super::{Maker, NONE, Row, SECONDS};
use crate::machine::source::{Cause, Kind, Source, Start, State, Text, Transition};
use anyhow::{Error, Result, anyhow, bail, ensure};
use pantin::Clip;
use pantin_convert::import::text::quoted;
use toml::Spanned;

/// Frames of a transition, and the greatest first frame.
const MOST_FRAMES: u32 = 255;
const MOST_START: u32 = 254;
/// The causes in a transition's row that have a threshold.
pub(super) const ABOVE: u8 = 4;
pub(super) const BELOW: u8 = 5;

impl<'s> Maker<'s, '_> {
    /// The index of a transition's parameter. Fails if the parameter's range never reaches the threshold.
    fn possible(&self, name: &str, source: &Source, threshold: i16, above: bool) -> Result<u8> {
        let index = self.parameter(name)?;
        let (least, most) = source.parameters[usize::from(index)].range;
        let name = quoted(name);
        ensure!(!above || threshold < most, "parameter {name} is at most {most}, so it is never above {threshold}");
        ensure!(above || threshold > least, "parameter {name} is at least {least}, so it is never below {threshold}");
        Ok(index)
    }

    /// The rows of the transitions of a state, before which those of any state are tried; or the rows of any state.
    pub(super) fn transitions(
        &mut self,
        entries: &[Spanned<Transition>],
        source: &'s Source,
        file: &Text,
        from: Option<&'s State>,
        any: &[Row],
    ) -> Result<Vec<Row>> {
        let own = from.map(|state| self.names[state.name.get_ref().as_str()]);
        let mut rows: Vec<Row> = Vec::new();
        for entry in entries {
            let placed = |error: Error| {
                let error = match from {
                    Some(state) => error.context(format!("state {}", quoted(state.name.get_ref()))),
                    None => error,
                };
                error.context(file.at(entry.span()))
            };
            let row = self.transition(entry.get_ref(), source, from).map_err(placed)?;
            let hidden = rows.iter().any(|other| hides(other, &row));
            ensure!(!hidden, placed(anyhow!("a transition before this one happens whenever this one could")));
            // A transition of any state does not happen in the state that it leads to.
            let hidden = any.iter().any(|other| Some(other[4]) != own && hides(other, &row));
            ensure!(!hidden, placed(anyhow!("a transition of any state ([[any]]) happens whenever this one could")));
            rows.push(row);
        }
        Ok(rows)
    }

    /// A row of the transitions; `from` is `None` for any state.
    fn transition(&mut self, row: &Transition, source: &'s Source, from: Option<&'s State>) -> Result<Row> {
        let to = self.state(&row.to)?;
        let (cause, argument, threshold) = self.cause(row, source, from)?;
        let target = &source.states[usize::from(to)];
        let clip = self.played(target)?.1;
        let (kind, frames) = match row.kind {
            Kind::Cut => {
                ensure!(row.frames.is_none() && row.seconds.is_none(), "a cut has no length");
                (0, 0)
            }
            kind => (if kind == Kind::Inertialized { 1 } else { 2 }, length(row, &clip)?),
        };
        let start = match &row.start {
            None if row.sync.is_some() && clip.looped() => NONE,
            None => 0,
            Some(Start::Named(name)) if name == "in-step" => NONE,
            Some(Start::Named(name)) => bail!("start: expected a frame's number or \"in-step\", found {}", quoted(name)),
            &Some(Start::Frame(frame)) => {
                ensure!(frame <= MOST_START, "start: frame {frame}; at most {MOST_START}");
                ensure!(
                    frame < clip.frames(),
                    "start: frame {frame}; the clip of state {} has {}",
                    quoted(&row.to),
                    clip.frames()
                );
                frame as u8
            }
        };
        let [low, high] = threshold.to_le_bytes();
        Ok([cause, argument, low, high, to, kind, frames, start])
    }

    /// A cause, its argument and its threshold.
    fn cause(&mut self, row: &Transition, source: &Source, from: Option<&State>) -> Result<(u8, u8, i16)> {
        let causes = row.causes();
        let still = from.is_some_and(stands) && (row.end.is_some() || row.event.is_some());
        ensure!(!still, "the state's speed is 0, so its clip has no end and passes no event");
        let [cause] = causes[..] else {
            bail!("a transition has one of end, input, released, event, above and below; this one has {}", causes.len());
        };
        Ok(match cause {
            Cause::End(end) => {
                ensure!(end, "end = false is no cause");
                if let Some(from) = from {
                    let clip = self.played(from)?;
                    ensure!(!clip.1.looped(), "the clip {} is a loop, which has no end", quoted(clip.0));
                }
                let mut ends = false;
                for state in &source.states {
                    ends |= !self.played(state)?.1.looped() && !stands(state);
                }
                ensure!(ends, "every state plays a loop or stands still, and has no end");
                (0, 0, 0)
            }
            Cause::Input(name) => (1, self.input(name)?, 0),
            Cause::Released(name) => (2, self.input(name)?, 0),
            Cause::Event(name) => (3, self.event(name, source, from, &row.to)?, 0),
            Cause::Above(name, threshold) => (ABOVE, self.possible(name, source, threshold, true)?, threshold),
            Cause::Below(name, threshold) => (BELOW, self.possible(name, source, threshold, false)?, threshold),
        })
    }

    /// The id of an event in the clips of the states that a transition leaves, which must be one and the event's alone.
    fn event(&self, name: &str, source: &Source, from: Option<&State>, to: &str) -> Result<u8> {
        let left = |state: &&State| from.is_some() || state.name.get_ref() != to;
        let states: Vec<&State> = from.map_or_else(|| source.states.iter().filter(left).collect(), |from| vec![from]);
        let mut clips = Vec::new();
        for state in states {
            clips.push(self.played(state)?);
        }
        let mut ids: Vec<u32> = clips.iter().filter_map(|(_, clip)| clip.event_id(name)).collect();
        ids.sort_unstable();
        ids.dedup();
        if let [id] = ids[..] {
            let other =
                clips.iter().find(|(_, clip)| clip.event_name(id) != Some(name) && clip.events().any(|event| event.id == id));
            if let Some((clip, held)) = other {
                let its = held.event_name(id).map_or("a nameless event".into(), quoted);
                bail!(
                    "event {} has the id {id}, which is {its} in the clip {}; a transition of each state names it there",
                    quoted(name),
                    quoted(clip)
                );
            }
        }
        match ids[..] {
            [id] => u8::try_from(id).map_err(|_| anyhow!("event {} has the id {id}; at most 255", quoted(name))),
            [] => bail!("no clip that plays there has an event {}; `pantin info CLIP` prints a clip's events", quoted(name)),
            _ => bail!("event {} has different ids in the clips; a transition of each state names it there", quoted(name)),
        }
    }
}

/// Whether a state shows one frame of its clip.
fn stands(state: &State) -> bool {
    state.speed == Some(0.0)
}

/// Whether a transition happens whenever one behind it could.
fn hides(first: &Row, second: &Row) -> bool {
    let [first_threshold, second_threshold] = [first, second].map(|row| i16::from_le_bytes([row[2], row[3]]));
    first[..2] == second[..2]
        && match first[0] {
            ABOVE => second_threshold >= first_threshold,
            BELOW => second_threshold <= first_threshold,
            _ => true,
        }
}

/// The length of a transition in frames of the clip that it leads to.
pub(super) fn length(row: &Transition, clip: &Clip) -> Result<u8> {
    let frames = match (row.frames, row.seconds) {
        (Some(_), Some(_)) => bail!("frames and seconds: a transition has one length"),
        (Some(frames), None) => frames,
        (None, seconds) => {
            let seconds = seconds.unwrap_or(SECONDS);
            let frames = (seconds * 1e9 / f64::from(clip.frame_time_ns())).round();
            ensure!(frames.is_finite() && frames >= 0.0, "seconds: expected a time above 0, found {seconds}");
            frames as u32
        }
    };
    ensure!(
        (1..=MOST_FRAMES).contains(&frames),
        "a transition of {frames} frames; expected 1 to {MOST_FRAMES} (kind = \"cut\" has none)"
    );
    Ok(frames as u8)
}
