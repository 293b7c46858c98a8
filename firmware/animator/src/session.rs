//! Recorded inputs of a state machine: a small text that plays the same on every machine. `MACHINE.md` describes it.
//!
//! ```
//! # fn play(bank: &[u8], memory: pantin_animator::Memory) -> Result<(), Box<dyn std::error::Error>> {
//! use pantin_animator::Character;
//! use pantin_animator::session::{Replay, Session};
//!
//! let mut character = Character::new(bank, memory)?;
//! let session = Session::new_checked("0.5 hold go\n2.0 press jump\n4.0 end", character.table())?;
//! let mut replay = Replay::new(session, 30);
//! while replay.next(&mut character)? {
//!     let (_pose, _placement) = character.pose();
//! }
//! # Ok(())
//! # }
//! ```

use crate::Error;
use crate::character::Character;
use crate::machine::{Machine, Table};

/// An input of the session.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// Fires an input once.
    Press(u8),
    /// Holds an input down.
    Hold(u8),
    /// Lets an input go.
    Release(u8),
    /// Sets a parameter.
    Set(u8, i16),
    /// The session ends.
    End,
}

/// An input and its time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timed {
    /// Since the start.
    pub time_us: u32,
    /// What happens.
    pub input: Input,
}

/// What is wrong with a line of a session.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Fault {
    /// It does not begin with seconds from 0 to 3600.
    Time,
    /// Its time is before that of a line above.
    Order,
    /// Its second word is none of `press`, `hold`, `release`, `set` and `end`.
    Word,
    /// The machine has no such input.
    NoSuchInput,
    /// The machine has no such parameter.
    NoSuchParameter,
    /// A parameter's value is no whole number, or outside of its range.
    Value,
    /// It has more words than it needs.
    TooLong,
    /// It stands behind the end.
    AfterEnd,
    /// It is the last one, and no `end`.
    NoEnd,
}

/// Why a session cannot be played.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SessionError {
    /// The line, from 1.
    pub line: u32,
    /// What is wrong with it.
    pub fault: Fault,
}

impl core::fmt::Display for SessionError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let words = match self.fault {
            Fault::Time => "expected a time in seconds, 0 to 3600, as in 2.5",
            Fault::Order => "the time is before that of a line above",
            Fault::Word => "expected press, hold, release, set or end after the time",
            Fault::NoSuchInput => "the state machine has no such input",
            Fault::NoSuchParameter => "the state machine has no such parameter",
            Fault::Value => "expected a whole number in the parameter's range",
            Fault::TooLong => "there are more words than the line needs",
            Fault::AfterEnd => "the line stands behind the end",
            Fault::NoEnd => "the last line is no end, as in `20 end`",
        };
        write!(f, "line {}: {words}", self.line)
    }
}

impl core::error::Error for SessionError {}

/// A checked session.
#[derive(Clone, Copy, Debug)]
pub struct Session<'a> {
    text: &'a str,
    table: Table<'a>,
    end_us: u32,
}

impl<'a> Session<'a> {
    /// Checks a session for a machine.
    pub fn new_checked(text: &'a str, table: &Table<'a>) -> Result<Session<'a>, SessionError> {
        let (mut before, mut end, mut lines) = (0, None, 0);
        for (line, text) in (1..).zip(text.lines()) {
            lines = line;
            let fault = |fault| SessionError { line, fault };
            let Some(timed) = parse(text, table).map_err(fault)? else { continue };
            if end.is_some() {
                return Err(fault(Fault::AfterEnd));
            }
            if timed.time_us < before {
                return Err(fault(Fault::Order));
            }
            before = timed.time_us;
            if timed.input == Input::End {
                end = Some(timed.time_us);
            }
        }
        let end_us = end.ok_or(SessionError { line: lines, fault: Fault::NoEnd })?;
        Ok(Session { text, table: *table, end_us })
    }

    /// When it ends.
    pub fn end_us(&self) -> u32 {
        self.end_us
    }

    /// Its inputs, in the order of their times.
    pub fn inputs(&self) -> impl Iterator<Item = Timed> + use<'a> {
        let table = self.table;
        self.text.lines().filter_map(move |line| parse(line, &table).ok().flatten())
    }
}

