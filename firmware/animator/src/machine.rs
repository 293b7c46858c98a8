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

use crate::animator::Animator;
use crate::events::EventsLost;
use crate::layer::Weight;
use crate::lead::Instants;
pub use crate::table::{
    Cause, Contact, Entry, FEET, FEET_SECTION, FEET_VERSION, FeetTable, FootRow, INPUTS, LAYERS, LayerRow, PARAMETERS, POINTS,
    SECTION, STATES, StateRow, Table, TableError, TransitionRow, VERSION,
};
use crate::track::Track;
use crate::{Error, sync};
use fixed::types::I16F16;
use pantin::{Bank, BankEntries, Clip, OpenError};

/// What a machine remembers: at most 112 bytes.
#[derive(Clone, Copy, Debug)]
pub struct Machine<'a> {
    table: Table<'a>,
    parameters: [i16; PARAMETERS],
    fired: u32,
    /// The inputs that the last update saw: fired or held.
    seen: u32,
    held: u32,
    /// Those that were held at the end of the last update.
    held_before: u32,
    state: u8,
    /// Whether the second track plays this state's second clip.
    blending: bool,
    /// How much of that clip is mixed in.
    mixed: Weight,
    /// Where both clips were in the last update, if they are in step.
    led: Option<Instants>,
    /// The transition that waits for a matching foot.
    waiting: Option<u8>,
}

