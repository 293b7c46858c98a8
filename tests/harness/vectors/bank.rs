//! The vector of a bank: clips of one rig, and what a decoder must make of each.

use anyhow::{Context, Result};
use pantin::Bank;
use pantin::codec::layout::section;
use pantin_convert::bank::{self, Named};
use serde_json::{Value, json};

use super::{json, record, synthetic};

/// The name of its files.
pub const NAME: &str = "bank";

/// A type of section that no decoder knows.
const UNKNOWN: u8 = 0xc8;

/// The bank's file: clips of several lengths, one of them with snapshots and named events, before and behind a section of an unknown type.
pub fn bytes() -> Result<Vec<u8>> {
    let clips: Vec<Named> = synthetic::in_bank()
        .into_iter()
        .map(|made| {
            let (name, rig) = (made.name.to_string(), pantin_convert::encode::rig::encode(&made.rig)?);
            Ok(Named { place: name.clone(), name, clip: made.vector()?.clip, rig: rig.into() })
        })
        .collect::<Result<_>>()?;
    let mut bytes = bank::encode(&clips)?;
    assert_eq!(bytes[3], section::RIG);
    bytes.splice(3..3, [UNKNOWN, 2, 0xff, 0xff]);
    bytes.extend([UNKNOWN, 0]);
    Ok(bytes)
}

/// The text of its record.
pub fn record(bytes: &[u8]) -> Result<String> {
    let bank = Bank::new_checked(bytes).context("the vector of a bank does not open")?;
    let clip = |entry: pantin::BankEntry| -> Result<Value> {
        let clip = bank.open(&entry)?;
        let crcs: Vec<String> = record::crcs(&clip)?.stepped.iter().map(|crc| format!("{crc:04x}")).collect();
        Ok(json!([entry.name(), entry.bytes().len(), clip.frames(), clip.looped(), crcs]))
    };
    let clips = bank.entries().map(clip).collect::<Result<Vec<Value>>>()?;
    Ok(json::text(&[("joints", json!(bank.rig().joint_count())), ("clips", json!(clips))]))
}
