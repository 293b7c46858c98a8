//! A character: the state machine of a bank, which the page steers.

use crate::facts::{Facts, Trouble};
use core::mem::MaybeUninit;
use pantin::{ChannelState, Clip, Pose, Rig};
use pantin_animator::machine::{LAYERS, TableError};
use pantin_animator::{Character, Error, Feet, Group, LayerMemory, Memory, Offset, first_clip, visit_poses};
use pantin_figure::Stand;

/// Channels of the rig, at most.
const CHANNELS: usize = 512;

/// What a character is played with. All but groups and feet is made of integers: any bits are values.
pub struct Buffers {
    states: [ChannelState; CHANNELS],
    values: [i32; CHANNELS],
    offsets: [Offset; CHANNELS],
    pose: [i32; CHANNELS],
    groups: [MaybeUninit<Group>; CHANNELS],
    second: TrackMemory,
    layers: [Layer; LAYERS],
    visited: Layer,
    feet: MaybeUninit<Feet<'static>>,
}

struct TrackMemory {
    states: [ChannelState; CHANNELS],
    values: [i32; CHANNELS],
}

struct Layer {
    track: TrackMemory,
    sampled: [i32; CHANNELS],
    words: [u32; CHANNELS / 32],
}

/// A character at play.
pub struct Steered {
    character: Character<'static, 'static>,
    bank: &'static [u8],
    visited: &'static mut Layer,
    /// What of the first clip the page reads: its rig and its form.
    first: Clip<'static>,
}

impl From<Error> for Trouble {
    fn from(error: Error) -> Trouble {
        match error {
            Error::Clip(error) => error.into(),
            Error::Player(_) | Error::TooSmall { .. } => Trouble::TooBig,
            _ => Trouble::Malformed,
        }
    }
}

impl Steered {
    /// Starts the state machine of a bank.
    pub fn new(bank: &'static [u8], buffers: &'static mut Buffers) -> Result<Steered, Trouble> {
        let Buffers { states, values, offsets, pose, groups, second, layers, visited, feet } = buffers;
        groups.fill(MaybeUninit::new(Group::NONE));
        // SAFETY: all of them were written, and a wrapped value lies as its own.
        let groups = unsafe { &mut *(&raw mut *groups).cast::<[Group; CHANNELS]>() };
        let mut character = Character::new(bank, Memory { states, values, offsets, pose, groups })?;
        character.lend_second(&mut second.states, &mut second.values)?;
        for Layer { track, sampled, words } in layers.iter_mut().take(character.table().layers()) {
            let TrackMemory { states, values } = track;
            character.lend_layer(LayerMemory { states, values, sampled, words })?;
        }
        match character.lend_feet(feet.write(Feet::new())) {
            // A bank without feet.
            Ok(()) | Err(Error::Machine(TableError::Missing)) => {}
            Err(error) => return Err(error.into()),
        }
        Ok(Steered { character, bank, visited, first: first_clip(bank)? })
    }

    pub fn rig(&self) -> Rig<'static> {
        self.first.rig()
    }

    pub fn pose(&self) -> Pose<'_> {
        self.character.pose().0
    }

    /// Where the figure stands.
    pub fn stand(&self) -> Stand {
        let (_, placement) = self.character.pose();
        Stand { place: placement.place, heading: placement.heading }
    }

    /// Visits some poses of all states.
    pub fn visit(&mut self, visit: &mut dyn FnMut(&[i32])) -> Result<(), Trouble> {
        let Layer { track, sampled, .. } = &mut *self.visited;
        visit_poses(self.bank, &mut track.states, &mut track.values, sampled, &mut |_, values| visit(values))?;
        Ok(())
    }

    /// Lets time pass, and returns the state; 256 more if it was entered now.
    pub fn update(&mut self, elapsed_us: u32) -> u32 {
        let entered = self.character.update(elapsed_us).is_ok_and(|updated| updated.entered.is_some());
        u32::from(self.character.state()) | u32::from(entered) << 8
    }

    pub fn fire(&mut self, input: u8) {
        self.character.machine().fire(input);
    }

    pub fn hold(&mut self, input: u8, down: bool) {
        self.character.machine().hold(input, down);
    }

    pub fn set(&mut self, parameter: u8, value: i16) {
        self.character.machine().set(parameter, value);
    }

    /// Least, most and first value of a parameter, as its place in the list says.
    pub fn range(&self, parameter: u8, which: usize) -> i16 {
        self.character.table().range(parameter).get(which).copied().unwrap_or(0)
    }

    /// Looks up the name of a state (0), an input (1) or a parameter (2); false after the last one.
    pub fn name(&self, kind: u32, index: u8, facts: &mut Facts) -> bool {
        let table = self.character.table();
        let (count, name) = match kind {
            0 => (table.states(), table.state_name(index)),
            1 => (table.inputs(), table.input_name(index)),
            _ => (table.parameters(), table.parameter_name(index)),
        };
        (facts.event_name_at, facts.event_name_len) = (name.as_ptr() as usize, name.len());
        usize::from(index) < count
    }

    /// Looks up the n-th event that the last update passed; false after the last one.
    pub fn passed(&mut self, index: usize, facts: &mut Facts) -> bool {
        let clip = *self.character.animator().track().clip();
        let Some(event) = self.character.animator().events().iter().nth(index) else { return false };
        let name = clip.event_name(event.id).unwrap_or_default();
        (facts.event_frame, facts.event_id) = (event.frame, event.id);
        (facts.event_name_at, facts.event_name_len) = (name.as_ptr() as usize, name.len());
        true
    }

    /// Fills in the facts: a character has the one frame of this instant.
    pub fn tell(&self, facts: &mut Facts) {
        (facts.frames, facts.playable, facts.frame_time_ns) = (1, 1, self.first.frame_time_ns());
    }
}
