//! A state machine's table: `firmware/animator/MACHINE.md`.

mod clips;
mod entries;
mod feet;
mod flicker;
mod names;
mod rows;
mod transitions;
mod warnings;

pub use warnings::Warning;

use super::source::{Source, Text};
use anyhow::{Context, Result, ensure};
use clips::Clips;
use pantin::Bank;
use pantin::codec::crc;
use pantin_animator::machine::{LAYERS, Table, TableError, VERSION};
use pantin_convert::import::text::quoted;
use rows::LayerRow;
use std::cell::Cell;
use std::collections::BTreeMap;

/// In place of a second clip, or of a first frame: none, and in step.
const NONE: u8 = 255;
/// The length of a transition, and how long a layer takes to come, in seconds, where the file states none.
const SECONDS: f64 = 0.25;
const MOST_TRANSITIONS: usize = 255;

/// A row of a state or of a transition.
type Row = [u8; 8];

/// A table, and what its user should know.
#[derive(Clone, Debug)]
pub struct Made {
    /// Its bytes, as a bank's section holds them.
    pub table: Vec<u8>,
    /// The bytes of the table of feet, if the text has one.
    pub feet: Option<Vec<u8>>,
    /// What is odd about it.
    pub warnings: Vec<Warning>,
}

/// Builds the table of a machine for the clips of a bank. Errors have a [`Location`](super::Location) in the `file` from which `source` was read, unless a clip is damaged.
pub fn make(source: &Source, file: &Text, bank: &Bank<'_>) -> Result<Made> {
    let mut maker = Maker::new(source, file, bank)?;
    let rows = maker.rows(source, file)?;
    maker.warn_of_unused(source, file);
    maker.warn_of_travel(bank)?;
    let table = maker.bytes(source, &rows);
    check(&table, source, file, bank)?;
    maker.check_sync(source, file)?;
    let feet = source
        .feet
        .as_ref()
        .map(|feet| maker.feet(feet.get_ref(), source, file).context("feet").with_context(|| file.at(feet.span())));
    Ok(Made { table, feet: feet.transpose()?, warnings: maker.warnings })
}

/// Everything in a table that refers to names.
struct Rows {
    /// Index of the state in which the machine starts.
    first: u8,
    states: Vec<Row>,
    /// Those of any state come first, then those of each state.
    transitions: Vec<Row>,
    layers: Vec<LayerRow>,
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
    fn new(source: &'s Source, file: &Text, bank: &Bank<'b>) -> Result<Maker<'s, 'b>> {
        let clips = Clips::of(bank)?;
        let (names, parameters) = names::check(source, file)?;
        let used = vec![Cell::new(false); parameters.len()];
        Ok(Maker { clips, names, parameters, used, inputs: Vec::new(), warnings: Vec::new() })
    }

    /// The rows of states, transitions and layers.
    fn rows(&mut self, source: &'s Source, file: &Text) -> Result<Rows> {
        let first = match &source.start {
            None => 0,
            Some(start) => self.state(start.get_ref()).context("start").with_context(|| file.at(start.span()))?,
        };
        // Before a transition asks for the clip that it leads to: the error belongs to the state that names it.
        for state in &source.states {
            let found = self.clip_of(state).with_context(|| format!("state {}", quoted(state.name.get_ref())));
            found.with_context(|| self.place_of_clip(state, file))?;
        }
        let any = self.transitions(&source.any, source, file, None, &[])?;
        let (mut states, mut transitions) = (Vec::new(), any.clone());
        let mut of_states = Vec::new();
        for state in &source.states {
            states.push(self.state_row(state, transitions.len(), file)?);
            let own = self.transitions(&state.transitions, source, file, Some(state), &any)?;
            transitions.extend(&own);
            of_states.push(own);
            self.warn_of_end(state, source, file)?;
        }
        self.warn_of_flicker(source, file, &any, &of_states);
        self.warn_of_forms(source)?;
        let (whole, [transition_count, layer_count]) = (file.whole(), [transitions.len(), source.layers.len()]);
        let many = || whole.error(format!("{transition_count} transitions; at most {MOST_TRANSITIONS}"));
        ensure!(transition_count <= MOST_TRANSITIONS, many());
        ensure!(layer_count <= LAYERS, whole.error(format!("{layer_count} layers; at most {LAYERS}")));
        let mut layers = Vec::new();
        for layer in &source.layers {
            let row = self.layer_row(layer.get_ref(), source);
            layers.push(row.context("layer").with_context(|| file.at(layer.span()))?);
        }
        Ok(Rows { first, states, transitions, layers })
    }

    /// The table's bytes, in the order of MACHINE.md.
    fn bytes(&self, source: &Source, rows: &Rows) -> Vec<u8> {
        let mut out = vec![
            VERSION,
            rows.states.len() as u8,
            rows.transitions.len() as u8,
            self.parameters.len() as u8,
            self.inputs.len() as u8,
            rows.first,
            source.any.len() as u8,
            rows.layers.len() as u8,
        ];
        out.extend(rows.states.iter().chain(&rows.transitions).flatten());
        for parameter in &source.parameters {
            let (least, most) = parameter.range;
            [least, most, parameter.first.unwrap_or(least)].iter().for_each(|value| out.extend(value.to_le_bytes()));
        }
        out.extend(rows.layers.iter().flat_map(|layer| layer.row));
        let states = source.states.iter().map(|state| state.name.get_ref().as_str());
        let names = states.chain(self.parameters.iter().copied()).chain(self.inputs.iter().map(String::as_str));
        for text in names.chain(rows.layers.iter().map(|layer| layer.joints.as_str())) {
            out.push(text.len() as u8);
            out.extend(text.as_bytes());
        }
        out.extend(crc::of(&out).to_le_bytes());
        out
    }
}

/// Opens the table as the device does.
fn check(table: &[u8], source: &Source, file: &Text, bank: &Bank<'_>) -> Result<()> {
    match Table::new(table, bank.len()) {
        Ok(_) => Ok(()),
        Err(TableError::Unreachable(state)) => {
            let state = &source.states[usize::from(state)].name;
            let text = format!("no transition leads to state {}", quoted(state.get_ref()));
            Err(file.at(state.span()).error(text))
        }
        Err(error) => Err(file.whole().error(error)),
    }
}
