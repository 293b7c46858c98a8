//! From the text of a machine and a bank to the bank with the machine: what `pantin machine` does, without files.

use super::source::{Source, Text};
use super::table::{Warning, make};
use anyhow::Result;
use pantin::Bank;
use pantin_animator::machine::{FEET_SECTION, SECTION};
use pantin_convert::bank;

/// A bank with a state machine, and what a front end reports about it.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// The bank: its clips, and the machine in place of one that was there.
    pub bank: Vec<u8>,
    /// What is odd about the machine.
    pub warnings: Vec<Warning>,
    /// Number of clips.
    pub clips: usize,
    /// Number of states.
    pub states: usize,
    /// Number of transitions, those from any state included.
    pub transitions: usize,
    /// Bytes of the machine's table.
    pub table_bytes: usize,
}

/// Puts the machine into a bank, with a table of feet if its text has one. Errors are those of [`make`], and those of bytes that are no bank.
pub fn compile(source: &Source, file: &Text, bytes: &[u8]) -> Result<Compiled> {
    let opened = Bank::new_checked(bytes)?;
    let made = make(source, file, &opened)?;
    let mut whole = bank::with_section(&bank::without_section(bytes, FEET_SECTION)?, SECTION, &made.table)?;
    if let Some(feet) = &made.feet {
        whole = bank::with_section(&whole, FEET_SECTION, feet)?;
    }
    Ok(Compiled {
        bank: whole,
        warnings: made.warnings,
        clips: opened.len(),
        states: source.states.len(),
        transitions: source.transition_count(),
        table_bytes: made.table.len(),
    })
}