/// A table of feet, and [`next_entry`], so that programs without feet have none of that.
pub(crate) type Entries<'a> = (FeetTable<'a>, fn(&FeetTable<'a>, u8, &Animator<'_, '_>) -> Option<(u32, u64)>);

/// How often the state changes in one instant, and at how many instants in the middle of an update, at most.
const CHANGES: usize = 4;

/// What a transition looks at: inputs that were fired or are held, those that are not held, and events after a number of them.
#[derive(Clone, Copy, Debug)]
struct Inputs {
    down: u32,
    up: u32,
    heard: usize,
}

/// What an update did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Updated {
    /// The state that was entered last, if one was.
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
        for (index, parameter) in parameters.iter_mut().enumerate().take(table.parameters()) {
            let [_, _, initial] = table.parameter_row(index);
            *parameter = initial;
        }
        Machine {
            table,
            parameters,
            fired: 0,
            seen: 0,
            held: 0,
            held_before: 0,
            state: table.first(),
            blending: false,
            mixed: Weight::ZERO,
            led: None,
            waiting: None,
        }
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
        if let Some(own) = self.parameters.get_mut(index).filter(|_| index < self.table.parameters()) {
            *own = value.max(least).min(most);
        }
    }

    /// A parameter's value; 0 for one that the table lacks.
    pub fn get(&self, parameter: u8) -> i16 {
        self.parameters.get(usize::from(parameter)).copied().unwrap_or(0)
    }

    /// Lets time pass: updates the animator, then makes the first transition in the table whose cause is there (those from any state come before the
    /// state's own, and do not lead to the state itself), and then those of the state that it leads to, up to 4 in all. Where a clip that is no loop
    /// ends, this happens in that instant, without inputs that came since the last update, and the rest of the time is the next state's: up to 4 times
    /// in an update. So the way does not depend on the display rate. A state that blends needs `second`, a track for any clip of the bank, else it plays its first clip alone. An error is of a clip that cannot be opened,
    /// or for which there is too little memory: the old state goes on.
    pub fn update<'b>(
        &mut self,
        elapsed_us: u32,
        bank: &Bank<'b>,
        animator: &mut Animator<'b, '_>,
        second: Option<&mut Track<'b, '_>>,
    ) -> Result<Updated, Error> {
        self.update_with(None, elapsed_us, bank, animator, second)
    }

    /// [`Machine::update`] with transitions that wait for the instants of a table of feet.
    pub(crate) fn update_with<'b>(
        &mut self,
        entries: Option<Entries<'_>>,
        elapsed_us: u32,
        bank: &Bank<'b>,
        animator: &mut Animator<'b, '_>,
        second: Option<&mut Track<'b, '_>>,
    ) -> Result<Updated, Error> {
        self.follow(elapsed_us);
        let updated = self.run(entries, u64::from(elapsed_us) * 1000, bank, animator, second);
        (self.seen, self.fired, self.held_before) = (self.fired | self.held, 0, self.held);
        updated
    }

    fn run<'b>(
        &mut self,
        entries: Option<Entries<'_>>,
        elapsed_ns: u64,
        bank: &Bank<'b>,
        animator: &mut Animator<'b, '_>,
        mut second: Option<&mut Track<'b, '_>>,
    ) -> Result<Updated, Error> {
        let mut updated = Updated::default();
        let mut left_ns = elapsed_ns;
        let mut before = Inputs { down: self.held & self.held_before, up: !(self.held | self.held_before), heard: 0 };
        for _ in 0..CHANGES {
            before.heard = animator.events().iter().count();
            let entry = self
                .waiting
                .and_then(|waiting| entries.and_then(|(table, find)| Some((waiting, find(&table, waiting, animator)?))));
            let entry = entry.filter(|(_, (_, ns))| *ns < left_ns);
            let whole_ns = entry.map_or(left_ns, |(_, (_, ns))| ns);
            let (rest_ns, outcome) = animator.play(whole_ns);
            left_ns = left_ns - whole_ns + rest_ns;
            updated.lost = outcome.err().or(updated.lost);
            if left_ns == 0 {
                break;
            }
            if let Some((waiting, (frame, _))) = entry {
                updated.entered =
                    self.make(waiting.into(), Some(frame), bank, animator, second.as_deref_mut())?.or(updated.entered);
                self.blend(bank, animator, second.as_deref_mut())?;
                continue;
            }
            let Some(state) = self.enter_all(entries, before, before, bank, animator, second.as_deref_mut())? else {
                break;
            };
            updated.entered = Some(state);
            self.blend(bank, animator, second.as_deref_mut())?;
        }
        animator.hold(left_ns);
        let held = Inputs { down: self.held, up: !self.held, ..before };
        let now = Inputs { down: self.fired | held.down, ..held };
        updated.entered = self.enter_all(entries, now, held, bank, animator, second.as_deref_mut())?.or(updated.entered);
        self.blend(bank, animator, second)?;
        Ok(updated)
    }

    /// Makes a transition, then those of the states that are entered: all in one instant, so that the display rate does not matter. Inputs are
    /// `first` for the first one and `then` for the others, of which none leads back. Returns the last state, if one was entered.
    fn enter_all<'b>(
        &mut self,
        entries: Option<Entries<'_>>,
        first: Inputs,
        then: Inputs,
        bank: &Bank<'b>,
        animator: &mut Animator<'b, '_>,
        mut second: Option<&mut Track<'b, '_>>,
    ) -> Result<Option<u8>, Error> {
        let (mut inputs, mut last) = (first, None);
        // Conditions that contradict each other change the state once.
        let mut been = 0;
        for _ in 0..CHANGES {
            been |= state_bit(self.state);
            let Some(state) = self.enter(entries, inputs, been, bank, animator, second.as_deref_mut())? else { break };
            (inputs, last) = (Inputs { heard: animator.events().iter().count(), ..then }, Some(state));
        }
        Ok(last)
    }

    /// Takes the first transition that may be taken now. Once there is more than one state in `been`, a transition that leads to one of them is
    /// left out.
    fn enter<'b>(
        &mut self,
        entries: Option<Entries<'_>>,
        inputs: Inputs,
        been: u64,
        bank: &Bank<'b>,
        animator: &mut Animator<'b, '_>,
        second: Option<&mut Track<'b, '_>>,
    ) -> Result<Option<u8>, Error> {
        let Some(now) = self.table.state(self.state) else { return Ok(None) };
        let own = usize::from(now.transitions.0)..usize::from(now.transitions.0) + usize::from(now.transitions.1);
        let any = 0..self.table.any_transitions();
        let state = self.state;
        let mut rows = any.map(|index| (index, true)).chain(own.map(|index| (index, false)));
        let wanted = rows.find_map(|(index, any)| {
            let row = self.table.transition(index).filter(|row| !any || row.to != state)?;
            // In its first state, a machine may start the same state again.
            let back = been != state_bit(state) && been & state_bit(row.to) != 0;
            (!back && self.happens(row.cause, inputs, animator)).then_some(index)
        });
        // One that waits is made unless one before it happens, and at the end of its clip.
        let waiting = self.waiting.map(usize::from);
        let wanted = wanted.filter(|index| waiting.is_none_or(|waiting| *index < waiting));
        let ended = waiting.filter(|_| animator.track().ended());
        let Some(wanted) = wanted.or(ended) else { return Ok(None) };
        if ended.is_none() && entries.is_some_and(|(table, find)| find(&table, wanted as u8, animator).is_some()) {
            self.waiting = Some(wanted as u8);
            return Ok(None);
        }
        self.make(wanted, None, bank, animator, second)
    }

    /// Makes a transition, to a frame of the new clip or to that which its row names. Returns the new state.
    fn make<'b>(
        &mut self,
        index: usize,
        frame: Option<u32>,
        bank: &Bank<'b>,
        animator: &mut Animator<'b, '_>,
        mut second: Option<&mut Track<'b, '_>>,
    ) -> Result<Option<u8>, Error> {
        let Some(wanted) = self.table.transition(index) else { return Ok(None) };
        let Some(row) = self.table.state(wanted.to) else { return Ok(None) };
        let clip = clip(bank, row.clip)?;
        let frame = match (frame, wanted.first_frame) {
            (Some(frame), _) => frame,
            (None, Some(frame)) => frame.into(),
            // Without footsteps it begins at its first frame.
            (None, None) => {
                let (old, frame, part) = (animator.track().clip(), animator.track().frame(), animator.track().part());
                sync::in_step(old, frame, part, &clip, 0).map_or(0, |(frame, _)| frame)
            }
        };
        let frame = begun(frame, &clip, row.speed);
        if self.blending {
            // Until here the pose has the first clip's part alone.
            self.blend(bank, animator, second.as_deref_mut())?;
        }
        let mixed = second.as_deref().filter(|_| self.blending).map(|second| (second, self.mixed));
        animator.switch_mixed(mixed, clip, frame, row.speed, wanted.transition)?;
        (self.state, self.blending, self.led, self.waiting) = (wanted.to, false, None, None);
        Ok(Some(wanted.to))
    }

    fn happens(&self, cause: Cause, inputs: Inputs, animator: &mut Animator<'_, '_>) -> bool {
        match cause {
            Cause::End => animator.track().ended(),
            Cause::Input(input) => inputs.down & bit(input) != 0,
            Cause::Released(input) => inputs.up & bit(input) != 0,
            Cause::Event(id) => animator.events().iter().skip(inputs.heard).any(|fired| fired.id == u32::from(id)),
            Cause::Above(parameter, threshold) => self.get(parameter) > threshold,
            Cause::Below(parameter, threshold) => self.get(parameter) < threshold,
        }
    }

    /// How much of the second clip a parameter mixes in.
    fn weight(&self, parameter: u8) -> Weight {
        let [least, most, _] = self.table.parameter_row(parameter.into());
        let (way, whole) = (i32::from(self.get(parameter)) - i32::from(least), i32::from(most) - i32::from(least));
        Weight::from_bits((way << 15).checked_div(whole).unwrap_or(0).clamp(0, 1 << 15) as u16)
    }

    /// Lets the blend follow its parameter.
    fn follow(&mut self, elapsed_us: u32) {
        let Some(row) = self.table.state(self.state).filter(|_| self.blending) else { return };
        let Some((_, parameter)) = row.blend else { return };
        let step = (u64::from(elapsed_us) << 15).div_ceil(u64::from(row.follow_us).max(1)).min(1 << 15) as u16;
        let (now, to) = (self.mixed.to_bits(), self.weight(parameter).to_bits());
        let to = if row.follow_us == 0 { to } else { to.clamp(now.saturating_sub(step), now.saturating_add(step)) };
        self.mixed = Weight::from_bits(to);
    }

    /// The clip, and its frame, whose feet the figure has: of two that are blended the one that there is more of. And whether there is some of both.
    pub(crate) fn on_the_ground(&self, animator: &Animator<'_, '_>, second: Option<&Track<'_, '_>>) -> (u8, u32, bool) {
        let row = self.table.state(self.state);
        let other = row.and_then(|row| row.blend).filter(|_| self.blending);
        let part = self.mixed.to_bits();
        match (other, second) {
            (Some((clip, _)), Some(track)) if part > 1 << 14 => (clip, track.frame(), part < 1 << 15),
            (other, _) => (row.map_or(0, |row| row.clip), animator.track().frame(), other.is_some() && part > 0),
        }
    }

    /// Mixes the second clip of a state that blends in, in step with the first, and lets the first play at a speed between the two.
    fn blend<'b>(
        &mut self,
        bank: &Bank<'b>,
        animator: &mut Animator<'b, '_>,
        second: Option<&mut Track<'b, '_>>,
    ) -> Result<(), Error> {
        let (Some(second), Some(row)) = (second, self.table.state(self.state)) else { return Ok(()) };
        let Some((other, parameter)) = row.blend else { return Ok(()) };
        if !self.blending {
            second.start(clip(bank, other)?, 0, row.speed)?;
            if second.clip().looped() {
                second.begin_lap(&animator.root);
            }
            (self.blending, self.mixed, self.led) =
                (true, if row.follow_us == 0 { self.weight(parameter) } else { Weight::ZERO }, None);
        }
        let weight = self.mixed;
        let strides = (sync::stride(animator.track().clip()), sync::stride(second.clip()));
        if let (Ok(own), Ok(its)) = strides {
            // The stride takes a time between those of the two clips, whatever their frame rates.
            let time = |stride: u32, clip: &Clip<'_>| i64::from(stride) * i64::from(clip.frame_time_ns());
            let (own, its) = (time(own, animator.track().clip()), time(its, second.clip()));
            let mixed = own + (((its - own) * i64::from(weight.to_bits())) >> 15);
            let speed = |time: i64| {
                let speed = (time.saturating_mul(i64::from(row.speed.to_bits()))).checked_div(mixed).unwrap_or(0);
                I16F16::from_bits(speed.clamp(-(4 << 16), 4 << 16) as i32)
            };
            animator.set_speed(speed(own));
            second.set_speed(speed(its));
            second.sync_to(animator.track())?;
            if animator.track().clip().looped() && second.clip().looped() {
                self.led = Some(animator.lead(second, weight, self.led));
            }
        } else {
            second.seek(animator.track().frame());
        }
        animator.mix(second, weight)?;
        Ok(())
    }
}

