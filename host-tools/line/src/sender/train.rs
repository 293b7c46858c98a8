//! Makes `tables.rs`.

use super::refresh::{ScheduledMessage, round};
use super::source::Source;
use pantin::Clip;
use pantin_link::Message;
use pantin_link::tables;
use pantin_link::wire::{Coder, Table};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Counts symbols by table.
#[derive(Default)]
struct Counts(BTreeMap<usize, Vec<f64>>);

impl Coder for Counts {
    fn symbol(&mut self, table: &Table, symbol: u32) -> u32 {
        self.0.entry(table.as_ptr() as usize).or_insert_with(|| vec![0.0; table.len()])[symbol as usize] += 1.0;
        symbol
    }

    fn few_bits(&mut self, _: u32, value: u32) -> u32 {
        value
    }
}

fn count(told: &[ScheduledMessage], counts: &mut Counts) {
    let mut at = (0, 0);
    for (index, ScheduledMessage { frame, channel, message }) in told.iter().enumerate() {
        // About what a packet holds.
        if index % 24 == 0 {
            counts.symbol(&tables::PLACE, pantin_link::wire::END);
            at = (*frame, 0);
        }
        for _ in at.0..*frame {
            counts.symbol(&tables::PLACE, pantin_link::wire::FRAME);
            at.1 = 0;
        }
        let passed = u32::from(channel - at.1);
        (0..passed / 30).for_each(|_| {
            counts.symbol(&tables::PLACE, pantin_link::wire::PASS);
        });
        counts.symbol(&tables::PLACE, passed % 30);
        at = (*frame, channel + 1);
        Message::code(message, counts);
    }
}

/// Sizes in 2^-12, with something for what was never seen.
fn sizes(row: &[f64], prior: impl Fn(usize) -> f64) -> Vec<u16> {
    let total: f64 = row.iter().sum::<f64>().max(1.0);
    let parts: Vec<f64> = row.iter().enumerate().map(|(i, x)| 0.98 * x / total + 0.02 * prior(i)).collect();
    let whole: f64 = parts.iter().sum();
    let room = 4096.0 - parts.len() as f64;
    let mut sizes: Vec<u16> = parts.iter().map(|x| 1 + (x / whole * room) as u16).collect();
    let left = 4096 - sizes.iter().sum::<u16>();
    let most = (0..sizes.len()).max_by_key(|&i| sizes[i]).expect("a symbol");
    sizes[most] += left;
    sizes
}

#[test]
#[ignore = "prints tables.rs: PANTIN_TRAIN=A.ptn,B.ptn cargo test -p pantin-line sender::train -- --ignored --nocapture"]
fn train() {
    let mut counts = Counts::default();
    for path in std::env::var("PANTIN_TRAIN").expect("PANTIN_TRAIN").split(',') {
        let bytes = std::fs::read(path).expect(path);
        let source = Source::new(&Clip::new_checked(&bytes).expect(path)).expect(path);
        for cycle in [14, 28, 28] {
            count(&round(&source, cycle), &mut counts);
        }
    }
    let mut out = String::new();
    let mut row = |name: &str, doc: &str, tables: &[&'static Table]| {
        let bell = |i: usize| 0.75f64.powi((i as i32 - 6).abs());
        let rows: Vec<Vec<u16>> = tables
            .iter()
            .map(|table| sizes(&counts.0.get(&(table.as_ptr() as usize)).cloned().unwrap_or(vec![0.0; table.len()]), bell))
            .collect();
        let (kind, value) = match &rows[..] {
            [row] => (format!("[u16; {}]", row.len()), format!("{row:?}")),
            rows => (format!("[[u16; {}]; {}]", rows[0].len(), rows.len()), format!("{rows:?}")),
        };
        let _ = writeln!(out, "/// {doc}\npub static {name}: {kind} = {value};\n");
    };
    row("FLAGS", "Neither, refresh, cut, both.", &[&tables::FLAGS]);
    row("PLACE", "Channels passed over, or what stands instead of a channel.", &[&tables::PLACE]);
    row("MODE", "Modes.", &[&tables::MODE]);
    let classes: Vec<&'static Table> = (0..4).map(tables::acceleration).collect();
    row("ACCELERATION", "Accelerations by class of lengths.", &classes);
    row("SLOPE", "Slopes.", &[&tables::SLOPE]);
    row("P", "Bits of a refresh's position.", &[&tables::P]);
    row("V", "Bits of its velocity.", &[&tables::V]);
    row("W", "Bits of its acceleration.", &[&tables::W]);
    println!("{out}");
}
