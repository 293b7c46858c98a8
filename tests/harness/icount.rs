//! Guest instructions a marked region, counted by the plugin in `tests/icount-plugin`.
//!
//! A program marks a region with one instruction before and one after: `mov r9, r9` and `mov r10, r10` on ARM,
//! `slti x0, x0, 0x101` and `slti x0, x0, 0x102` on RISC-V. The markers themselves are not counted; an interrupt
//! taken inside a region is. Instructions are not cycles: QEMU knows no flash wait, cache or multiply cost.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};

use crate::build;
use crate::setup;

/// The regions of a frame, in the order in which the firmware passes them.
pub const FRAME_REGIONS: [&str; 4] = ["decode", "kinematics", "draw", "flush"];

/// Instructions over all regions of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stats {
    /// Number of regions.
    pub regions: usize,
    /// Sum of their instructions.
    pub total: u64,
    /// Fewest instructions of a region.
    pub least: u64,
    /// Most instructions of a region.
    pub most: u64,
    /// Which region of this kind, from 0, took the most.
    pub worst: usize,
}

impl Stats {
    /// Of the counts of one kind of region; `None` where there are none.
    pub fn of(counts: impl IntoIterator<Item = u64>) -> Option<Self> {
        let mut counts = counts.into_iter();
        let first = counts.next()?;
        let mut stats = Self { regions: 1, total: first, least: first, most: first, worst: 0 };
        for count in counts {
            if count > stats.most {
                (stats.most, stats.worst) = (count, stats.regions);
            }
            stats.regions += 1;
            stats.total += count;
            stats.least = stats.least.min(count);
        }
        Some(stats)
    }

    /// Instructions a region.
    pub fn mean(&self) -> f64 {
        self.total as f64 / self.regions as f64
    }
}

/// Every region's instructions in the order of execution, from the file that a run left.
pub fn read(counts: &Path) -> Result<Vec<u64>> {
    let text = std::fs::read_to_string(counts).with_context(|| format!("no counts at {}", counts.display()))?;
    let number = |(index, line): (usize, &str)| match line {
        "unbalanced" => bail!("region {index} was opened twice or closed twice"),
        line => line.parse().with_context(|| format!("{}:{}: not a count", counts.display(), index + 1)),
    };
    text.lines().enumerate().map(number).collect()
}

/// Splits counts into `kinds` kinds, which the program passes in turn.
pub fn by_kind(counts: &[u64], kinds: usize) -> Result<Vec<Stats>> {
    ensure!(kinds > 0 && !counts.is_empty(), "no marked region was passed");
    ensure!(counts.len().is_multiple_of(kinds), "{} regions are not rounds of {kinds}", counts.len());
    Ok((0..kinds).filter_map(|kind| Stats::of(counts.iter().skip(kind).step_by(kinds).copied())).collect())
}

/// Builds the plugin for the given QEMU and returns where it lies.
pub fn plugin(emulator: &str) -> Result<PathBuf> {
    let version = setup::version(emulator)?;
    // The interface's versions 2 and 3 refuse older plugins: QEMU 9.0 and 9.1.
    let interface = match version {
        (..=8, _) => "1",
        (9, 0) => "2",
        _ => "3",
    };
    build::cargo(&build::Build {
        workspace: crate::paths::root(),
        arguments: vec!["--release".into(), "--package".into(), "icount-plugin".into()],
        environment: vec![("QEMU_PLUGIN_API".into(), interface.into())],
        product: "icount_plugin".into(),
        ..build::Build::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_split_into_their_kinds_in_turn() {
        let stats = by_kind(&[5, 100, 9, 90, 9, 80], 2).unwrap();
        assert_eq!(stats[0], Stats { regions: 3, total: 23, least: 5, most: 9, worst: 1 });
        assert_eq!(stats[1], Stats { regions: 3, total: 270, least: 80, most: 100, worst: 0 });
        assert_eq!(stats[1].mean(), 90.0);
    }

    #[test]
    fn an_unfinished_round_is_refused() {
        assert!(by_kind(&[5, 100, 9], 2).is_err());
        assert!(by_kind(&[], 2).is_err());
    }
}
