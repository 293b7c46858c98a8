//! A state machine from a table in a bank: [`MACHINE.md`](https://docs.rs/pantin-animator) describes its bytes.
//!
//! ```
//! # fn play(bytes: &[u8]) -> Result<(), pantin_animator::Error> {
//! use pantin_animator::machine::{Machine, Table};
//! use pantin_animator::{Animator, Workspace};
//!
//! let bank = pantin::Bank::new_checked(bytes)?;
//! let table = Table::of_bank(bytes)?;
//! let mut machine = Machine::new(table);
//! let mut memory = Workspace::<80, 100>::new();
//! let mut animator = Animator::new(machine.first_clip(&bank)?, memory.lend())?;
//! machine.start(&mut animator);
//! let jump = table.input("jump");
//! for _picture in 0..100 {
//!     if let Some(jump) = jump {
//!         machine.fire(jump);
//!     }
//!     machine.update(16_667, &bank, &mut animator, None)?;
//! }
//! # Ok(())
//! # }
//! ```

use crate::animator::{Animator, Transition};
use crate::events::EventsLost;
use crate::layer::Weight;
use crate::track::Track;
use crate::{Error, sync};
use fixed::types::I16F16;
use pantin::{Bank, Clip, OpenError};

/// The type of a bank's section that holds a table.
pub const SECTION: u8 = 4;

/// The version of tables that this library reads.
pub const VERSION: u8 = 1;

/// Most states, parameters and inputs of a table.
pub const STATES: usize = 64;
/// Most parameters of a table.
pub const PARAMETERS: usize = 8;
/// Most inputs of a table.
pub const INPUTS: usize = 32;
/// Most layers of a table.
pub const LAYERS: usize = 4;

const HEADER: usize = 8;
const STATE: usize = 8;
const TRANSITION: usize = 8;
const PARAMETER: usize = 6;
const LAYER: usize = 12;
/// In place of a second clip.
const NONE: u8 = 255;
/// In place of a first frame: in step with the old clip.
const IN_STEP: u8 = 255;

/// Why a table cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TableError {
    /// The bank has no section of a state machine, or ends before it should.
    Missing,
    /// The table ends before it should, or goes on after it.
    Truncated,
    /// The table's check sum is wrong.
    BadCrc,
    /// The table's version is not [`VERSION`].
    UnsupportedVersion(u8),
    /// There are no states, or more states, parameters, inputs or layers than there may be.
    BadCount,
    /// A state, or a layer (counted after the states), names a clip that the bank lacks.
    NoSuchClip {
        /// The state.
        state: u8,
    },
    /// A state is first, or a transition leads to it, that the table lacks.
    NoSuchState(u8),
    /// A state or a transition names a parameter or an input that the table lacks.
    NoSuchInput(u8),
    /// A state's transitions lie outside the table.
    NoSuchTransition {
        /// The state.
        state: u8,
    },
    /// A speed, a parameter's range or a transition's kind or cause is none.
    BadValue,
    /// A state has two transitions with the same cause, of which the second can never happen.
    Ambiguous {
        /// The state; 255 for the transitions from any state.
        state: u8,
    },
    /// No transition leads to a state.
    Unreachable(u8),
}

impl core::fmt::Display for TableError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            TableError::Missing => f.write_str("the bank has no state machine"),
            TableError::Truncated => f.write_str("the state machine's table has another length than it says"),
            TableError::BadCrc => f.write_str("the state machine's table is damaged"),
            TableError::UnsupportedVersion(version) => write!(f, "state machine version {version} is not supported"),
            TableError::BadCount => {
                f.write_str("the state machine has no states, or too many states, parameters, inputs or layers")
            }
            TableError::NoSuchClip { state } => write!(f, "state {state} plays a clip that the bank lacks"),
            TableError::NoSuchState(state) => write!(f, "there is no state {state}"),
            TableError::NoSuchInput(input) => write!(f, "there is no parameter or input {input}"),
            TableError::NoSuchTransition { state } => write!(f, "the transitions of state {state} are not in the table"),
            TableError::BadValue => f.write_str("the table has a speed, a range, a kind or a cause that is none"),
            TableError::Ambiguous { state } => write!(f, "state {state} has two transitions with the same cause"),
            TableError::Unreachable(state) => write!(f, "no transition leads to state {state}"),
        }
    }
}

impl core::error::Error for TableError {}

