//! A state machine's table: `firmware/animator/MACHINE.md`.

use super::source::{Cause, Kind, Layer, Source, Start, State, Text, Transition};
use anyhow::{Context, Result, anyhow, bail, ensure};
use pantin::codec::crc;
use pantin::{Bank, Clip};
use pantin_animator::Mask;
use pantin_animator::machine::{INPUTS, LAYERS, PARAMETERS, STATES, Table, VERSION};
use pantin_convert::Remedy;
use pantin_convert::import::text::quoted;
use std::cell::Cell;
use std::collections::BTreeMap;
use toml::Spanned;

/// Bytes that a name may have.
const NAME_BYTES: usize = 255;
/// The length of a transition that states none.
const SECONDS: f64 = 0.25;
/// The longest that a layer takes to come: 255 of 64 parts of a second.
const MOST_FADE: f64 = 255.0 / 64.0;
/// In place of a second clip, or of a first frame: none, and in step.
const NONE: u8 = 255;
/// Frames of a transition, the greatest first frame, and transitions of a table.
const MOST_FRAMES: u32 = 255;
const MOST_START: u32 = 254;
const MOST_TRANSITIONS: usize = 255;
/// The speed 1, as a state's row stores it.
const SPEED_ONE: f64 = 256.0;
/// The causes in a transition's row that have a threshold.
const ABOVE: u8 = 4;
const BELOW: u8 = 5;

/// A table, and what its user should know.
#[derive(Clone, Debug)]
pub struct Made {
    /// Its bytes, as a bank's section holds them.
    pub table: Vec<u8>,
    /// What is odd about it.
    pub warnings: Vec<Warning>,
}

/// What is odd about a state machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// A sentence without a full stop.
    pub text: String,
    /// What would help.
    pub remedy: Option<Remedy>,
}

impl Warning {
    fn new(text: String, remedy: Option<Remedy>) -> Warning {
        Warning { text, remedy }
    }
}

/// Why clips do not play together, with what helps.
fn other_form(text: String) -> anyhow::Error {
    pantin_convert::Error::source(text).remedy(Remedy::ShareForm).into()
}

/// The clips of a bank by their names.
struct Clips<'b> {
    all: Vec<(&'b str, Clip<'b>)>,
}

impl<'b> Clips<'b> {
    fn of(bank: &Bank<'b>) -> Result<Clips<'b>> {
        let open = |entry: pantin::BankEntry<'b>| {
            let clip = bank.open(&entry).with_context(|| format!("clip {}", quoted(entry.name())))?;
            Ok((entry.name(), clip))
        };
        Ok(Clips { all: bank.entries().map(open).collect::<Result<_>>()? })
    }

    fn find(&self, name: &str) -> Result<u8> {
        let found = self.all.iter().position(|(other, _)| *other == name);
        let names: Vec<String> = self.all.iter().map(|(name, _)| quoted(name)).collect();
        let found = found.with_context(|| format!("the bank has no clip {}; it has {}", quoted(name), names.join(", ")))?;
        let index = u8::try_from(found).ok().filter(|&index| index != NONE);
        index.with_context(|| format!("clip {} is number {found} of the bank; a state machine uses the first 255", quoted(name)))
    }
}

