//! A bank's state machine in the terminal, steered by keys.

use super::cells::{Dots, Grid};
use super::keys::Action;
use super::session::Session;
use super::settings::Settings;
use crate::output::clean;
use anyhow::Result;
use crossterm::event::{self, Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use pantin_animator::machine::{Cause, FEET, Table};
use pantin_animator::{Character, Feet, first_clip};
use pantin_figure::View;
use pantin_pictures::machine::playback::{Room, Stage, view_at_start};
use pantin_pictures::render::figure::MOST_PIXELS;
use std::time::{Duration, Instant};

/// Time between pictures.
const PICTURE: Duration = Duration::from_nanos(33_333_333);
/// Most time that passes in a picture: the figure waits while the program is stopped.
const MOST: Duration = Duration::from_millis(250);
/// The least time for which keys are looked for.
const BRIEFLY: Duration = Duration::from_millis(1);
/// Parts of a parameter's range that a key passes.
const PARTS: i32 = 10;
/// Names of inputs that an arrow key is for.
const UP: [&str; 5] = ["go", "walk", "forward", "forwards", "up"];
const DOWN: [&str; 5] = ["back", "backward", "backwards", "down", "stop"];
/// Letters that no input gets.
const TAKEN: &str = "q?+-";

/// A key of an input.
#[derive(Clone, Debug, PartialEq, Eq)]
struct InputKey {
    code: KeyCode,
    input: u8,
    /// Whether a second press lets it go: a terminal does not report that a key is released.
    toggles: bool,
}

/// Which key makes which input.
#[derive(Clone, Debug)]
pub struct Keys {
    keys: Vec<InputKey>,
}

impl Keys {
    /// An arrow for inputs of such names, the space bar for a jump, and else a letter of the input's name, or any letter.
    pub fn of(table: &Table<'_>) -> Keys {
        let held = |input: u8| {
            let mut rows = (0..).map_while(|index| table.transition(index));
            rows.any(|row| row.cause == Cause::Released(input))
        };
        let mut keys: Vec<InputKey> = Vec::new();
        for input in 0..table.inputs() as u8 {
            let name = table.input_name(input).to_lowercase();
            let arrow = match name.as_str() {
                "left" => Some(KeyCode::Left),
                "right" => Some(KeyCode::Right),
                "jump" => Some(KeyCode::Char(' ')),
                name if UP.contains(&name) => Some(KeyCode::Up),
                name if DOWN.contains(&name) => Some(KeyCode::Down),
                _ => None,
            };
            let letters = name.chars().filter(char::is_ascii_lowercase).chain('a'..='z');
            let letters = letters.filter(|letter| !TAKEN.contains(*letter)).map(KeyCode::Char);
            let free = |code: &KeyCode| keys.iter().all(|key| key.code != *code);
            if let Some(code) = arrow.into_iter().chain(letters).find(free) {
                keys.push(InputKey { code, input, toggles: held(input) });
            }
        }
        Keys { keys }
    }

    fn find(&self, code: KeyCode) -> Option<&InputKey> {
        self.keys.iter().find(|key| key.code == code)
    }

    /// What the help says: a key and its input each, then the others.
    fn help(&self, table: &Table<'_>) -> Vec<String> {
        let name = |code: KeyCode| match code {
            KeyCode::Char(' ') => "space".to_string(),
            KeyCode::Char(letter) => letter.to_string(),
            code => format!("{code:?}").to_lowercase(),
        };
        let mut help: Vec<String> = self
            .keys
            .iter()
            .map(|key| {
                let toggles = if key.toggles { " (on, off)" } else { "" };
                format!("{} {}{toggles}", name(key.code), clean(table.input_name(key.input)))
            })
            .collect();
        if table.parameters() > 0 {
            help.push("+ - parameter".into());
        }
        if table.parameters() > 1 {
            help.push("tab next parameter".into());
        }
        help.extend(["< > orbit", "V view", "F follow", "G ground", "B dots", "R restart", "? help", "q quit"].map(String::from));
        help
    }
}

/// What a key that is no input's asks for.
enum Asked {
    Show(Action),
    Parameter(i32),
    NextParameter,
    Restart,
    Quit,
}

fn asked(key: KeyEvent) -> Option<Asked> {
    if key.modifiers.contains(KeyModifiers::CONTROL) {
        return matches!(key.code, KeyCode::Char('c' | 'C' | 'd' | 'D')).then_some(Asked::Quit);
    }
    Some(match key.code {
        KeyCode::Char('+' | '=') => Asked::Parameter(1),
        KeyCode::Char('-' | '_') => Asked::Parameter(-1),
        KeyCode::Tab => Asked::NextParameter,
        KeyCode::Char('<' | ',') => Asked::Show(Action::Orbit(-15)),
        KeyCode::Char('>' | '.') => Asked::Show(Action::Orbit(15)),
        KeyCode::Char('V') => Asked::Show(Action::View),
        KeyCode::Char('F') => Asked::Show(Action::Follow),
        KeyCode::Char('G') => Asked::Show(Action::Ground),
        KeyCode::Char('B') => Asked::Show(Action::Dots),
        KeyCode::Char('?') => Asked::Show(Action::Help),
        KeyCode::Char('R') => Asked::Restart,
        KeyCode::Char('q' | 'Q') | KeyCode::Esc => Asked::Quit,
        _ => return None,
    })
}

/// Looks whether a machine was changed, and makes its bank again if it was.
pub type Remake<'w> = &'w mut dyn FnMut() -> Option<Result<Vec<u8>>>;

/// Why a character ended.
enum Ended {
    Quit,
    Restart,
    /// Its bank was made again.
    Changed(Vec<u8>),
}

/// Plays a bank's machine until a key ends it, and each that replaces it from its start, with the inputs that are held. Where one cannot be made, the
/// reason is shown, and the one before plays on.
pub fn watch(mut bytes: Vec<u8>, name: &str, session: &mut Session, remake: Remake<'_>) -> Result<()> {
    let mut held = Vec::new();
    loop {
        let mut steering = Steering { held, ..Steering::new(&bytes, name.into())? };
        let Some(changed) = steering.play_watched(session, remake)? else { return Ok(()) };
        held = steering.held;
        bytes = changed;
    }
}

/// Refuses a bank whose machine cannot be played.
fn check(bytes: &[u8]) -> Result<()> {
    Steering::new(bytes, String::new())?;
    Room::of(bytes)?.character(bytes, &mut Feet::new())?;
    Stage::new(bytes, [64, 64], View::default(), None).map(drop)
}

/// Pictures for which an input that was fired is shown.
const FIRED_PICTURES: u32 = 15;

/// A character that is shown.
pub struct Steering<'b> {
    bytes: &'b [u8],
    name: String,
    keys: Keys,
    /// The parameter that keys change.
    parameter: u8,
    /// The input that was fired last, and the pictures for which it is still shown.
    fired: Option<(u8, u32)>,
    /// Names of inputs that are held when it starts.
    held: Vec<String>,
    /// Why the machine could not be made again.
    error: Option<String>,
    stage: Option<(Stage, [usize; 2], View)>,
}

