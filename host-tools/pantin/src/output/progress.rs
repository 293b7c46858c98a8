//! Bars that show how far a command is.

use super::report::{is_json, is_quiet};
use anyhow::Result;
use indicatif::{HumanDuration, ProgressBar, ProgressFinish, ProgressState, ProgressStyle, WeakProgressBar};
use std::fmt::Write;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// How often a bar is drawn while nothing is done: its times go on.
const TICK: Duration = Duration::from_millis(200);
/// Steps of a bar for one piece of work.
const STEPS: u64 = 1000;
/// The bar that was begun last.
static LAST: Mutex<Option<WeakProgressBar>> = Mutex::new(None);

/// A bar that shows how far the command is, with the time that is left; hidden under `-q` and `--json`. `template` is indicatif's; before
/// anything is done, its `eta` is a question mark.
pub fn progress(length: u64, template: &str) -> Result<ProgressBar> {
    if is_quiet() || is_json() {
        return Ok(ProgressBar::hidden());
    }
    let left = |state: &ProgressState, out: &mut dyn Write| {
        // A line that cannot be formatted is not drawn.
        let _ = match state.pos() {
            0 => write!(out, "? s"),
            _ => write!(out, "{:#}", HumanDuration(state.eta())),
        };
    };
    let bar = ProgressBar::new(length).with_finish(ProgressFinish::AndClear);
    bar.set_style(ProgressStyle::with_template(template)?.with_key("eta", left));
    *LAST.lock().unwrap_or_else(PoisonError::into_inner) = Some(bar.downgrade());
    bar.tick();
    bar.enable_steady_tick(TICK);
    Ok(bar)
}

/// Calls `print`, which writes a line to the terminal, without the bar on it.
pub(super) fn without_bar(print: impl FnOnce()) {
    let last = LAST.lock().unwrap_or_else(PoisonError::into_inner).as_ref().and_then(WeakProgressBar::upgrade);
    match last.filter(|bar| !bar.is_finished()) {
        Some(bar) => bar.suspend(print),
        None => print(),
    }
}

/// A bar for several pieces of work, which moves while each of them goes on.
pub struct Pieces {
    bar: ProgressBar,
    count: usize,
    ended: AtomicU64,
    what: &'static str,
}

/// One of the pieces. It has ended when it is dropped, whether it failed or not.
pub struct Piece<'p> {
    of: &'p Pieces,
    done: AtomicU64,
}

impl Pieces {
    /// A bar for `count` pieces, which are called `what`: "files".
    pub fn new(count: usize, what: &'static str) -> Result<Pieces> {
        let bar = progress(STEPS * count as u64, "{wide_bar} {msg} {eta} left")?;
        let pieces = Pieces { bar, count, ended: AtomicU64::new(0), what };
        pieces.say(0);
        Ok(pieces)
    }

    /// Begins a piece.
    pub fn begin(&self) -> Piece<'_> {
        Piece { of: self, done: AtomicU64::new(0) }
    }

    /// Clears the bar.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }

    fn say(&self, ended: u64) {
        self.bar.set_message(format!("{ended} of {} {}", self.count, self.what));
    }
}

impl Piece<'_> {
    /// Moves the bar: `part` of this piece is done, from 0 to 1.
    pub fn set(&self, part: f64) {
        let now = (part.clamp(0.0, 1.0) * STEPS as f64) as u64;
        let before = self.done.fetch_max(now, Ordering::Relaxed);
        self.of.bar.inc(now.saturating_sub(before));
    }
}

impl Drop for Piece<'_> {
    fn drop(&mut self) {
        self.set(1.0);
        self.of.say(self.of.ended.fetch_add(1, Ordering::Relaxed) + 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_moves_within_its_pieces() {
        let pieces = Pieces::new(2, "files").unwrap();
        let (first, second) = (pieces.begin(), pieces.begin());
        first.set(0.25);
        second.set(0.5);
        // A part that was reported late moves nothing back.
        first.set(0.1);
        assert_eq!(pieces.bar.position(), 750);
        drop(first);
        assert_eq!(pieces.bar.position(), 1500);
        assert_eq!(pieces.bar.message(), "1 of 2 files");
        drop(second);
        assert_eq!((pieces.bar.position(), pieces.bar.length()), (2000, Some(2000)));
    }
}
