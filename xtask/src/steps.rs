//! Steps of a command: each announced, timed, and listed at the end.

use std::io::{IsTerminal, Write};
use std::time::{Duration, Instant};

use anyhow::{Result, bail};

/// The steps done so far.
#[derive(Default)]
pub struct Steps {
    done: Vec<(String, Duration, Option<String>)>,
}

impl Steps {
    /// Runs a step; a failure is printed at once and remembered, and the next step may run.
    pub fn run(&mut self, name: &str, step: impl FnOnce() -> Result<()>) {
        say(&format!("== {name}"));
        let start = Instant::now();
        let failure = step().err().map(|error| format!("{error:#}"));
        let time = start.elapsed();
        match &failure {
            None => say(&format!("   {:.1} s", time.as_secs_f64())),
            Some(failure) => say(&format!("   {:.1} s, FAILED: {failure}", time.as_secs_f64())),
        }
        self.done.push((name.to_owned(), time, failure));
    }

    /// Prints every step with its time; an error if one failed.
    pub fn finish(self) -> Result<()> {
        println!("\n{:<44} {:>8}", "step", "seconds");
        for (name, time, failure) in &self.done {
            let failed = failure.as_ref().map_or(String::new(), |failure| format!("  FAILED: {failure}"));
            println!("{name:<44} {:>8.1}{failed}", time.as_secs_f64());
        }
        match self.done.iter().filter(|(_, _, failure)| failure.is_some()).count() {
            0 => Ok(()),
            failed => bail!("{failed} of {} steps failed", self.done.len()),
        }
    }
}

/// Says something at once, in order with what child processes say.
pub fn say(line: &str) {
    println!("{line}");
    let _ = std::io::stdout().flush();
}

/// Shows how far a long step is: on a terminal in place, else at each quarter.
pub fn progress(what: &str, done: usize, total: usize) {
    if std::io::stdout().is_terminal() {
        print!("\r   {what} {done}/{total}{}", if done == total { "\n" } else { "" });
        let _ = std::io::stdout().flush();
    } else if 4 * done / total.max(1) != 4 * done.saturating_sub(1) / total.max(1) {
        say(&format!("   {what} {done}/{total}"));
    }
}