impl<'b> Steering<'b> {
    /// The machine of a bank, which has one.
    pub fn new(bytes: &'b [u8], name: String) -> Result<Steering<'b>> {
        let keys = Keys::of(&Table::of_bank(bytes)?);
        Ok(Steering { bytes, name, keys, parameter: 0, fired: None, held: Vec::new(), error: None, stage: None })
    }

    /// Plays until a key ends it.
    pub fn play(&mut self, session: &mut Session) -> Result<()> {
        self.play_watched(session, &mut || None).map(drop)
    }

    /// Plays until a key ends it, or until its bank was made again, which is returned.
    fn play_watched(&mut self, session: &mut Session, remake: Remake<'_>) -> Result<Option<Vec<u8>>> {
        loop {
            let (mut room, mut feet) = (Room::of(self.bytes)?, Feet::new());
            let mut character = room.character(self.bytes, &mut feet)?;
            for name in std::mem::take(&mut self.held) {
                if let Some(input) = character.table().input(&name) {
                    character.machine().hold(input, true);
                }
            }
            match self.play_once(session, &mut character, remake)? {
                Ended::Quit => return Ok(None),
                Ended::Restart => {}
                Ended::Changed(bytes) => {
                    let table = character.table();
                    let held = (0..table.inputs() as u8).filter(|&input| character.is_held(input));
                    self.held = held.map(|input| table.input_name(input).to_owned()).collect();
                    return Ok(Some(bytes));
                }
            }
        }
    }

    /// Plays from the start.
    fn play_once(&mut self, session: &mut Session, character: &mut Character<'b, '_>, remake: Remake<'_>) -> Result<Ended> {
        let mut before = Instant::now();
        loop {
            if session.left == Some(0) {
                return Ok(Ended::Quit);
            }
            match remake().map(|made| made.and_then(|bytes| check(&bytes).map(|()| bytes))) {
                None => {}
                Some(Ok(bytes)) => return Ok(Ended::Changed(bytes)),
                Some(Err(error)) => self.error = Some(format!("{error:#}")),
            }
            let size = session.terminal.size()?;
            session.terminal.show(self.draw(character, &session.settings, size)?)?;
            session.left = session.left.map(|left| left - 1);
            self.fired = self.fired.and_then(|(input, left)| Some((input, left.checked_sub(1)?)));
            let due = before + PICTURE;
            let mut patience = due.saturating_duration_since(Instant::now()).max(BRIEFLY);
            while event::poll(patience)? {
                match event::read()? {
                    Event::Resize(..) => session.terminal.forget(),
                    Event::Key(key) if key.kind != KeyEventKind::Release => {
                        match self.key(key, character, &mut session.settings, size[1]) {
                            Some(Asked::Quit) => return Ok(Ended::Quit),
                            Some(Asked::Restart) => return Ok(Ended::Restart),
                            _ => {}
                        }
                    }
                    _ => {}
                }
                patience = due.saturating_duration_since(Instant::now()).max(BRIEFLY);
            }
            let now = Instant::now();
            character.update(now.duration_since(before).min(MOST).as_micros() as u32)?;
            before = now;
        }
    }

    /// Does what a key asks for, if it is not to end.
    fn key(&mut self, key: KeyEvent, character: &mut Character<'_, '_>, settings: &mut Settings, rows: usize) -> Option<Asked> {
        let control = key.modifiers.contains(KeyModifiers::CONTROL);
        if let Some(own) = self.keys.find(key.code).filter(|_| !control).cloned() {
            let machine = character.machine();
            if own.toggles {
                machine.hold(own.input, !machine.is_held(own.input));
            } else {
                machine.fire(own.input);
                self.fired = Some((own.input, FIRED_PICTURES));
            }
            return None;
        }
        match asked(key)? {
            Asked::Show(action) => {
                settings.apply(action, rows.saturating_sub(1));
            }
            Asked::Parameter(way) => {
                let [least, most, _] = character.table().range(self.parameter).map(i32::from);
                let to = i32::from(character.parameter(self.parameter)) + way * ((most - least) / PARTS).max(1);
                character.machine().set(self.parameter, to.clamp(least, most) as i16);
            }
            Asked::NextParameter => {
                let count = character.table().parameters().max(1);
                self.parameter = ((usize::from(self.parameter) + 1) % count) as u8;
            }
            ends => return Some(ends),
        }
        None
    }

    /// The state, the inputs, the joints on the ground, and the parameters.
    fn status(&self, character: &Character<'_, '_>, settings: &Settings) -> String {
        let table = character.table();
        let mut line = format!(" {}  state {}", self.name, clean(table.state_name(character.state())));
        for input in (0..table.inputs() as u8).filter(|&input| character.is_held(input)) {
            line += &format!("  [{}]", clean(table.input_name(input)));
        }
        if let Some((input, _)) = self.fired {
            line += &format!("  ({})", clean(table.input_name(input)));
        }
        line += &self.contacts(character);
        for layer in (0..table.layers()).filter(|&layer| character.layer_weight(layer).to_bits() > 0) {
            let input = table.layer(layer).map_or("", |row| table.input_name(row.input));
            line += &format!("  +{}", clean(input));
        }
        for parameter in 0..table.parameters() as u8 {
            let chosen = if parameter == self.parameter && table.parameters() > 1 { "*" } else { "" };
            line += &format!("  {}{chosen} {}", clean(table.parameter_name(parameter)), character.parameter(parameter));
        }
        line + &format!("  {}", settings.view_words())
    }

    /// The joints at which feet are held on the ground, of a bank with a table of feet.
    fn contacts(&self, character: &Character<'_, '_>) -> String {
        let (Some(feet), Ok(clip)) = (character.feet(), first_clip(self.bytes)) else { return String::new() };
        let rig = clip.rig();
        let held = (0..FEET).filter_map(|foot| feet.held(foot)).filter_map(|joint| rig.joint(joint.into()));
        let names: Vec<String> = held.map(|joint| clean(joint.name()).into_owned()).collect();
        format!("  on the ground: {}", if names.is_empty() { "none".into() } else { names.join(" ") })
    }

    /// A picture with its status line, the last row.
    pub fn draw(&mut self, character: &Character<'_, '_>, settings: &Settings, [columns, rows]: [usize; 2]) -> Result<Grid> {
        let palette = &settings.palette;
        let mut grid = Grid::new(columns, rows, palette);
        let last = rows.saturating_sub(1);
        if last > 0 && columns > 0 {
            let dots: Dots = settings.dots(last);
            let [across, down] = dots.pixels();
            let size = [columns * across, last * down].map(|pixels| pixels.min(MOST_PIXELS));
            if self.stage.as_ref().is_none_or(|(_, own, view)| (*own, *view) != (size, settings.view)) {
                self.stage =
                    Some((Stage::new(self.bytes, size, view_at_start(self.bytes, settings.view)?, None)?, size, settings.view));
            }
            if let Some((stage, ..)) = &mut self.stage {
                let shades = stage.shades(character, settings.ground, settings.in_bits())?;
                grid.show(&shades, last, dots, palette, settings.coloured());
            }
        }
        let (ink, paper) = (palette.letters(), palette.margin());
        if settings.help {
            let mut lines: Vec<String> = Vec::new();
            for entry in self.keys.help(character.table()) {
                match lines.last_mut().filter(|line| line.chars().count() + 2 + entry.chars().count() < columns) {
                    Some(line) => *line += &format!("  {entry}"),
                    None => lines.push(entry),
                }
            }
            let shown = lines.len().min(last);
            for (line, row) in lines.iter().zip(last - shown..last) {
                grid.write_text(0, row, &" ".repeat(columns), ink, palette.paper());
                grid.write_text(1, row, line, ink, palette.paper());
            }
        }
        if let Some(error) = &self.error {
            let words: Vec<char> = clean(&format!("error: {error}")).chars().collect();
            let rows = words.chunks(columns.saturating_sub(1).max(1)).take(last);
            for (row, line) in rows.enumerate() {
                grid.write_text(0, row, &" ".repeat(columns), ink, palette.paper());
                grid.write_text(0, row, &line.iter().collect::<String>(), ink, palette.paper());
            }
        }
        grid.write_text(0, last, &" ".repeat(columns), ink, paper);
        let status = self.status(character, settings);
        grid.write_text(0, last, &status, ink, paper);
        let hint = "? help ";
        if columns > status.chars().count() + hint.len() {
            grid.write_text(columns - hint.len(), last, hint, ink, paper);
        }
        Ok(grid)
    }
}