/// What makes a transition happen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// The clip, which is no loop, has ended.
    End,
    /// An input was fired, or is held.
    Input(u8),
    /// An input is not held.
    Released(u8),
    /// The clip's event of this id was passed.
    Event(u8),
    /// A parameter is above the threshold.
    Above(u8, i16),
    /// A parameter is below the threshold.
    Below(u8, i16),
}

/// A row of the table's transitions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TransitionRow {
    /// What makes it happen.
    pub cause: Cause,
    /// The state that it leads to.
    pub to: u8,
    /// How.
    pub transition: Transition,
    /// The new clip's first frame; `None` for the one that is in step with the old clip.
    pub first_frame: Option<u8>,
}

/// A row of the table's layers: a clip that an input plays over some joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LayerRow<'a> {
    /// The clip's index in the bank.
    pub clip: u8,
    /// The input.
    pub input: u8,
    /// How long it takes to come and to go.
    pub fade_us: u32,
    /// A bit for each state in which it may play.
    pub states: u64,
    /// Patterns of [`crate::Mask::set`], one a line.
    pub joints: &'a str,
}

/// A row of the table's states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateRow {
    /// The clip's index in the bank.
    pub clip: u8,
    /// Another clip into which a parameter blends: its index in the bank, and the parameter's.
    pub blend: Option<(u8, u8)>,
    /// The speed.
    pub speed: I16F16,
    /// The first of its transitions, and how many there are.
    transitions: (u8, u8),
}

/// A checked table.
#[derive(Clone, Copy, Debug)]
pub struct Table<'a> {
    /// Without the CRC.
    bytes: &'a [u8],
}

