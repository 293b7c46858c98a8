//! Makes the format's tables from coded motions: counts symbols, joins contexts that behave alike, rounds to 1/4096.

use pantin::codec::entropy::{SCALE_BITS, SIXTEENTH};
use pantin::codec::layout::{START_MODE, STATUS_CONTEXTS, STATUSES, status};
use pantin::codec::segment::{CONTEXTS, DIRECT_MODES, MODE_CONTEXTS};
use pantin_convert::encode::clip::{Coded, symbols};
use pantin_convert::encode::entropy::{Alphabet, Sink, sizes};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Tables of modes, and of numbers: with the rest they stay within 2 KiB of flash.
const MODE_TABLES: usize = 8;
const NUMBER_TABLES: usize = 16;
/// Tables of statuses.
const STATUS_TABLES: usize = 8;
/// How much a table of all contexts counts in each: a symbol never seen must still have a code.
const PRIOR: f64 = 12.0;

/// The part of channels that follow, by the status of the one before: faces have them, the motions to count are bodies'.
const FOLLOWING: [f64; STATUSES] = [1.0 / 128.0, 1.0 / 64.0, 1.0 / 32.0, 3.0 / 8.0];

/// How often each symbol came.
#[derive(Clone, Debug, Default)]
pub struct Counts {
    counts: BTreeMap<Alphabet, Vec<f64>>,
    weight: f64,
    /// Whether segments after the first are left out.
    starts: bool,
}

impl Sink for Counts {
    fn symbol(&mut self, alphabet: Alphabet, symbol: u32) {
        let first = Alphabet::Mode(START_MODE);
        if self.starts && alphabet != first && matches!(alphabet, Alphabet::Mode(_) | Alphabet::Number(_) | Alphabet::Far) {
            return;
        }
        let row = self.counts.entry(alphabet).or_insert_with(|| vec![0.0; sizes(alphabet.table()).count()]);
        row[symbol as usize] += self.weight;
    }

    fn bits(&mut self, _: u32, _: u32) {}
}

impl Counts {
    /// Adds a clip's symbols, each counted `weight` times.
    pub fn add(&mut self, coded: &Coded, rig: &pantin::Rig<'_>, weight: f64) {
        (self.weight, self.starts) = (weight, false);
        symbols(coded, rig, self);
    }

    /// Adds the symbols with which a clip's channels start.
    pub fn add_starts(&mut self, coded: &Coded, rig: &pantin::Rig<'_>, weight: f64) {
        (self.weight, self.starts) = (weight, true);
        symbols(coded, rig, self);
    }

    fn row(&self, alphabet: Alphabet) -> Vec<f64> {
        self.counts.get(&alphabet).cloned().unwrap_or_else(|| vec![0.0; sizes(alphabet.table()).count()])
    }

    /// The statuses in a context: those of the motions' channels, with a part that follow.
    fn status(&self, context: u8) -> Vec<f64> {
        let (last, of_kind) = (context >> 2 & 3, context & 3);
        let body = context & 16 | last.min(status::MOVES) << 2 | of_kind.min(status::MOVES);
        let mut row = self.row(Alphabet::Status(body));
        let part = FOLLOWING[usize::from(last)];
        row[usize::from(status::FOLLOWS)] = row.iter().sum::<f64>() * part / (1.0 - part);
        row
    }

    /// The text of `decoder/src/codec/tables.rs`.
    pub fn tables(&self, trained_on: &str) -> String {
        let modes = (0..MODE_CONTEXTS as u8).map(|after| self.row(Alphabet::Mode(after))).collect();
        let numbers = (0..CONTEXTS as u8).map(|context| self.row(Alphabet::Number(context))).collect();
        let (mut mode_after, mode) = join(modes, MODE_TABLES, &|i| if i >= DIRECT_MODES as usize { 0.002 } else { 0.01 });
        let number_prior = |i: usize| 0.5f64.powi(i.div_ceil(2) as i32).max(0.004);
        let (mut number_in, number) = join(numbers, NUMBER_TABLES, &number_prior);

        let trained_on: String = trained_on.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        let mut out = HEAD.replace("TRAINED_ON", &trained_on);
        let mut item = |doc: &str, name: &str, kind: String, value: String| {
            let _ = writeln!(out, "/// {doc}\n{name}: {kind} = {value};\n");
        };
        mode_after.resize(128, 0);
        item(
            "Which of [`MODE`] follows a mode; then that of second symbols.",
            "const MODE_AFTER",
            "[u8; 128]".into(),
            format!("{mode_after:?}"),
        );
        item(
            "Modes 0 to 31, then those of the other types together.",
            "static MODE",
            format!("[[u16; {}]; {}]", mode[0].len(), mode.len()),
            format!("{mode:?}"),
        );
        number_in.resize(128, 0);
        item("Which of [`NUMBER`] a context has.", "const NUMBER_IN", "[u8; 128]".into(), format!("{number_in:?}"));
        let doc = "Accelerations and slopes in their steps, by index of magnitude: 0, -1, 1, -2, ...";
        item(doc, "static NUMBER", format!("[[u16; {}]; {}]", number[0].len(), number.len()), format!("{number:?}"));
        let statuses = (0..STATUS_CONTEXTS as u8).map(|context| self.status(context)).collect();
        let (status_in, status) = join(statuses, STATUS_TABLES, &|_| 0.1);
        let doc = "Which of [`STATUS`] a context has.";
        item(doc, "const STATUS_IN", format!("[u8; {STATUS_CONTEXTS}]"), format!("{status_in:?}"));
        let doc = "Rest, constant, moving, following.";
        item(doc, "static STATUS", format!("[[u16; {STATUSES}]; {STATUS_TABLES}]"), format!("{status:?}"));
        let bell = |i: usize| 0.8f64.powi((i as i32 - 6).abs()).max(0.01);
        for (alphabet, name, doc, prior) in [
            (
                Alphabet::StepChange,
                "STEP_CHANGE",
                "By how much a channel's step index differs from the last one's: 0, -1, 1, ...",
                &number_prior as Prior,
            ),
            (Alphabet::Position, "POSITION", "Bits of a first position, in half channel steps.", &bell),
            (Alphabet::Velocity, "VELOCITY", "Bits of a first velocity, in quarter channel steps.", &bell),
            (Alphabet::Far, "FAR", "Bits of a number beyond all groups.", &|i: usize| 0.8f64.powi((i as i32 - 8).abs())),
        ] {
            let table = rounded(&self.row(alphabet), prior);
            item(doc, &format!("pub static {name}"), format!("[u16; {}]", table.len()), format!("{table:?}"));
        }
        out + TAIL
    }
}