/// What a line says; `None` for an empty one or a comment.
fn parse(line: &str, table: &Table<'_>) -> Result<Option<Timed>, Fault> {
    let line = line.split_once('#').map_or(line, |(before, _)| before);
    let mut words = line.split_ascii_whitespace();
    let Some(time) = words.next() else { return Ok(None) };
    let time_us = micro_seconds(time).ok_or(Fault::Time)?;
    let (word, name) = (words.next().unwrap_or(""), words.next());
    let input = || table.input(name.unwrap_or("")).ok_or(Fault::NoSuchInput);
    let input = match word {
        "press" => Input::Press(input()?),
        "hold" => Input::Hold(input()?),
        "release" => Input::Release(input()?),
        "set" => {
            let parameter = table.parameter(name.unwrap_or("")).ok_or(Fault::NoSuchParameter)?;
            let value = words.next().and_then(|value| value.parse().ok()).ok_or(Fault::Value)?;
            let [least, most, _] = table.range(parameter);
            if !(least..=most).contains(&value) {
                return Err(Fault::Value);
            }
            Input::Set(parameter, value)
        }
        "end" if name.is_none() => Input::End,
        "end" => return Err(Fault::TooLong),
        _ => return Err(Fault::Word),
    };
    if words.next().is_some() { Err(Fault::TooLong) } else { Ok(Some(Timed { time_us, input })) }
}

/// Seconds with up to six digits after the point; further ones are cut off.
fn micro_seconds(text: &str) -> Option<u32> {
    let (whole, part) = text.split_once('.').unwrap_or((text, "0"));
    if whole.is_empty() || part.is_empty() || !(whole.bytes().chain(part.bytes())).all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let seconds: u32 = whole.parse().ok().filter(|&seconds| seconds <= 3600)?;
    let digits = part.bytes().chain(core::iter::repeat(b'0')).take(6);
    Some(seconds * 1_000_000 + digits.fold(0, |sum, digit| sum * 10 + u32::from(digit - b'0')))
}

/// Plays a session picture by picture.
#[derive(Clone, Copy, Debug)]
pub struct Replay<'a> {
    session: Session<'a>,
    rate: u32,
    /// Number of the picture that [`Replay::next`] shows next.
    picture: u32,
    /// Inputs that were made.
    made: u32,
}

impl<'a> Replay<'a> {
    /// A replay at a number of pictures in a second (1 at least).
    pub fn new(session: Session<'a>, rate: u16) -> Replay<'a> {
        Replay { session, rate: rate.max(1).into(), picture: 0, made: 0 }
    }

    /// The time of a picture.
    fn time_us(&self, picture: u32) -> u32 {
        (u64::from(picture) * 1_000_000).checked_div(self.rate.into()).unwrap_or(0) as u32
    }

    /// Pictures of the whole session.
    pub fn pictures(&self) -> u32 {
        (u64::from(self.session.end_us) * u64::from(self.rate) / 1_000_000) as u32 + 1
    }

    /// Moves the character to the next picture: the first one shows its start. False when the session is over. A picture shows all inputs
    /// up to its time.
    pub fn next(&mut self, character: &mut Character<'a, '_>) -> Result<bool, Error> {
        if self.picture >= self.pictures() {
            return Ok(false);
        }
        let now = self.time_us(self.picture);
        let due = |timed: &Timed| timed.time_us <= now;
        let mut made = 0;
        if self.picture > 0 {
            for timed in self.session.inputs().skip(self.made as usize).take_while(due) {
                apply(timed.input, character.machine());
                made += 1;
            }
            character.update(now - self.time_us(self.picture - 1))?;
        }
        self.made += made;
        self.picture += 1;
        Ok(true)
    }
}

/// Makes an input.
fn apply(input: Input, machine: &mut Machine<'_>) {
    match input {
        Input::Press(input) => machine.fire(input),
        Input::Hold(input) => machine.hold(input, true),
        Input::Release(input) => machine.hold(input, false),
        Input::Set(parameter, value) => machine.set(parameter, value),
        Input::End => {}
    }
}