/// The frame at which the transition that waits begins in the new clip, and the time in ns until then, which is not before the one that runs has ended;
/// `None` if none waits, or if no such instant comes.
pub(crate) fn next_entry(table: &FeetTable<'_>, transition: u8, animator: &Animator<'_, '_>) -> Option<(u32, u64)> {
    let (track, left) = (animator.track(), animator.transition_left());
    let speed = track.speed().to_bits();
    if speed <= 0 {
        return None;
    }
    let clip = track.clip();
    let part = u64::from(track.part().to_bits());
    // In 2^-16 of a frame, rounded up to whole frames of the transition.
    let ended = part + u64::from(left) * u64::from(speed.unsigned_abs());
    let behind = ended.div_ceil(1 << 16) as u32;
    let from = track.frame() + behind;
    let from = if clip.looped() { from.checked_rem(clip.frames()).unwrap_or(0) } else { from };
    let (entry, ahead) = table.next_entry(transition, from, clip.frames(), clip.looped())?;
    let way = (u64::from(ahead + behind) << 16).saturating_sub(part);
    // Below 2^33 times 2^30, and rounded up so that the frame is reached.
    let ns = way.saturating_mul(u64::from(clip.frame_time_ns())).div_ceil(u64::from(speed.unsigned_abs()));
    Some((entry.start.into(), ns))
}

