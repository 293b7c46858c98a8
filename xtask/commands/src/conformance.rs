//! `cargo xtask conformance`: every golden vector on every core.
//!
//! ```text
//! $ cargo xtask conformance
//! core         machine                 vectors  poses   seconds
//! this host    x86_64                       27    ...      0.00  agrees
//! Cortex-M0    microbit                     27    ...      0.15  agrees
//! ...
//! ```

use anyhow::{Result, bail};
use clap::Args;
use harness::conformance::{CORES, Expected, Place};

use xtask::steps::say;

/// Plays the golden vectors on every core, and compares the CRC of every pose
#[derive(Args)]
pub struct Conformance {}

impl Conformance {
    /// Prints a line a core; an error if one differs or could not run.
    pub fn run(self) -> Result<()> {
        let expected = Expected::load()?;
        say(&format!("{:<12} {:<16} {:>8} {:>6} {:>9}", "core", "machine", "vectors", "poses", "seconds"));
        let mut failed = 0;
        for (core, place) in CORES {
            let machine = match place {
                Place::Host => std::env::consts::ARCH,
                Place::Emulated(machine) => machine.name,
                Place::Pico => "rp2040js",
                Place::Node => "node",
            };
            match expected.check(place) {
                Ok(agreed) => say(&format!(
                    "{core:<12} {machine:<16} {:>8} {:>6} {:>9.2}  agrees",
                    agreed.vectors,
                    agreed.poses,
                    agreed.time.as_secs_f64()
                )),
                Err(error) => {
                    failed += 1;
                    say(&format!("{core:<12} {machine:<16} {:>8} {:>6} {:>9}  FAILED: {error:#}", "", "", ""));
                }
            }
        }
        if failed > 0 {
            bail!("{failed} of {} cores failed", CORES.len());
        }
        Ok(())
    }
}