impl<'a> Table<'a> {
    /// Finds and checks the table of a bank, whose bytes these are.
    pub fn of_bank(bytes: &'a [u8]) -> Result<Table<'a>, Error> {
        let bank = Bank::new_checked(bytes)?;
        let section = section(bytes).ok_or(Error::Machine(TableError::Missing))?;
        Table::new(section, bank.len()).map_err(Error::Machine)
    }

    /// Checks a table for a bank with a number of clips.
    #[inline(never)]
    pub fn new(bytes: &'a [u8], clips: usize) -> Result<Table<'a>, TableError> {
        let (body, stored) = bytes.split_last_chunk::<2>().ok_or(TableError::Truncated)?;
        if pantin::codec::crc::of(body) != u16::from_le_bytes(*stored) {
            return Err(TableError::BadCrc);
        }
        let table = Table { bytes: body };
        let &[version, states, _, parameters, inputs, first, any, layers, ..] = body else {
            return Err(TableError::Truncated);
        };
        if version != VERSION {
            return Err(TableError::UnsupportedVersion(version));
        }
        let (states, parameters, inputs) = (usize::from(states), usize::from(parameters), usize::from(inputs));
        let layers = usize::from(layers);
        if !(1..=STATES).contains(&states) || parameters > PARAMETERS || inputs > INPUTS || layers > LAYERS {
            return Err(TableError::BadCount);
        }
        let mut rest = body.get(table.names_at()..).ok_or(TableError::Truncated)?;
        for _ in 0..states + parameters + inputs + layers {
            let (len, after) = rest.split_first().ok_or(TableError::Truncated)?;
            rest = after.get(usize::from(*len)..).ok_or(TableError::Truncated)?;
        }
        if !rest.is_empty() {
            return Err(TableError::Truncated);
        }
        if usize::from(first) >= states {
            return Err(TableError::NoSuchState(first));
        }
        for parameter in 0..parameters {
            let [least, most, initial] = table.parameter_row(parameter);
            if least >= most || !(least..=most).contains(&initial) {
                return Err(TableError::BadValue);
            }
        }
        for index in 0..layers {
            let row = table.layer(index).ok_or(TableError::BadValue)?;
            if usize::from(row.clip) >= clips {
                return Err(TableError::NoSuchClip { state: (states + index) as u8 });
            }
            if usize::from(row.input) >= inputs {
                return Err(TableError::NoSuchInput(row.input));
            }
        }
        table.check_list(NONE, (0, any))?;
        for state in 0..states as u8 {
            let row = table.state(state).ok_or(TableError::BadValue)?;
            if usize::from(row.clip) >= clips || row.blend.is_some_and(|(clip, _)| usize::from(clip) >= clips) {
                return Err(TableError::NoSuchClip { state });
            }
            if let Some((_, parameter)) = row.blend
                && usize::from(parameter) >= parameters
            {
                return Err(TableError::NoSuchInput(parameter));
            }
            table.check_list(state, row.transitions)?;
        }
        table.check_reach()
    }

    /// Checks the transitions of a state.
    fn check_list(&self, state: u8, (first, count): (u8, u8)) -> Result<(), TableError> {
        let end = usize::from(first) + usize::from(count);
        if end > self.counted(2) {
            return Err(TableError::NoSuchTransition { state });
        }
        for index in usize::from(first)..end {
            let row = self.transition(index).ok_or(TableError::BadValue)?;
            if usize::from(row.to) >= self.counted(1) {
                return Err(TableError::NoSuchState(row.to));
            }
            let (given, named) = match row.cause {
                Cause::Input(input) | Cause::Released(input) => (self.counted(4), input),
                Cause::Above(parameter, _) | Cause::Below(parameter, _) => (self.counted(3), parameter),
                Cause::End | Cause::Event(_) => continue,
            };
            if usize::from(named) >= given {
                return Err(TableError::NoSuchInput(named));
            }
        }
        for index in usize::from(first)..end {
            let cause = self.transition(index).map(|row| row.cause);
            if (usize::from(first)..index).any(|before| self.transition(before).map(|row| row.cause) == cause) {
                return Err(TableError::Ambiguous { state });
            }
        }
        Ok(())
    }

    /// Checks that every state can be come to from the first.
    fn check_reach(self) -> Result<Table<'a>, TableError> {
        let states = self.counted(1);
        let mut reached = 1u64 << (self.counted(5) % STATES);
        for index in 0..self.counted(6) {
            reached |= self.transition(index).map_or(0, |row| 1 << (usize::from(row.to) % STATES));
        }
        loop {
            let before = reached;
            for state in (0..states).filter(|state| before >> state & 1 != 0) {
                let Some(row) = self.state(state as u8) else { continue };
                let first = usize::from(row.transitions.0);
                for index in first..first + usize::from(row.transitions.1) {
                    reached |= self.transition(index).map_or(0, |row| 1 << (usize::from(row.to) % STATES));
                }
            }
            if reached == before {
                break;
            }
        }
        match (0..states).find(|state| reached >> state & 1 == 0) {
            Some(state) => Err(TableError::Unreachable(state as u8)),
            None => Ok(self),
        }
    }

    /// A number of the header.
    fn counted(&self, at: usize) -> usize {
        self.bytes.get(at).copied().map_or(0, usize::from)
    }

    fn transitions_at(&self) -> usize {
        HEADER + STATE * self.counted(1)
    }

    fn parameters_at(&self) -> usize {
        self.transitions_at() + TRANSITION * self.counted(2)
    }

    fn layers_at(&self) -> usize {
        self.parameters_at() + PARAMETER * self.counted(3)
    }

    fn names_at(&self) -> usize {
        self.layers_at() + LAYER * self.counted(7)
    }

    /// Number of layers.
    pub fn layers(&self) -> usize {
        self.counted(7)
    }

    /// A layer; `None` if there is none of this index.
    pub fn layer(&self, index: usize) -> Option<LayerRow<'a>> {
        let at = self.layers_at() + LAYER * index;
        if index >= self.layers() {
            return None;
        }
        let &[clip, input, fade, reserved, ref states @ ..] = self.bytes.get(at..at + LAYER)? else { return None };
        let states = u64::from_le_bytes(states.try_into().ok()?);
        let before = self.counted(1) + self.counted(3) + self.counted(4);
        let joints = core::str::from_utf8(self.names().nth(before + index)?).ok()?;
        (reserved == 0).then_some(LayerRow { clip, input, fade_us: u32::from(fade) * 15_625, states, joints })
    }

    /// A state; `None` if there is none of this index.
    pub fn state(&self, index: u8) -> Option<StateRow> {
        let at = HEADER + STATE * usize::from(index);
        let &[clip, other, parameter, flags, low, high, first, count] = self.bytes.get(at..at + STATE)? else { return None };
        let speed = i16::from_le_bytes([low, high]);
        if usize::from(index) >= self.counted(1) || flags != 0 || !(-1024..=1024).contains(&speed) {
            return None;
        }
        let blend = (other != NONE).then_some((other, parameter));
        Some(StateRow { clip, blend, speed: I16F16::from_bits(i32::from(speed) << 8), transitions: (first, count) })
    }

