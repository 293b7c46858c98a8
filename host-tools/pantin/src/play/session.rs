//! A clip playing in the terminal, until another one is asked for or all ends.

use super::keys::{Action, action};
use super::picture::{Show, Title, draw};
use super::play_time::PlayTime;
use super::settings::Settings;
use super::terminal::Terminal;
use anyhow::Result;
use crossterm::event::{self, Event};
use std::time::{Duration, Instant};

/// Least time between pictures: faster clips leave frames out.
const LEAST: Duration = Duration::from_nanos(16_600_000);
/// While it is paused, keys alone are waited for.
const PATIENCE: Duration = Duration::from_secs(3600);

/// Keys are looked for so long at least, however late a picture is: no time at all finds none.
const BRIEFLY: Duration = Duration::from_millis(1);

/// Why a clip ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Moves by a number of clips.
    Clip(isize),
    /// Its last frame was shown, with `once`.
    Over,
    /// All is to end.
    Quit,
}

/// What stays from clip to clip.
pub struct Session {
    pub(super) terminal: Terminal,
    pub(super) settings: Settings,
    clock: PlayTime,
    begun: Instant,
    once: bool,
    /// Pictures that may still be shown, if they are counted.
    pub(super) left: Option<u32>,
}

impl Session {
    /// Nothing plays yet. `once` ends each clip at its end; `frames` is the number of pictures after which all ends.
    pub fn new(terminal: Terminal, settings: Settings, once: bool, frames: Option<u32>) -> Session {
        Session { terminal, settings, clock: PlayTime::new(1, Duration::ZERO), begun: Instant::now(), once, left: frames }
    }

    /// Plays a clip.
    pub fn play(&mut self, show: &mut dyn Show, title: &Title, frame_time_ns: u32) -> Result<Outcome> {
        self.clock.restart(frame_time_ns, self.begun.elapsed());
        let mut shown: Option<(u32, Duration)> = None;
        loop {
            let now = self.begun.elapsed();
            let due = self.clock.frame(now);
            if self.once && !self.clock.paused() && !(-i64::from(title.frames)..i64::from(title.frames)).contains(&due) {
                return Ok(Outcome::Over);
            }
            let frame = due.rem_euclid(i64::from(title.frames)) as u32;
            if shown.is_none_or(|(before, _)| before != frame) {
                if self.left == Some(0) {
                    return Ok(Outcome::Quit);
                }
                let grid = draw(show, title, frame, &self.clock, &self.settings, self.terminal.size()?)?;
                self.terminal.show(grid)?;
                self.left = self.left.map(|left| left - 1);
                shown = Some((frame, now));
            }
            let (changed, outcome) = self.wait(shown.map_or(now, |(_, drawn)| drawn))?;
            if let Some(outcome) = outcome {
                return Ok(outcome);
            }
            if changed {
                shown = None;
            }
        }
    }

    /// Waits for the next frame or a key; whether the picture must be drawn again, or the clip ends.
    fn wait(&mut self, drawn: Duration) -> Result<(bool, Option<Outcome>)> {
        let now = self.begun.elapsed();
        let next = self.clock.until_next(now).unwrap_or(PATIENCE).max((drawn + LEAST).saturating_sub(now)).max(BRIEFLY);
        let mut changed = false;
        let mut patience = next;
        while event::poll(patience)? {
            patience = BRIEFLY;
            match event::read()? {
                Event::Resize(..) => self.terminal.forget(),
                Event::Key(key) => {
                    if let Some(outcome) = action(key).and_then(|action| self.act(action)) {
                        return Ok((false, Some(outcome)));
                    }
                }
                _ => continue,
            }
            changed = true;
        }
        Ok((changed, None))
    }

    fn act(&mut self, action: Action) -> Option<Outcome> {
        let now = self.begun.elapsed();
        let rows = self.terminal.size().map_or(0, |[_, rows]| rows.saturating_sub(1));
        if self.settings.apply(action, rows) {
            return None;
        }
        match action {
            Action::Pause => self.clock.pause(now),
            Action::Step(frames) => self.clock.step(frames, now),
            Action::Reverse => self.clock.reverse(now),
            Action::Speed(doublings) => self.clock.change_speed(doublings, now),
            Action::Clip(clips) => return Some(Outcome::Clip(clips)),
            Action::Quit => return Some(Outcome::Quit),
            _ => {}
        }
        None
    }
}