/// Builds the table of a machine for the clips of a bank. Errors name the `file` from which `source` was read, and the line.
pub fn make(source: &Source, file: &Text, bank: &Bank<'_>) -> Result<Made> {
    let clips = Clips::of(bank)?;
    let mut names = BTreeMap::new();
    let name = file.name;
    ensure!(!source.states.is_empty(), "{name}: a state machine has at least one [[state]]");
    ensure!(source.states.len() <= STATES, "{name}: {} states; at most {STATES}", source.states.len());
    ensure!(source.parameters.len() <= PARAMETERS, "{name}: {} parameters; at most {PARAMETERS}", source.parameters.len());
    for (index, state) in source.states.iter().enumerate() {
        let (name, place) = (state.name.get_ref(), file.at(state.name.span()));
        check_name(name).with_context(|| place.clone())?;
        ensure!(names.insert(name.as_str(), index as u8).is_none(), "{place}: two states are called {}", quoted(name));
    }
    let mut parameters: Vec<&str> = Vec::new();
    for parameter in &source.parameters {
        let (name, place) = (parameter.name.get_ref(), file.at(parameter.name.span()));
        check_name(name).with_context(|| place.clone())?;
        ensure!(!parameters.contains(&name.as_str()), "{place}: two parameters are called {}", quoted(name));
        let (least, most) = parameter.range;
        ensure!(least < most, "{place}: parameter {}: the range {least} to {most} is empty", quoted(name));
        let first = parameter.first.unwrap_or(least);
        ensure!(
            (least..=most).contains(&first),
            "{place}: parameter {}: {first} is outside its range {least} to {most}",
            quoted(name)
        );
        parameters.push(name);
    }
    let used = vec![Cell::new(false); parameters.len()];
    let mut maker = Maker { clips, names, parameters, used, inputs: Vec::new(), warnings: Vec::new() };
    let first = match &source.start {
        None => 0,
        Some(start) => maker.state(start.get_ref()).with_context(|| format!("{}: start", file.at(start.span())))?,
    };
    // Before a transition asks for the clip that it leads to: the error belongs to the state that names it.
    for state in &source.states {
        maker
            .clip_of(state)
            .with_context(|| format!("{}: state {}", maker.place_of_clip(state, file), quoted(state.name.get_ref())))?;
    }
    let any = maker.transitions(&source.any, source, file, None, &[])?;
    let mut rows = any.clone();
    let mut states = Vec::new();
    for state in &source.states {
        states.push(maker.state_row(state, rows.len(), file)?);
        rows.extend(maker.transitions(&state.transitions, source, file, Some(state), &any)?);
        maker.check_end(state, source, file)?;
    }
    maker.check_forms(source)?;
    ensure!(rows.len() <= MOST_TRANSITIONS, "{name}: {} transitions; at most {MOST_TRANSITIONS}", rows.len());
    ensure!(source.layers.len() <= LAYERS, "{name}: {} layers; at most {LAYERS}", source.layers.len());
    let mut layers = Vec::new();
    for layer in &source.layers {
        let row = maker.layer_row(layer.get_ref(), source);
        layers.push(row.with_context(|| format!("{}: layer", file.at(layer.span())))?);
    }
    for (parameter, used) in source.parameters.iter().zip(&maker.used) {
        if !used.get() {
            let place = file.at(parameter.name.span());
            let text = format!("{place}: parameter {}: no blend and no transition uses it", quoted(parameter.name.get_ref()));
            maker.warnings.push(Warning::new(text, None));
        }
    }
    let mut out = vec![
        VERSION,
        states.len() as u8,
        rows.len() as u8,
        maker.parameters.len() as u8,
        maker.inputs.len() as u8,
        first,
        source.any.len() as u8,
        layers.len() as u8,
    ];
    states.iter().chain(&rows).for_each(|row| out.extend(row));
    for parameter in &source.parameters {
        let (least, most) = parameter.range;
        [least, most, parameter.first.unwrap_or(least)].iter().for_each(|value| out.extend(value.to_le_bytes()));
    }
    layers.iter().for_each(|(row, _)| out.extend(row));
    let state_names = source.states.iter().map(|state| state.name.get_ref().as_str());
    for name in state_names.chain(maker.parameters.iter().copied()).chain(maker.inputs.iter().map(String::as_str)) {
        out.push(name.len() as u8);
        out.extend(name.as_bytes());
    }
    for (_, joints) in &layers {
        out.push(joints.len() as u8);
        out.extend(joints.as_bytes());
    }
    out.extend(crc::of(&out).to_le_bytes());
    match Table::new(&out, bank.len()) {
        Ok(_) => {}
        Err(pantin_animator::machine::TableError::Unreachable(state)) => {
            let state = &source.states[usize::from(state)].name;
            bail!("{}: no transition leads to state {}", file.at(state.span()), quoted(state.get_ref()));
        }
        Err(error) => bail!("{name}: {error}"),
    }
    Ok(Made { table: out, warnings: maker.warnings })
}

fn check_name(name: &str) -> Result<()> {
    ensure!(!name.is_empty(), "a name is empty");
    ensure!(name.len() <= NAME_BYTES, "the name {} has {} bytes; at most {NAME_BYTES}", quoted(name), name.len());
    Ok(())
}

struct Maker<'s, 'b> {
    clips: Clips<'b>,
    /// States and their indices.
    names: BTreeMap<&'s str, u8>,
    parameters: Vec<&'s str>,
    /// Whether a state or a transition names the parameter.
    used: Vec<Cell<bool>>,
    /// In the order in which transitions name them.
    inputs: Vec<String>,
    warnings: Vec<Warning>,
}

impl<'s, 'b> Maker<'s, 'b> {
    fn state(&self, name: &str) -> Result<u8> {
        let names: Vec<String> = self.names.keys().map(|name| quoted(name)).collect();
        self.names.get(name).copied().with_context(|| format!("no state {}; there are {}", quoted(name), names.join(", ")))
    }

