//! What the inputs of a machine do, for front ends that offer them.

use super::source::{Source, State};
use pantin::Bank;
use std::collections::BTreeSet;

/// Each state with the inputs that do something in it: they lead to another state, or play a layer.
pub fn of_states(source: &Source) -> Vec<(&str, Vec<&str>)> {
    source.states.iter().map(|state| of_state(source, state)).collect()
}

/// A state with its inputs.
fn of_state<'s>(source: &'s Source, state: &'s State) -> (&'s str, Vec<&'s str>) {
    let rows = state.transitions.iter().chain(&source.any).map(|row| row.get_ref());
    let leading = rows.flat_map(|row| [&row.input, &row.released]).flatten();
    let layers = source.layers.iter().map(|layer| layer.get_ref());
    let played = layers.filter(|layer| layer.states.as_ref().is_none_or(|states| states.contains(state.name.get_ref())));
    (state.name.get_ref(), leading.chain(played.map(|layer| &layer.input)).map(String::as_str).collect())
}

/// The inputs that are to be held: their release has an effect, because a transition names it, or because a layer of theirs is a loop of the bank.
pub fn held<'s>(source: &'s Source, bank: &Bank<'_>) -> BTreeSet<&'s str> {
    let rows = source.states.iter().flat_map(|state| &state.transitions).chain(&source.any);
    let released = rows.filter_map(|row| row.get_ref().released.as_deref());
    let layers = source.layers.iter().map(|layer| layer.get_ref());
    let loops = layers.filter(|layer| bank.clip(&layer.clip).is_ok_and(|clip| clip.looped()));
    released.chain(loops.map(|layer| layer.input.as_str())).collect()
}
