//! The names of a machine: states, parameters and inputs, and their indices.

use super::Maker;
use crate::machine::source::{Source, Text};
use anyhow::{Context, Result, ensure};
use pantin_animator::machine::{INPUTS, PARAMETERS, STATES};
use pantin_convert::import::text::quoted;
use std::collections::BTreeMap;

/// Bytes that a name may have.
pub(super) const NAME_BYTES: usize = 255;

/// The states with their indices, and the parameters. Fails for duplicates, names that are empty or too long, and ranges that are empty.
pub(super) fn check<'s>(source: &'s Source, file: &Text) -> Result<(BTreeMap<&'s str, u8>, Vec<&'s str>)> {
    let whole = file.whole();
    let [state_count, parameter_count] = [source.states.len(), source.parameters.len()];
    ensure!(state_count > 0, whole.error("a state machine has at least one [[state]]"));
    ensure!(state_count <= STATES, whole.error(format!("{state_count} states; at most {STATES}")));
    ensure!(parameter_count <= PARAMETERS, whole.error(format!("{parameter_count} parameters; at most {PARAMETERS}")));
    Ok((states(source, file)?, parameters(source, file)?))
}

fn states<'s>(source: &'s Source, file: &Text) -> Result<BTreeMap<&'s str, u8>> {
    let mut names = BTreeMap::new();
    for (index, state) in source.states.iter().enumerate() {
        let (name, place) = (state.name.get_ref(), file.at(state.name.span()));
        check_name(name).with_context(|| place.clone())?;
        let twice = names.insert(name.as_str(), index as u8).is_some();
        ensure!(!twice, place.error(format!("two states are called {}", quoted(name))));
    }
    Ok(names)
}

fn parameters<'s>(source: &'s Source, file: &Text) -> Result<Vec<&'s str>> {
    let mut parameters: Vec<&str> = Vec::new();
    for parameter in &source.parameters {
        let (name, place) = (parameter.name.get_ref(), file.at(parameter.name.span()));
        check_name(name).with_context(|| place.clone())?;
        let twice = parameters.contains(&name.as_str());
        ensure!(!twice, place.error(format!("two parameters are called {}", quoted(name))));
        let (least, most) = parameter.range;
        ensure!(least < most, place.error(format!("parameter {}: the range {least} to {most} is empty", quoted(name))));
        let first = parameter.first.unwrap_or(least);
        ensure!(
            (least..=most).contains(&first),
            place.error(format!("parameter {}: {first} is outside its range {least} to {most}", quoted(name)))
        );
        parameters.push(name);
    }
    Ok(parameters)
}

fn check_name(name: &str) -> Result<()> {
    ensure!(!name.is_empty(), "a name is empty");
    ensure!(name.len() <= NAME_BYTES, "the name {} has {} bytes; at most {NAME_BYTES}", quoted(name), name.len());
    Ok(())
}

impl Maker<'_, '_> {
    pub(super) fn state(&self, name: &str) -> Result<u8> {
        let names: Vec<String> = self.names.keys().map(|name| quoted(name)).collect();
        self.names.get(name).copied().with_context(|| format!("no state {}; there are {}", quoted(name), names.join(", ")))
    }

    pub(super) fn parameter(&self, name: &str) -> Result<u8> {
        let found = self.parameters.iter().position(|other| *other == name);
        let index = found.with_context(|| format!("no [[parameter]] {}", quoted(name)))?;
        self.used[index].set(true);
        Ok(index as u8)
    }

    pub(super) fn input(&mut self, name: &str) -> Result<u8> {
        check_name(name)?;
        if let Some(found) = self.inputs.iter().position(|other| other == name) {
            return Ok(found as u8);
        }
        ensure!(self.inputs.len() < INPUTS, "the input {} is one more than the {INPUTS} that a machine may have", quoted(name));
        self.inputs.push(name.into());
        Ok((self.inputs.len() - 1) as u8)
    }
}
