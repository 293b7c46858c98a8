//! Steps of a command: each announced, timed, and listed at the end.

use std::io::{IsTerminal, Write};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use anyhow::{Result, bail};

/// The steps done so far; threads may run steps side by side.
#[derive(Default)]
pub struct Steps {
    done: Mutex<Vec<Done>>,
}

struct Done {
    name: String,
    time: Duration,
    failure: Option<String>,
}

impl Steps {
    /// Runs a step; a failure is printed at once and remembered, and the next step may run.
    pub fn run(&self, name: &str, step: impl FnOnce() -> Result<()>) {
        say(&format!("== {name}"));
        let start = Instant::now();
        let failure = step().err().map(|error| format!("{error:#}"));
        let time = start.elapsed();
        let failed = failure.as_ref().map_or(String::new(), |failure| format!(", FAILED: {failure}"));
        say(&format!("   {:.1} s: {name}{failed}", time.as_secs_f64()));
        let done = Done { name: name.to_owned(), time, failure };
        self.done.lock().unwrap_or_else(PoisonError::into_inner).push(done);
    }

    /// Prints every step with its time; an error if one failed.
    pub fn finish(self) -> Result<()> {
        let done = self.done.into_inner().unwrap_or_else(PoisonError::into_inner);
        println!("\n{:<52} {:>8}", "step", "seconds");
        for Done { name, time, failure } in &done {
            let failed = failure.as_ref().map_or(String::new(), |failure| format!("  FAILED: {failure}"));
            println!("{name:<52} {:>8.1}{failed}", time.as_secs_f64());
        }
        if let Some(seconds) = processor_seconds() {
            println!("{:<52} {seconds:>8.0}", "processor time of all programs that were started");
        }
        match done.iter().filter(|done| done.failure.is_some()).count() {
            0 => Ok(()),
            failed => bail!("{failed} of {} steps failed", done.len()),
        }
    }
}

/// Processor time that child processes have taken, user and system, in seconds; `None` where the system does not say.
pub fn processor_seconds() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    // Fields 16 and 17, in ticks of 10 ms; the name in field 2 may hold blanks.
    let mut fields = stat.rsplit_once(')')?.1.split_whitespace().skip(13);
    let mut ticks = || fields.next()?.parse::<f64>().ok();
    Some((ticks()? + ticks()?) / 100.0)
}

/// Prints a line at once, in order with what child processes print.
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
