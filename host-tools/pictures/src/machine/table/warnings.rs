//! What is odd about a state machine.

use super::Maker;
use crate::machine::source::{Location, Source, State, Text};
use anyhow::Result;
use pantin::Bank;
use pantin_convert::import::text::quoted;
use pantin_convert::{Memory, Remedy};
use std::fmt;

/// What is odd about a state machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// Where in the text it belongs, if it belongs to a part of it.
    pub location: Option<Location>,
    /// A sentence without a full stop.
    pub text: String,
    /// What would help.
    pub remedy: Option<Remedy>,
}

impl Warning {
    /// A warning about all of the machine, or about the clips.
    pub(super) fn new(text: String, remedy: Option<Remedy>) -> Warning {
        Warning { location: None, text, remedy }
    }

    /// A warning about a part of the text.
    pub(super) fn at(location: Location, text: String) -> Warning {
        Warning { location: Some(location), text, remedy: None }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(location) = &self.location {
            write!(out, "{location}: ")?;
        }
        out.write_str(&self.text)
    }
}

/// Why clips do not play together, with what helps.
pub(super) fn other_form(text: String) -> anyhow::Error {
    pantin_convert::Error::source(text).remedy(Remedy::ShareForm).into()
}

impl Maker<'_, '_> {
    /// Warns if the clips' forms differ: transitions between them take more instructions, and a picture is drawn of poses of one form.
    pub(super) fn warn_of_forms(&mut self, source: &Source) -> Result<()> {
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

    /// Warns if the clips travel by different joints: the machine moves the figure by one joint.
    pub(super) fn warn_of_travel(&mut self, bank: &Bank<'_>) -> Result<()> {
        if let Some(note) = pantin_convert::bank::travel(bank, Memory::default())? {
            self.warnings.push(Warning::new(note.text, note.remedy));
        }
        Ok(())
    }

    /// Warns of a state at whose end the figure stands still.
    pub(super) fn warn_of_end(&mut self, state: &State, source: &Source, file: &Text) -> Result<()> {
        let (name, clip) = self.played(state)?;
        if !clip.looped() && state.transitions.is_empty() && source.any.is_empty() {
            let text = format!(
                "state {}: the clip {} is no loop, and no transition leads away: the figure stays in its last frame",
                quoted(state.name.get_ref()),
                quoted(name)
            );
            self.warnings.push(Warning::at(file.at(state.name.span()), text));
        }
        Ok(())
    }

    /// Warns of parameters that nothing names.
    pub(super) fn warn_of_unused(&mut self, source: &Source, file: &Text) {
        for (parameter, _) in source.parameters.iter().zip(&self.used).filter(|(_, used)| !used.get()) {
            let text = format!("parameter {}: no blend and no transition uses it", quoted(parameter.name.get_ref()));
            self.warnings.push(Warning::at(file.at(parameter.name.span()), text));
        }
    }
}
