//! `cargo xtask independent [--random N] [--seed N] [--only TEXT] [--verbose]`: every captured clip and many random motions with all kinds of bounds, evaluated by a
//! program that shares no code with the tool.
//!
//! ```text
//! $ cargo xtask independent
//! | bound | clips | refused | frames | joint frames | maps | quaternions | place | shell | rotation | joint | printed: cm | degrees |
//! ...
//! no bound is broken, and every printed error is right
//! ```
//!
//! `place` to `joint` are the greatest errors as parts of their bounds; the last two columns are the greatest differences between the errors that the tool printed
//! and those that were found.

use anyhow::{Context, Result, ensure};
use clap::Args;
use harness::{independent, paths};

/// Evaluates clips with readers, a decoder and kinematics that share no code with the tool; needs Node.js
#[derive(Args)]
pub struct Independent {
    /// Number of random motions
    #[arg(long, default_value_t = 2000)]
    random: usize,
    /// Selects which random motions are made
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Only captured motions whose file names contain this
    #[arg(long, default_value = "")]
    only: String,
    /// Print the errors of every clip
    #[arg(long)]
    verbose: bool,
}

impl Independent {
    /// Runs it; an error if a bound is broken or a printed error is wrong.
    pub fn run(self) -> Result<()> {
        let mut evaluator = independent::command(self.random, self.seed)?;
        if let Some(captures) = paths::data() {
            evaluator.arg("--captures").arg(captures).args(["--only", &self.only]);
        }
        if self.verbose {
            evaluator.arg("--verbose");
        }
        let status = evaluator.status().context("cannot start Node.js")?;
        ensure!(status.success(), "the evaluator found faults");
        Ok(())
    }
}
