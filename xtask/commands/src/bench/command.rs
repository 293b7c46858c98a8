//! `cargo xtask bench [PART...] [--quick] [--write]`: measures the project's numbers.
//!
//! ```text
//! $ cargo xtask bench paper
//! == paper
//! motion  bound   frames  moving  per-frame bytes  bytes   saved  the paper's
//! walk    0.5 cm     160      21             6720    ...
//! ```
//! Parts that need motion clips read them from `$PANTIN_DATA`; without clips they print that they are skipped.

use anyhow::Result;
use clap::{Args, ValueEnum};

use crate::bench::{self, Part, Setting};
use xtask::steps::{Steps, say};

/// Measures size, speed and memory, and compares them with the goals.
#[derive(Args)]
pub struct Bench {
    /// What to measure [default: everything]
    #[arg(value_enum)]
    parts: Vec<Part>,
    /// Four clips of a few seconds instead of all
    #[arg(long)]
    quick: bool,
    /// Only reference clips whose name contains this
    #[arg(long)]
    only: Option<String>,
    /// Write docs/BENCHMARKS.md from the last full run of every part
    #[arg(long)]
    write: bool,
}

impl Bench {
    /// Runs the parts, failed ones too, and lists what they measured.
    pub fn run(self) -> Result<()> {
        let parts = if self.parts.is_empty() { Part::value_variants().to_vec() } else { self.parts };
        let full = !self.quick && self.only.is_none();
        say("building the host tool");
        let setting = Setting::new(self.quick, self.only)?;
        let (steps, mut all) = (Steps::default(), vec![]);
        for part in parts {
            steps.run(&part.name(), || {
                let goals = part.run(&setting)?;
                if full {
                    bench::store(&setting.out, part, &goals)?;
                }
                all.extend(goals);
                Ok(())
            });
        }
        println!();
        bench::print(&all);
        steps.finish()?;
        if self.write { bench::write(&setting.out) } else { Ok(()) }
    }
}