/// The bit of an input in a set of them; 0 for one that no table has.
fn bit(input: u8) -> u32 {
    1u32.checked_shl(input.into()).unwrap_or(0)
}

/// The bit of a state in a set of them.
fn state_bit(state: u8) -> u64 {
    1 << (state % 64)
}

/// A clip of a bank.
pub(crate) fn clip<'b>(bank: &Bank<'b>, index: u8) -> Result<Clip<'b>, Error> {
    ClipWalk::new(bank).open(index)
}

/// Opens clips of a bank: those after the last one without a walk through those before it.
pub(crate) struct ClipWalk<'b, 'p> {
    bank: &'p Bank<'b>,
    entries: BankEntries<'b>,
    next: u16,
}

impl<'b, 'p> ClipWalk<'b, 'p> {
    pub(crate) fn new(bank: &'p Bank<'b>) -> Self {
        ClipWalk { bank, entries: bank.entries(), next: 0 }
    }

    #[inline(never)]
    pub(crate) fn open(&mut self, index: u8) -> Result<Clip<'b>, Error> {
        let index = u16::from(index);
        if index < self.next {
            *self = ClipWalk::new(self.bank);
        }
        let entry = self.entries.nth(usize::from(index - self.next));
        self.next = index + 1;
        Ok(self.bank.open(&entry.ok_or(Error::Clip(OpenError::NoSuchClip))?)?)
    }
}
