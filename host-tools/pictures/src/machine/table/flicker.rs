//! Pairs of states between which a machine goes back and forth at every update, as long as inputs and parameters stay.

use super::transitions::{ABOVE, BELOW};
use super::{Maker, Row, Warning};
use crate::machine::source::{Source, State, Text, Transition};
use pantin_convert::import::text::quoted;
use std::collections::BTreeMap;
use toml::Spanned;

/// The causes in a transition's row that are of an input.
const INPUT: u8 = 1;
const RELEASED: u8 = 2;

/// What inputs and parameters have to be, each for itself.
#[derive(Clone, Debug, Default)]
struct Needs {
    /// Whether an input is held.
    held: BTreeMap<u8, bool>,
    /// The least and the greatest value of a parameter.
    within: BTreeMap<u8, (i32, i32)>,
}

impl Needs {
    /// Adds that a transition's condition holds, or does not. Returns whether that can be.
    fn add(&mut self, row: &Row, holds: bool, source: &Source) -> bool {
        let (cause, argument) = (row[0], row[1]);
        let threshold = i32::from(i16::from_le_bytes([row[2], row[3]]));
        match cause {
            INPUT | RELEASED => {
                let held = (cause == INPUT) == holds;
                *self.held.entry(argument).or_insert(held) == held
            }
            ABOVE | BELOW => {
                let (least, most) = source.parameters[usize::from(argument)].range;
                let within = self.within.entry(argument).or_insert((least.into(), most.into()));
                match (cause == ABOVE, holds) {
                    (true, true) => within.0 = within.0.max(threshold + 1),
                    (true, false) => within.1 = within.1.min(threshold),
                    (false, true) => within.1 = within.1.min(threshold - 1),
                    (false, false) => within.0 = within.0.max(threshold),
                }
                within.0 <= within.1
            }
            // Ends and events pass: they do not hold from one update to the next.
            _ => !holds,
        }
    }

    /// Adds what lets the transition at an index be the first one that is taken.
    fn add_first(&mut self, rows: &[Row], index: usize, source: &Source) -> bool {
        let before = rows[..index].iter().filter(|row| row[4] != rows[index][4]);
        self.add(&rows[index], true, source) && { before }.all(|row| self.add(row, false, source))
    }
}

impl Maker<'_, '_> {
    /// Warns of two states, each of which leads to the other while the same inputs are held. `any` are the rows of any state, `of_states` those of each.
    pub(super) fn warn_of_flicker(&mut self, source: &Source, file: &Text, any: &[Row], of_states: &[Vec<Row>]) {
        let list = |state: usize| -> (Vec<Row>, Vec<&Spanned<Transition>>) {
            // An input that leads away from any state is an interruption, which is fired.
            let other = |(row, _): &(&Row, &Spanned<Transition>)| usize::from(row[4]) != state && row[0] != INPUT;
            let any = any.iter().zip(&source.any).filter(other);
            any.chain(of_states[state].iter().zip(&source.states[state].transitions)).unzip()
        };
        let lists: Vec<_> = (0..of_states.len()).map(list).collect();
        for one in 0..lists.len() {
            for other in one + 1..lists.len() {
                let leads = |from: usize, to: usize| {
                    let rows = &lists[from].0;
                    (0..rows.len()).filter(move |&index| usize::from(rows[index][4]) == to)
                };
                let pairs = leads(one, other).flat_map(|there| leads(other, one).map(move |back| (there, back)));
                let together = { pairs }.find_map(|(there, back)| {
                    let mut needs = Needs::default();
                    let both = needs.add_first(&lists[one].0, there, source) && needs.add_first(&lists[other].0, back, source);
                    both.then(|| (needs, lists[one].1[there], lists[other].1[back]))
                });
                if let Some((needs, there, back)) = together {
                    let states = [&source.states[one], &source.states[other]];
                    let text = self.flicker(states, &needs, file.line(back.span()), source);
                    self.warnings.push(Warning::at(file.at(there.span()), text));
                }
            }
        }
    }

    /// The text of the warning; `back` is the line of the transition that leads back.
    fn flicker(&self, states: [&State; 2], needs: &Needs, back: usize, source: &Source) -> String {
        let input = |index: &u8| quoted(&self.inputs[usize::from(*index)]);
        let held = needs.held.iter().map(|(index, held)| format!("{} is {}held", input(index), if *held { "" } else { "not " }));
        let within = needs.within.iter().map(|(index, (least, most))| {
            format!("{} is {least} to {most}", quoted(source.parameters[usize::from(*index)].name.get_ref()))
        });
        let when: Vec<String> = held.chain(within).collect();
        let [one, other] = states.map(|state| quoted(state.name.get_ref()));
        format!(
            "states {one} and {other}: while {}, the machine goes back and forth between them at every update: the transition of line {back} leads back under a condition that holds at the same time. Let one of the two fail while the other holds, such as `released` in place of `input`",
            when.join(" and ")
        )
    }
}