    /// A transition; `None` if there is none of this index.
    pub fn transition(&self, index: usize) -> Option<TransitionRow> {
        let at = self.transitions_at() + TRANSITION * index;
        let &[cause, argument, low, high, to, kind, frames, first] = self.bytes.get(at..at + TRANSITION)? else { return None };
        if index >= self.counted(2) {
            return None;
        }
        let threshold = i16::from_le_bytes([low, high]);
        let cause = match cause {
            0 => Cause::End,
            1 => Cause::Input(argument),
            2 => Cause::Released(argument),
            3 => Cause::Event(argument),
            4 => Cause::Above(argument, threshold),
            5 => Cause::Below(argument, threshold),
            _ => return None,
        };
        let transition = match kind {
            0 => Transition::Cut,
            1 => Transition::Inertialized(frames),
            2 => Transition::Faded(frames),
            _ => return None,
        };
        Some(TransitionRow { cause, to, transition, first_frame: (first != IN_STEP).then_some(first) })
    }

    /// The least, the greatest and the first value of a parameter.
    fn parameter_row(&self, index: usize) -> [i16; 3] {
        let at = self.parameters_at() + PARAMETER * index;
        match self.bytes.get(at..at + PARAMETER) {
            Some(&[a, b, c, d, e, f]) => [[a, b], [c, d], [e, f]].map(i16::from_le_bytes),
            _ => [0; 3],
        }
    }

    /// The names of states, parameters and inputs, and the patterns of layers, in this order.
    fn names(&self) -> impl Iterator<Item = &'a [u8]> + use<'a> {
        let mut rest = self.bytes.get(self.names_at()..).unwrap_or_default();
        core::iter::from_fn(move || {
            let (len, after) = rest.split_first()?;
            let (name, after) = after.split_at_checked(usize::from(*len))?;
            rest = after;
            Some(name)
        })
    }

    /// Number of states.
    pub fn states(&self) -> usize {
        self.counted(1)
    }

    /// The name at an index among `count` that stand behind `before` others; empty for none, or one that is not UTF-8.
    fn name(&self, before: usize, count: usize, index: u8) -> &'a str {
        let name = self.names().skip(before).take(count).nth(index.into()).unwrap_or_default();
        core::str::from_utf8(name).unwrap_or("")
    }

    /// The name of a state; empty if it has none, or one that is not UTF-8.
    pub fn state_name(&self, state: u8) -> &'a str {
        self.name(0, self.counted(1), state)
    }

    /// Number of parameters.
    pub fn parameters(&self) -> usize {
        self.counted(3)
    }

    /// The name of a parameter; empty if it has none, or one that is not UTF-8.
    pub fn parameter_name(&self, parameter: u8) -> &'a str {
        self.name(self.counted(1), self.counted(3), parameter)
    }

    /// The least, the greatest and the first value of a parameter; zeros for one that the table lacks.
    pub fn range(&self, parameter: u8) -> [i16; 3] {
        if usize::from(parameter) < self.counted(3) { self.parameter_row(parameter.into()) } else { [0; 3] }
    }

    /// Number of inputs.
    pub fn inputs(&self) -> usize {
        self.counted(4)
    }

    /// The name of an input; empty if it has none, or one that is not UTF-8.
    pub fn input_name(&self, input: u8) -> &'a str {
        self.name(self.counted(1) + self.counted(3), self.counted(4), input)
    }

    /// The index of a parameter by its name.
    pub fn parameter(&self, name: &str) -> Option<u8> {
        let mut names = self.names().skip(self.counted(1)).take(self.counted(3));
        names.position(|other| other == name.as_bytes()).map(|index| index as u8)
    }

    /// The index of an input by its name.
    pub fn input(&self, name: &str) -> Option<u8> {
        let mut names = self.names().skip(self.counted(1) + self.counted(3)).take(self.counted(4));
        names.position(|other| other == name.as_bytes()).map(|index| index as u8)
    }
}

/// The body of the section of a state machine in a bank.
fn section(bank: &[u8]) -> Option<&[u8]> {
    let mut rest = bank.get(3..)?;
    loop {
        let (&kind, after) = rest.split_first()?;
        let (mut len, mut shift, mut body) = (0u32, 0u32, after);
        loop {
            let (&byte, after) = body.split_first()?;
            body = after;
            len |= u32::from(byte & 0x7f).checked_shl(shift)?;
            shift += 7;
            if byte < 0x80 {
                break;
            }
        }
        let (body, after) = body.split_at_checked(len as usize)?;
        if kind == SECTION {
            return Some(body);
        }
        rest = after;
    }
}

