//! One clip in a grid of cells: what fills it, and the status line below.

use super::cells::Grid;
use super::keys::HELP;
use super::play_time::PlayTime;
use super::settings::Settings;
use anyhow::Result;

/// Shows a clip's frames.
pub trait Show {
    /// Fills the grid's first `rows` with a frame.
    fn draw(&mut self, frame: u32, settings: &Settings, grid: &mut Grid, rows: usize) -> Result<()>;

    /// Whether the view is of use.
    fn has_views(&self) -> bool;
}

/// A clip as the status line names it.
pub struct Title {
    /// The file's name.
    pub name: String,
    /// Which clip of how many, counted from 0.
    pub place: [usize; 2],
    /// Its frames.
    pub frames: u32,
    /// Seconds of a frame.
    pub frame_time: f64,
}

impl Title {
    /// The status line.
    pub fn status(&self, frame: u32, clock: &PlayTime, settings: &Settings, views: bool) -> String {
        let [index, count] = self.place;
        let place = if count > 1 { format!("{}/{count} ", index + 1) } else { String::new() };
        let seconds = f64::from(frame) * self.frame_time;
        let mut line = format!(" {place}{}  frame {frame}/{}  {seconds:.2} s  {}", self.name, self.frames, clock.speed());
        if views {
            line += &format!("  {}", settings.view_words());
        }
        for word in [("reverse", clock.reversed()), ("paused", clock.paused())] {
            line += &if word.1 { format!("  {}", word.0) } else { String::new() };
        }
        line
    }
}

/// The help in lines that fit beside the left margin, each of whole entries.
fn help_lines(columns: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for entry in HELP.split("  ") {
        match lines.last_mut().filter(|line| line.len() + 2 + entry.len() < columns) {
            Some(line) => *line += &format!("  {entry}"),
            None => lines.push(entry.into()),
        }
    }
    lines
}

/// Draws a frame with its status line, the last row.
pub fn draw(
    show: &mut dyn Show,
    title: &Title,
    frame: u32,
    clock: &PlayTime,
    settings: &Settings,
    [columns, rows]: [usize; 2],
) -> Result<Grid> {
    let palette = &settings.palette;
    let mut grid = Grid::new(columns, rows, palette);
    let last = rows.saturating_sub(1);
    if last > 0 && columns > 0 {
        show.draw(frame, settings, &mut grid, last)?;
    }
    let (ink, paper) = (palette.letters(), palette.margin());
    if settings.help {
        let lines = help_lines(columns);
        let shown = lines.len().min(last);
        for (line, row) in lines.iter().zip(last - shown..last) {
            grid.write_text(0, row, &" ".repeat(columns), ink, palette.paper());
            grid.write_text(1, row, line, ink, palette.paper());
        }
    }
    grid.write_text(0, last, &" ".repeat(columns), ink, paper);
    let status = title.status(frame, clock, settings, show.has_views());
    grid.write_text(0, last, &status, ink, paper);
    let hint = "? help ";
    if columns > status.chars().count() + hint.len() {
        grid.write_text(columns - hint.len(), last, hint, ink, paper);
    }
    Ok(grid)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_help_fits_eighty_columns_and_names_every_key() {
        for columns in [40, 80, 200] {
            let lines = help_lines(columns);
            assert!(lines.iter().all(|line| line.len() < columns), "{lines:?}");
            assert_eq!(lines.join("  "), HELP);
        }
        assert_eq!(help_lines(80).len(), 2);
    }
}
