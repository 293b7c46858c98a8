//! What keys do: the same as on the board.

use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Stop, or go on.
    Pause,
    /// Moves by a number of frames, and pauses.
    Step(i64),
    /// Play the other way.
    Reverse,
    /// Moves by a number of clips.
    Clip(isize),
    /// Doubles the speed N times.
    Speed(i32),
    /// The camera about the figure, degrees.
    Orbit(i16),
    /// The camera above the horizon, degrees.
    Tilt(i16),
    /// From the front, the side, behind, or between.
    View,
    /// Follow the figure, or keep still.
    Follow,
    /// Show the ground, or not.
    Ground,
    /// Lines, or a body with volume.
    Style,
    /// Braille or half blocks.
    Dots,
    /// Show the keys, or not.
    Help,
    /// End.
    Quit,
}

/// Degrees of a key.
const ORBIT: i16 = 15;
const TILT: i16 = 5;

/// What the help line says.
pub const HELP: &str = "space pause  , . step  r reverse  + - speed  n p clip  arrows orbit, tilt  v view  f follow  g ground  o solid  b dots  ? help  q quit";

/// What a key asks for.
pub fn action(key: KeyEvent) -> Option<Action> {
    if key.kind == KeyEventKind::Release {
        return None;
    }
    if key.modifiers.contains(KeyModifiers::CONTROL) {
        return matches!(key.code, KeyCode::Char('c' | 'C' | 'd' | 'D')).then_some(Action::Quit);
    }
    Some(match key.code {
        KeyCode::Char(' ') => Action::Pause,
        KeyCode::Char('.' | '>') => Action::Step(1),
        KeyCode::Char(',' | '<') => Action::Step(-1),
        KeyCode::Char('r' | 'R') => Action::Reverse,
        KeyCode::Char('n' | 'N') => Action::Clip(1),
        KeyCode::Char('p' | 'P') => Action::Clip(-1),
        KeyCode::Char('+' | '=') => Action::Speed(1),
        KeyCode::Char('-' | '_') => Action::Speed(-1),
        KeyCode::Left | KeyCode::Char('a' | 'A') => Action::Orbit(-ORBIT),
        KeyCode::Right | KeyCode::Char('d' | 'D') => Action::Orbit(ORBIT),
        KeyCode::Up | KeyCode::Char('w' | 'W') => Action::Tilt(TILT),
        KeyCode::Down | KeyCode::Char('s' | 'S') => Action::Tilt(-TILT),
        KeyCode::Char('v' | 'V') => Action::View,
        KeyCode::Char('f' | 'F') => Action::Follow,
        KeyCode::Char('g' | 'G') => Action::Ground,
        KeyCode::Char('o' | 'O') => Action::Style,
        KeyCode::Char('b' | 'B') => Action::Dots,
        KeyCode::Char('?' | 'h' | 'H') => Action::Help,
        KeyCode::Char('q' | 'Q') | KeyCode::Esc => Action::Quit,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_of_the_help_line_does_something() {
        let plain = |code| action(KeyEvent::new(code, KeyModifiers::NONE));
        let words: Vec<&str> = HELP.split("  ").flat_map(|entry| entry.split(' ')).collect();
        for word in words.iter().filter(|word| word.len() == 1) {
            assert!(plain(KeyCode::Char(word.chars().next().unwrap())).is_some(), "{word}");
        }
        assert_eq!(plain(KeyCode::Char(' ')), Some(Action::Pause));
        assert_eq!((plain(KeyCode::Left), plain(KeyCode::Up)), (Some(Action::Orbit(-15)), Some(Action::Tilt(5))));
        assert_eq!((plain(KeyCode::Char('x')), plain(KeyCode::F(1))), (None, None));
    }

    #[test]
    fn control_c_quits_and_letting_go_of_a_key_does_nothing() {
        assert_eq!(action(KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL)), Some(Action::Quit));
        assert_eq!(action(KeyEvent::new(KeyCode::Char('r'), KeyModifiers::CONTROL)), None);
        let release = KeyEvent::new_with_kind(KeyCode::Char('q'), KeyModifiers::NONE, KeyEventKind::Release);
        assert_eq!(action(release), None);
    }
}