type Prior<'p> = &'p dyn Fn(usize) -> f64;

/// A table as the decoder has it.
type Entries = Vec<u16>;

/// Joins the rows that cost least to join until `tables` are left: which table each row has, and the tables.
fn join(rows: Vec<Vec<f64>>, tables: usize, prior: Prior<'_>) -> (Vec<usize>, Vec<Entries>) {
    let mut groups: Vec<(Vec<usize>, Vec<f64>)> = rows.into_iter().enumerate().map(|(i, row)| (vec![i], row)).collect();
    let contexts = groups.len();
    while groups.len() > tables {
        let mut best = (f64::MAX, 0, 0);
        for a in 0..groups.len() {
            for b in a + 1..groups.len() {
                let sum: Vec<f64> = groups[a].1.iter().zip(&groups[b].1).map(|(x, y)| x + y).collect();
                let cost = bits(&sum, prior) - bits(&groups[a].1, prior) - bits(&groups[b].1, prior);
                if cost < best.0 {
                    best = (cost, a, b);
                }
            }
        }
        let (members, row) = groups.swap_remove(best.2);
        let kept = &mut groups[best.1];
        kept.0.extend(members);
        kept.1.iter_mut().zip(row).for_each(|(x, y)| *x += y);
    }
    let mut of = vec![0; contexts];
    for (table, (members, _)) in groups.iter().enumerate() {
        members.iter().for_each(|&member| of[member] = table);
    }
    (of, groups.iter().map(|(_, row)| rounded(row, prior)).collect())
}

fn smoothed(row: &[f64], prior: Prior<'_>) -> Vec<f64> {
    let whole: f64 = (0..row.len()).map(prior).sum();
    let total: f64 = row.iter().sum::<f64>() + PRIOR;
    row.iter().enumerate().map(|(i, count)| (count + PRIOR * prior(i) / whole) / total).collect()
}

/// Bits that the row's symbols take under its own statistics.
fn bits(row: &[f64], prior: Prior<'_>) -> f64 {
    smoothed(row, prior).iter().zip(row).map(|(p, count)| -count * p.log2()).sum()
}

/// The table of probabilities in 1/4096; every symbol has at least 1.
fn rounded(row: &[f64], prior: Prior<'_>) -> Entries {
    let whole = 1 << SCALE_BITS;
    let parts = smoothed(row, prior);
    let mut sizes: Vec<i32> = parts.iter().map(|p| ((p * f64::from(whole)).round() as i32).max(1)).collect();
    while sizes.iter().sum::<i32>() != whole {
        let change = (whole - sizes.iter().sum::<i32>()).signum();
        // The symbol whose size is farthest from its part, on the side that the change mends.
        let off = |i: usize| f64::from(change) * (parts[i] * f64::from(whole) - f64::from(sizes[i]));
        let allowed = |&i: &usize| sizes[i] + change >= 1;
        let Some(at) = (0..sizes.len()).filter(allowed).max_by(|&a, &b| off(a).total_cmp(&off(b))) else { break };
        sizes[at] += change;
    }
    let starts = sizes.iter().scan(0, |sum, &size| Some(std::mem::replace(sum, *sum + size as u32)));
    let starts: Vec<u32> = starts.collect();
    let holding = |low: u32| starts.iter().filter(|&&start| start <= low).count() as u32 - 1;
    let hint = |i: u32| if i < 16 { holding(i << SIXTEENTH).min(15) << SCALE_BITS } else { 0 };
    starts.iter().zip(0..).map(|(start, i)| (start | hint(i)) as u16).collect()
}

const HEAD: &str = "//! Statistics of motion, frozen with the format: made by `cargo xtask train`, not by hand.
//!
//! TRAINED_ON
//!
//! A table lists an alphabet's cumulative probabilities, as [`Table`] says.

use crate::entropy::Table;

";

const TAIL: &str = "/// The modes' table after a segment of this mode.
#[inline(always)]
pub fn mode(after: u8) -> &'static Table {
    &MODE[usize::from(MODE_AFTER[usize::from(after & 127)] & 7)]
}

/// The numbers' table in this context.
#[inline(always)]
pub fn number(context: u8) -> &'static Table {
    &NUMBER[usize::from(NUMBER_IN[usize::from(context & 127)] & 15)]
}

/// The table of a channel's status in this context.
pub fn status(context: u8) -> &'static Table {
    &STATUS[usize::from(STATUS_IN[usize::from(context & 31)] & 7)]
}
";