/// What a machine remembers: less than 64 bytes.
#[derive(Clone, Copy, Debug)]
pub struct Machine<'a> {
    table: Table<'a>,
    parameters: [i16; PARAMETERS],
    fired: u32,
    /// The inputs that the last update saw: fired or held.
    seen: u32,
    held: u32,
    state: u8,
    /// Whether the second track plays this state's second clip.
    blending: bool,
}

/// What an update did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Updated {
    /// The state that was entered, if one was.
    pub entered: Option<u8>,
    /// Whether events found the queue full.
    pub lost: Option<EventsLost>,
}

/// The frame at which a state's clip begins: one that plays backwards and is no loop begins at its last frame instead of frame 0, where it would be
/// over.
fn begun(frame: u32, clip: &Clip<'_>, speed: I16F16) -> u32 {
    if frame == 0 && speed < 0 && !clip.looped() { clip.frames().saturating_sub(1) } else { frame }
}

impl<'a> Machine<'a> {
    /// A machine in its first state.
    pub fn new(table: Table<'a>) -> Machine<'a> {
        let mut parameters = [0; PARAMETERS];
        for (index, parameter) in parameters.iter_mut().enumerate().take(table.counted(3)) {
            let [_, _, initial] = table.parameter_row(index);
            *parameter = initial;
        }
        Machine { table, parameters, fired: 0, seen: 0, held: 0, state: table.counted(5) as u8, blending: false }
    }

    /// Starts an animator of [`Machine::first_clip`] as the state says: at its speed, from the frame at which it begins. [`crate::Character`] does so.
    pub fn start(&self, animator: &mut Animator<'_, '_>) {
        let Some(row) = self.table.state(self.state) else { return };
        animator.set_speed(row.speed);
        let frame = begun(0, animator.track().clip(), row.speed);
        if frame > 0 {
            animator.begin_at(frame);
        }
    }

    /// The clip of the state, for [`Animator::new`].
    pub fn first_clip<'b>(&self, bank: &Bank<'b>) -> Result<Clip<'b>, Error> {
        let row = self.table.state(self.state).ok_or(Error::Machine(TableError::NoSuchState(self.state)))?;
        clip(bank, row.clip)
    }

    /// The table.
    pub fn table(&self) -> &Table<'a> {
        &self.table
    }

    /// The state.
    pub fn state(&self) -> u8 {
        self.state
    }

    /// Fires an input: it is seen by the next update alone. One that the table lacks does nothing.
    pub fn fire(&mut self, input: u8) {
        self.fired |= bit(input);
    }

    /// Holds an input down, or lets it go.
    pub fn hold(&mut self, input: u8, down: bool) {
        self.held = if down { self.held | bit(input) } else { self.held & !bit(input) };
    }

    /// Whether an input is held.
    pub fn is_held(&self, input: u8) -> bool {
        self.held & bit(input) != 0
    }

    /// Whether the last update saw an input, fired or held.
    pub fn was_seen(&self, input: u8) -> bool {
        self.seen & bit(input) != 0
    }

    /// Sets a parameter, within its range. One that the table lacks does nothing.
    pub fn set(&mut self, parameter: u8, value: i16) {
        let index = usize::from(parameter);
        let [least, most, _] = self.table.parameter_row(index);
        if let Some(own) = self.parameters.get_mut(index).filter(|_| index < self.table.counted(3)) {
            *own = value.max(least).min(most);
        }
    }

    /// A parameter's value; 0 for one that the table lacks.
    pub fn get(&self, parameter: u8) -> i16 {
        self.parameters.get(usize::from(parameter)).copied().unwrap_or(0)
    }

    /// Lets time pass: updates the animator, then makes at most one transition, the first in the table whose cause is there (those from any state
    /// come before the state's own, and do not lead to the state itself). A state that blends needs `second`, a track for any clip of
    /// the bank, else it plays its first clip alone. An error is of a clip that cannot be opened, or for which there is too little memory:
    /// the old state goes on.
    pub fn update<'b>(
        &mut self,
        elapsed_us: u32,
        bank: &Bank<'b>,
        animator: &mut Animator<'b, '_>,
        second: Option<&mut Track<'b, '_>>,
    ) -> Result<Updated, Error> {
        let lost = animator.update(elapsed_us).err();
        let entered = self.enter(bank, animator);
        (self.seen, self.fired) = (self.fired | self.held, 0);
        let entered = entered?;
        if let (Some(second), Some(row)) = (second, self.table.state(self.state)) {
            self.blend(&row, entered.is_some(), bank, animator, second)?;
        }
        Ok(Updated { entered, lost })
    }

    fn enter<'b>(&mut self, bank: &Bank<'b>, animator: &mut Animator<'b, '_>) -> Result<Option<u8>, Error> {
        let Some(now) = self.table.state(self.state) else { return Ok(None) };
        let own = usize::from(now.transitions.0)..usize::from(now.transitions.0) + usize::from(now.transitions.1);
        let any = 0..self.table.counted(6);
        let state = self.state;
        let mut rows = any.map(|index| (index, true)).chain(own.map(|index| (index, false)));
        let wanted = rows.find_map(|(index, any)| {
            let row = self.table.transition(index).filter(|row| !any || row.to != state)?;
            self.happens(row.cause, animator).then_some(row)
        });
        let Some(wanted) = wanted else { return Ok(None) };
        let Some(row) = self.table.state(wanted.to) else { return Ok(None) };
        let clip = clip(bank, row.clip)?;
        let frame = match wanted.first_frame {
            Some(frame) => frame.into(),
            // Without footsteps it begins at its first frame.
            None => {
                let (old, frame, part) = (animator.track().clip(), animator.track().frame(), animator.track().part());
                sync::in_step(old, frame, part, &clip, 0).map_or(0, |(frame, _)| frame)
            }
        };
        let frame = begun(frame, &clip, row.speed);
        animator.switch(clip, frame, row.speed, wanted.transition)?;
        (self.state, self.blending) = (wanted.to, false);
        Ok(Some(wanted.to))
    }

    fn happens(&self, cause: Cause, animator: &mut Animator<'_, '_>) -> bool {
        match cause {
            Cause::End => animator.track().ended(),
            Cause::Input(input) => (self.fired | self.held) & bit(input) != 0,
            Cause::Released(input) => self.held & bit(input) == 0,
            Cause::Event(id) => animator.events().iter().any(|fired| fired.id == u32::from(id)),
            Cause::Above(parameter, threshold) => self.get(parameter) > threshold,
            Cause::Below(parameter, threshold) => self.get(parameter) < threshold,
        }
    }

    /// Mixes the second clip in, in step with the first, and lets the first play at a speed between the two.
    fn blend<'b>(
        &mut self,
        row: &StateRow,
        entered: bool,
        bank: &Bank<'b>,
        animator: &mut Animator<'b, '_>,
        second: &mut Track<'b, '_>,
    ) -> Result<(), Error> {
        let Some((other, parameter)) = row.blend else { return Ok(()) };
        if entered || !self.blending {
            second.start(clip(bank, other)?, 0, row.speed)?;
            self.blending = true;
        }
        let [least, most, _] = self.table.parameter_row(parameter.into());
        let (way, whole) = (i32::from(self.get(parameter)) - i32::from(least), i32::from(most) - i32::from(least));
        let weight = Weight::from_bits((way << 15).checked_div(whole).unwrap_or(0).clamp(0, 1 << 15) as u16);
        let strides = (sync::stride(animator.track().clip()), sync::stride(second.clip()));
        if let (Ok(own), Ok(its)) = strides {
            // The stride takes a time between those of the two clips, whatever their frame rates.
            let time = |stride: u32, clip: &Clip<'_>| i64::from(stride) * i64::from(clip.frame_time_ns());
            let (own, its) = (time(own, animator.track().clip()), time(its, second.clip()));
            let mixed = own + (((its - own) * i64::from(weight.to_bits())) >> 15);
            let speed = (own.saturating_mul(i64::from(row.speed.to_bits()))).checked_div(mixed).unwrap_or(0);
            animator.set_speed(I16F16::from_bits(speed.clamp(-(4 << 16), 4 << 16) as i32));
            second.sync_to(animator.track())?;
        } else {
            second.seek(animator.track().frame());
        }
        animator.mix(second, weight)?;
        Ok(())
    }
}

/// The bit of an input in a set of them; 0 for one that no table has.
fn bit(input: u8) -> u32 {
    1u32.checked_shl(input.into()).unwrap_or(0)
}

/// A clip of a bank.
pub(crate) fn clip<'b>(bank: &Bank<'b>, index: u8) -> Result<Clip<'b>, Error> {
    let entry = bank.entries().nth(index.into()).ok_or(Error::Clip(OpenError::NoSuchClip))?;
    Ok(bank.open(&entry)?)
}