    fn parameter(&self, name: &str) -> Result<u8> {
        let found = self.parameters.iter().position(|other| *other == name);
        let index = found.with_context(|| format!("no [[parameter]] {}", quoted(name)))?;
        self.used[index].set(true);
        Ok(index as u8)
    }

    fn input(&mut self, name: &str) -> Result<u8> {
        check_name(name)?;
        if let Some(found) = self.inputs.iter().position(|other| other == name) {
            return Ok(found as u8);
        }
        ensure!(self.inputs.len() < INPUTS, "the input {} is one more than the {INPUTS} that a machine may have", quoted(name));
        self.inputs.push(name.into());
        Ok((self.inputs.len() - 1) as u8)
    }

    /// The clip that a state plays: its index.
    fn clip_of(&self, state: &State) -> Result<u8> {
        let name = state.clip.as_ref().map_or(state.name.get_ref(), |clip| clip.get_ref());
        self.clips.find(name)
    }

    /// Where the file names a state's clip.
    fn place_of_clip(&self, state: &State, file: &Text) -> String {
        file.at(state.clip.as_ref().unwrap_or(&state.name).span())
    }

    /// The clip that a state plays, and its name.
    fn played(&self, state: &State) -> Result<&(&'b str, Clip<'b>)> {
        Ok(&self.clips.all[usize::from(self.clip_of(state)?)])
    }

    fn state_row(&mut self, state: &'s State, first: usize, file: &Text) -> Result<[u8; 8]> {
        let name = quoted(state.name.get_ref());
        let place = self.place_of_clip(state, file);
        let clip = self.clip_of(state)?;
        let (mut other, mut parameter) = (NONE, 0);
        if let Some(blend) = &state.blend {
            let place = file.at(blend.span());
            let blend = blend.get_ref();
            let named = self.clips.find(&blend.clip).and_then(|clip| Ok((clip, self.parameter(&blend.by)?)));
            (other, parameter) = named.with_context(|| format!("{place}: state {name}: blend"))?;
            let [own, its] = [clip, other].map(|index| &self.clips.all[usize::from(index)]);
            if own.1.form().check(its.1.form_ref()).is_err() {
                let [own, its] = [quoted(own.0), quoted(its.0)];
                return Err(other_form(format!("{place}: state {name}: the clips {own} and {its} have different forms")));
            }
            let steps =
                |clip: &Clip| clip.event_id(pantin::LEFT_FOOT_DOWN).is_some() || clip.event_id(pantin::RIGHT_FOOT_DOWN).is_some();
            if !steps(&own.1) || !steps(&its.1) {
                let text = format!(
                    "state {name}: without events of footsteps in both clips the second shows the frame of the same number"
                );
                self.warnings.push(Warning::new(text, Some(Remedy::FindFootsteps)));
            }
        }
        let speed = state.speed.unwrap_or(1.0);
        ensure!((-4.0..=4.0).contains(&speed), "{place}: state {name}: the speed {speed} is outside -4 to 4");
        let rounded = (speed * SPEED_ONE).round();
        ensure!(
            speed == 0.0 || rounded != 0.0,
            "{place}: state {name}: the speed {speed} would be stored as 0; the slowest is {}",
            1.0 / SPEED_ONE
        );
        let [low, high] = (rounded as i16).to_le_bytes();
        let [first, count] = [first, state.transitions.len()].map(|number| u8::try_from(number).unwrap_or(u8::MAX));
        Ok([clip, other, parameter, 0, low, high, first, count])
    }

