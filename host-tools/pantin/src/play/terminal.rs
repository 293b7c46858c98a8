//! The terminal, as it was before once all is over: on return, error, panic or signal.

use super::cells::{Cell, Grid};
use super::colours::Colours;
use anyhow::{Context, Result};
use crossterm::cursor::{Hide, MoveTo, Show};
use crossterm::style::{Print, ResetColor, SetBackgroundColor, SetForegroundColor};
use crossterm::terminal::{
    BeginSynchronizedUpdate, Clear, ClearType, DisableLineWrap, EnableLineWrap, EndSynchronizedUpdate, EnterAlternateScreen,
    LeaveAlternateScreen, disable_raw_mode, enable_raw_mode,
};
use crossterm::{execute, queue, terminal};
use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};
#[cfg(unix)]
use std::time::Duration;

/// Columns and rows that are used at most, whatever size a terminal claims.
const LARGEST: [usize; 2] = [1000, 500];

/// The time that a terminal has to take what restores it, after a signal: one that stopped reading never takes it.
#[cfg(unix)]
const RESTORE_TIME: Duration = Duration::from_secs(1);

/// Whether it has to be restored.
static ENTERED: AtomicBool = AtomicBool::new(false);

/// The terminal while something plays in it.
pub struct Terminal {
    colours: Colours,
    shown: Option<Grid>,
}

impl Terminal {
    /// Takes it over.
    pub fn enter(colours: Colours) -> Result<Terminal> {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            restore();
            before(panic);
        }));
        #[cfg(unix)]
        leave_by_signals()?;
        enable_raw_mode().context("the terminal cannot be set up")?;
        ENTERED.store(true, Ordering::SeqCst);
        let terminal = Terminal { colours, shown: None };
        execute!(io::stdout(), EnterAlternateScreen, Hide, DisableLineWrap)?;
        Ok(terminal)
    }

    /// Columns and rows.
    pub fn size(&self) -> Result<[usize; 2]> {
        let (columns, rows) = terminal::size().context("the terminal's size is not known")?;
        Ok([usize::from(columns).min(LARGEST[0]), usize::from(rows).min(LARGEST[1])])
    }

    /// Forgets what it shows: after a resize nobody knows.
    pub fn forget(&mut self) {
        self.shown = None;
    }

    /// Shows a grid, by what is different from the one before.
    pub fn show(&mut self, grid: Grid) -> Result<()> {
        let out = changes(self.shown.as_ref(), &grid, self.colours)?;
        let mut stdout = io::stdout().lock();
        stdout.write_all(&out).and_then(|()| stdout.flush()).context("the terminal is gone")?;
        self.shown = Some(grid);
        Ok(())
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        restore();
    }
}

/// Restores the terminal and ends the program when a signal comes. By a thread of its own: waiting for a key does not end where the
/// terminal is gone. A terminal that takes no output within [`RESTORE_TIME`] gets only its modes back.
#[cfg(unix)]
fn leave_by_signals() -> Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM};
    let mut signals = signal_hook::iterator::Signals::new([SIGHUP, SIGINT, SIGQUIT, SIGTERM])?;
    std::thread::spawn(move || {
        if let Some(signal) = signals.forever().next() {
            std::thread::spawn(move || {
                // Held to the end, so that no picture follows.
                let _held = io::stdout().lock();
                restore();
                std::process::exit(128 + signal);
            });
            std::thread::sleep(RESTORE_TIME);
            // Modes are set without output.
            let _ = disable_raw_mode();
            signal_hook::low_level::exit(128 + signal);
        }
    });
    Ok(())
}

fn restore() {
    if ENTERED.swap(false, Ordering::SeqCst) {
        // Nobody is left to read an error.
        let _ = execute!(io::stdout(), ResetColor, EnableLineWrap, Show, LeaveAlternateScreen);
        let _ = disable_raw_mode();
    }
}

/// What a terminal that shows `before` must be sent to show `grid`.
fn changes(before: Option<&Grid>, grid: &Grid, colours: Colours) -> Result<Vec<u8>> {
    let mut out = Vec::new();
    queue!(out, BeginSynchronizedUpdate)?;
    let before = before.filter(|before| before.columns == grid.columns && before.cells.len() == grid.cells.len());
    if before.is_none() {
        queue!(out, ResetColor, Clear(ClearType::All))?;
    }
    let mut pen = Pen { colours, place: None, ink: None, paper: None };
    for (index, cell) in grid.cells.iter().enumerate() {
        if before.is_none_or(|before| before.cells[index] != *cell) {
            pen.write(&mut out, [index % grid.columns, index / grid.columns], cell)?;
        }
    }
    queue!(out, EndSynchronizedUpdate)?;
    Ok(out)
}

/// Where the terminal's cursor is, and its colours.
struct Pen {
    colours: Colours,
    place: Option<[usize; 2]>,
    ink: Option<crossterm::style::Color>,
    paper: Option<crossterm::style::Color>,
}

impl Pen {
    fn write(&mut self, out: &mut Vec<u8>, [column, row]: [usize; 2], cell: &Cell) -> Result<()> {
        if self.place != Some([column, row]) {
            queue!(out, MoveTo(column as u16, row as u16))?;
        }
        let (ink, paper) = (self.colours.of(cell.ink), self.colours.of(cell.paper));
        if let Some(paper) = paper.filter(|_| self.paper != paper) {
            queue!(out, SetBackgroundColor(paper))?;
            self.paper = Some(paper);
        }
        // Blanks have no ink.
        if let Some(ink) = ink.filter(|_| cell.letter != ' ' && self.ink != ink) {
            queue!(out, SetForegroundColor(ink))?;
            self.ink = Some(ink);
        }
        queue!(out, Print(cell.letter))?;
        self.place = Some([column + 1, row]);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pantin_images::palette::Palette;

    #[test]
    fn what_is_the_same_is_not_sent_again() {
        let before = Grid::new(10, 3, &Palette::default());
        let mut after = before.clone();
        after.write_text(4, 1, "ab", [255, 0, 0], [0; 3]);
        let text = |before, after: &Grid, colours| String::from_utf8(changes(before, after, colours).unwrap()).unwrap();
        let some = text(Some(&before), &after, Colours::All);
        assert_eq!(some.matches("\u{1b}[2;5H").count(), 1, "{some:?}");
        assert!(some.contains("38;2;255;0;0m") && some.contains("ab") && !some.contains("  "), "{some:?}");
        let none = text(Some(&after), &after, Colours::All);
        assert!(!none.contains('H') && !none.contains('m'), "{none:?}");
        let whole = text(None, &after, Colours::None);
        assert!(whole.contains("\u{1b}[2J") && !whole.contains("38;"), "{whole:?}");
    }
}
