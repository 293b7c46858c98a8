//! The clips that a machine's states and layers name.

use super::{Maker, NONE};
use crate::machine::source::{Location, State, Text};
use anyhow::{Context, Result};
use pantin::{Bank, Clip};
use pantin_convert::import::text::quoted;

/// The clips of a bank by their names.
pub(super) struct Clips<'b> {
    pub all: Vec<(&'b str, Clip<'b>)>,
}

impl<'b> Clips<'b> {
    pub fn of(bank: &Bank<'b>) -> Result<Clips<'b>> {
        let open = |entry: pantin::BankEntry<'b>| {
            let clip = bank.open(&entry).with_context(|| format!("clip {}", quoted(entry.name())))?;
            Ok((entry.name(), clip))
        };
        Ok(Clips { all: bank.entries().map(open).collect::<Result<_>>()? })
    }

    pub fn find(&self, name: &str) -> Result<u8> {
        let found = self.all.iter().position(|(other, _)| *other == name);
        let names: Vec<String> = self.all.iter().map(|(name, _)| quoted(name)).collect();
        let found = found.with_context(|| format!("the bank has no clip {}; it has {}", quoted(name), names.join(", ")))?;
        let index = u8::try_from(found).ok().filter(|&index| index != NONE);
        index.with_context(|| format!("clip {} is number {found} of the bank; a state machine uses the first 255", quoted(name)))
    }
}

impl<'b> Maker<'_, 'b> {
    /// The clip that a state plays: its index.
    pub(super) fn clip_of(&self, state: &State) -> Result<u8> {
        let name = state.clip.as_ref().map_or(state.name.get_ref(), |clip| clip.get_ref());
        self.clips.find(name)
    }

    /// Where the file names a state's clip.
    pub(super) fn place_of_clip(&self, state: &State, file: &Text) -> Location {
        file.at(state.clip.as_ref().unwrap_or(&state.name).span())
    }

    /// The clip that a state plays, and its name.
    pub(super) fn played(&self, state: &State) -> Result<&(&'b str, Clip<'b>)> {
        Ok(&self.clips.all[usize::from(self.clip_of(state)?)])
    }
}