    /// The row of a layer, and the patterns of its joints, one a line.
    fn layer_row(&mut self, layer: &Layer, source: &Source) -> Result<([u8; 12], String)> {
        let clip = self.clips.find(&layer.clip)?;
        let input = self.input(&layer.input)?;
        let seconds = layer.seconds.unwrap_or(SECONDS);
        ensure!((0.0..=MOST_FADE).contains(&seconds), "seconds: expected 0 to {MOST_FADE}, found {seconds}");
        let rig = self.clips.all[usize::from(clip)].1.rig();
        let mut words = vec![0; Mask::words(&rig)];
        let mut mask = Mask::new(&rig, &mut words)?;
        ensure!(!layer.joints.is_empty(), "joints: it has none");
        for pattern in &layer.joints {
            mask.set(&rig, pattern, true).with_context(|| format!("joints: {}", quoted(pattern)))?;
        }
        let joints = layer.joints.join("\n");
        ensure!(joints.len() <= NAME_BYTES, "joints: {} bytes of patterns; at most {NAME_BYTES}", joints.len());
        let mut states = u64::MAX;
        if let Some(names) = &layer.states {
            ensure!(!names.is_empty(), "states: it has none, so the layer would never play");
            states = 0;
            for name in names {
                states |= 1 << self.state(name)?;
            }
        }
        for (_, state) in source.states.iter().enumerate().filter(|(index, _)| states >> index & 1 != 0) {
            let (name, under) = self.played(state)?;
            if under.form().check(self.clips.all[usize::from(clip)].1.form_ref()).is_err() {
                let [own, its] = [quoted(name), quoted(&layer.clip)];
                return Err(other_form(format!("the clips {own} and {its} have different forms")));
            }
        }
        let mut row = [0; 12];
        (row[0], row[1], row[2]) = (clip, input, (seconds * 64.0).round() as u8);
        row[4..].copy_from_slice(&states.to_le_bytes());
        Ok((row, joints))
    }

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
    fn transitions(
        &mut self,
        entries: &[Spanned<Transition>],
        source: &'s Source,
        file: &Text,
        from: Option<&'s State>,
        any: &[[u8; 8]],
    ) -> Result<Vec<[u8; 8]>> {
        let own = from.map(|state| self.names[state.name.get_ref().as_str()]);
        let mut rows: Vec<[u8; 8]> = Vec::new();
        for entry in entries {
            let place = || match from {
                Some(state) => format!("{}: state {}", file.at(entry.span()), quoted(state.name.get_ref())),
                None => file.at(entry.span()),
            };
            let row = self.transition(entry.get_ref(), source, from).with_context(place)?;
            let hidden = rows.iter().any(|other| hides(other, &row));
            ensure!(!hidden, "{}: a transition before this one happens whenever this one could", place());
            // A transition of any state does not happen in the state that it leads to.
            let hidden = any.iter().any(|other| Some(other[4]) != own && hides(other, &row));
            ensure!(!hidden, "{}: a transition of any state ([[any]]) happens whenever this one could", place());
            rows.push(row);
        }
        Ok(rows)
    }

    /// A row of the transitions; `from` is `None` for any state.
    fn transition(&mut self, row: &Transition, source: &'s Source, from: Option<&'s State>) -> Result<[u8; 8]> {
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
            Start::Named(name) if name == "in-step" => NONE,
            Start::Named(name) => bail!("start: expected a frame's number or \"in-step\", found {}", quoted(name)),
            &Start::Frame(frame) => {
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

    /// Warns if the clips' forms differ: transitions between them take more instructions, and a picture is drawn of poses of one form.
    fn check_forms(&mut self, source: &Source) -> Result<()> {
        let Some(first) = source.states.first() else { return Ok(()) };
        let (name, clip) = self.played(first)?;
        for state in &source.states[1..] {
            let (other, its) = self.played(state)?;
            if clip.form().check(its.form_ref()).is_err() {
                let [name, other] = [quoted(name), quoted(other)];
                let text = format!("the clips {name} and {other} have different forms, which no picture draws together");
                self.warnings.push(Warning::new(text, Some(Remedy::ShareForm)));
                break;
            }
        }
        Ok(())
    }

    /// Warns of a state at whose end the figure stands still.
    fn check_end(&mut self, state: &State, source: &Source, file: &Text) -> Result<()> {
        let (name, clip) = self.played(state)?;
        if !clip.looped() && state.transitions.is_empty() && source.any.is_empty() {
            let text = format!(
                "line {}: state {}: the clip {} is no loop, and no transition leads away: the figure stays in its last frame",
                file.line(state.name.span()),
                quoted(state.name.get_ref()),
                quoted(name)
            );
            self.warnings.push(Warning::new(text, None));
        }
        Ok(())
    }
}

/// Whether a state shows one frame of its clip.
fn stands(state: &State) -> bool {
    state.speed == Some(0.0)
}

/// Whether a transition happens whenever one behind it could.
fn hides(first: &[u8; 8], second: &[u8; 8]) -> bool {
    let [first_threshold, second_threshold] = [first, second].map(|row| i16::from_le_bytes([row[2], row[3]]));
    first[..2] == second[..2]
        && match first[0] {
            ABOVE => second_threshold >= first_threshold,
            BELOW => second_threshold <= first_threshold,
            _ => true,
        }
}

/// The length of a transition in frames of the clip that it leads to.
fn length(row: &Transition, clip: &Clip) -> Result<u8> {
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
