//! A state machine with all that it plays with: the animator, the second clip of a blend, and layers.

use crate::animator::Animator;
use crate::feet::{Feet, Hold, Instant, hold};
use crate::layer::{Ramp, Weight};
use crate::machine::{Entries, LAYERS, LayerRow, Machine, Table, Updated, clip, next_entry};
use crate::mask::Mask;
use crate::memory::{LayerMemory, Memory};
use crate::root::{self, Placement, Root};
use crate::track::Track;
use crate::{Error, machine::TableError};
use fixed::types::I16F16;
use heapless::Vec;
use pantin::{Bank, ChannelState, Clip, Player, Pose};

/// A layer of the machine's table.
#[derive(Debug)]
pub(crate) struct Layer<'a, 'm> {
    pub(crate) row: LayerRow<'a>,
    pub(crate) track: Track<'a, 'm>,
    pub(crate) sampled: &'m mut [i32],
    pub(crate) mask: Mask<'m>,
    pub(crate) ramp: Ramp,
    pub(crate) state: LayerState,
}

/// What a layer does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LayerState {
    Rests,
    Plays,
    Fades,
}

/// A figure that a state machine moves. The caller lends the memory of each part.
#[derive(Debug)]
pub struct Character<'a, 'm> {
    pub(crate) bank: Bank<'a>,
    pub(crate) machine: Machine<'a>,
    pub(crate) animator: Animator<'a, 'm>,
    pub(crate) second: Option<Track<'a, 'm>>,
    pub(crate) layers: Vec<Layer<'a, 'm>, LAYERS>,
    /// With what holds them, so that programs without feet have none of its code.
    pub(crate) feet: Option<(&'m mut Feet<'a>, Hold<'a>, Entries<'a>)>,
}

impl<'a, 'm> Character<'a, 'm> {
    /// Starts the state machine of a bank, whose bytes these are. States do not blend before [`Character::lend_second`], and a layer does not play
    /// before [`Character::lend_layer`]. The figure is carried by the first joint with positions that moves in one of the states' clips.
    pub fn new(bytes: &'a [u8], memory: Memory<'m>) -> Result<Self, Error> {
        let bank = Bank::new_checked(bytes)?;
        let machine = Machine::new(Table::of_checked(&bank).map_err(Error::Machine)?);
        let (carrier, player) = root::carrier(&bank, clips(machine.table()), memory.states, memory.values)?;
        // That of the first clip is mostly the one by which the carrier was found.
        let first = machine.table().state(machine.state()).map(|row| row.clip);
        let player = player.filter(|(clip, _)| Some(*clip) == first).map(|(_, player)| player);
        let mut animator = match player {
            Some(player) => Animator::of_player(carrier, player, memory)?,
            None => Animator::carried_by(carrier, machine.first_clip(&bank)?, memory)?,
        };
        machine.start(&mut animator);
        Ok(Character { bank, machine, animator, second: None, layers: Vec::new(), feet: None })
    }

    /// Lends what the second clips of blends need: `states` as [`Memory::states`], `values` as [`Memory::values`].
    pub fn lend_second(&mut self, states: &'m mut [ChannelState], values: &'m mut [i32]) -> Result<(), Error> {
        self.second = Some(Track::new(self.machine.first_clip(&self.bank)?, states, values)?);
        Ok(())
    }

    /// Lends what the table's next layer needs: the first call is for the first layer. A pattern that matches nothing is
    /// [`Error::NothingMatches`].
    pub fn lend_layer(&mut self, memory: LayerMemory<'m>) -> Result<(), Error> {
        let LayerMemory { states, values, sampled, words } = memory;
        let missing = Error::Machine(TableError::BadCount);
        let row = self.machine.table().layer(self.layers.len()).ok_or(missing)?;
        let clip = clip(&self.bank, row.clip)?;
        let (rig, needed) = (clip.rig(), clip.rig().channels());
        let given = sampled.len();
        let sampled = sampled.get_mut(..needed).ok_or(Error::TooSmall { what: "values of a layer", needed, given })?;
        let mut mask = Mask::new(&rig, words)?;
        for pattern in row.joints.split('\n') {
            mask.set(&rig, pattern, true)?;
        }
        let track = Track::idle(clip, states, values)?;
        let layer = Layer { row, track, sampled, mask, ramp: Ramp::at(Weight::ZERO), state: LayerState::Rests };
        self.layers.push(layer).map_err(|_| missing)
    }

    /// Lends what holds the feet, by the bank's table of feet: without one, [`Error::Machine`] of [`TableError::Missing`]. After [`Character::detach`] the
    /// same feet are lent again, and go on as they were.
    pub fn lend_feet(&mut self, feet: &'m mut Feet<'a>) -> Result<(), Error> {
        let table = feet.set_up(&self.bank, &self.animator)?;
        self.feet = Some((feet, hold, (table, next_entry)));
        Ok(())
    }

    /// What holds the feet, if it was lent.
    pub fn feet(&self) -> Option<&Feet<'a>> {
        self.feet.as_ref().map(|(feet, ..)| &**feet)
    }

    /// The machine, for inputs and parameters.
    pub fn machine(&mut self) -> &mut Machine<'a> {
        &mut self.machine
    }

    /// The state that plays.
    pub fn state(&self) -> u8 {
        self.machine.state()
    }

    /// The value of a parameter.
    pub fn parameter(&self, parameter: u8) -> i16 {
        self.machine.get(parameter)
    }

    /// Whether an input is held.
    pub fn is_held(&self, input: u8) -> bool {
        self.machine.is_held(input)
    }

    /// The machine's table.
    pub fn table(&self) -> &Table<'a> {
        self.machine.table()
    }

    /// The animator.
    pub fn animator(&mut self) -> &mut Animator<'a, 'm> {
        &mut self.animator
    }

    /// The pose of this instant, whose root stands at the origin, and where the figure is.
    pub fn pose(&self) -> (Pose<'_>, Placement) {
        (self.animator.pose(), self.animator.placement())
    }

    /// How much of a layer there is now.
    pub fn layer_weight(&self, layer: usize) -> Weight {
        self.layers.get(layer).map_or(Weight::ZERO, |layer| layer.ramp.weight())
    }

    /// Lets time pass: [`Machine::update`], then the layers and the feet. Events that were not taken are dropped first.
    pub fn update(&mut self, elapsed_us: u32) -> Result<Updated, Error> {
        self.animator.events().clear();
        let entries = self.feet.as_ref().map(|(.., entries)| *entries);
        let updated = self.machine.update_with(entries, elapsed_us, &self.bank, &mut self.animator, self.second.as_mut())?;
        for layer in &mut self.layers {
            layer.update(elapsed_us, &self.machine, &mut self.animator)?;
        }
        if let Some((feet, hold, _)) = &mut self.feet {
            let (clip, frame, blended) = self.machine.on_the_ground(&self.animator, self.second.as_ref());
            hold(feet, &mut self.animator, Instant { clip, frame, blended, entered: updated.entered.is_some(), elapsed_us })?;
        }
        Ok(updated)
    }
}

impl<'a> Layer<'a, '_> {
    fn update(&mut self, elapsed_us: u32, machine: &Machine<'a>, animator: &mut Animator<'a, '_>) -> Result<(), Error> {
        let allowed = self.row.states >> (machine.state() % 64) & 1 != 0;
        match self.state {
            LayerState::Rests if allowed && machine.was_seen(self.row.input) => {
                self.track.start(*self.track.clip(), 0, I16F16::ONE)?;
                if self.track.clip().form_ref() == animator.form() {
                    self.mask.prepare(animator.groups());
                }
                self.ramp.go_to(Weight::ONE, self.row.fade_us);
                self.state = LayerState::Plays;
            }
            LayerState::Rests => return Ok(()),
            LayerState::Plays | LayerState::Fades => {
                self.track.update(elapsed_us);
                self.ramp.advance(elapsed_us);
            }
        }
        if self.state == LayerState::Plays && (!allowed || self.is_over(machine)) {
            self.ramp.go_to(Weight::ZERO, self.row.fade_us);
            self.state = LayerState::Fades;
        }
        let weight = self.ramp.weight();
        if self.state == LayerState::Fades && weight == Weight::ZERO {
            self.state = LayerState::Rests;
            return Ok(());
        }
        self.track.sample(self.sampled);
        animator.layer(self.sampled, self.track.clip().form_ref(), &self.mask, weight)?;
        Ok(())
    }

    /// Whether the layer is to go: a loop when its input is let go, another clip when what is left of it is the time that it takes to go.
    fn is_over(&self, machine: &Machine<'_>) -> bool {
        let clip = self.track.clip();
        if clip.looped() {
            return !machine.is_held(self.row.input);
        }
        let left = u64::from(clip.frames().saturating_sub(self.track.frame() + 1));
        self.track.ended() || left * u64::from(clip.frame_time_ns()) <= u64::from(self.row.fade_us) * 1000
    }
}

/// The clip that the state machine of a bank begins with; its rig is that of all clips.
pub fn first_clip(bytes: &[u8]) -> Result<Clip<'_>, Error> {
    let bank = Bank::new_checked(bytes)?;
    Machine::new(Table::of_checked(&bank).map_err(Error::Machine)?).first_clip(&bank)
}

/// The indices of the clips of all states.
fn clips(table: &Table<'_>) -> impl Iterator<Item = u8> {
    (0..table.states()).filter_map(|state| table.state(state as u8)).map(|state| state.clip)
}

/// Poses of a clip that [`visit_poses`] visits.
const VISITS: u32 = 24;

/// Visits some poses of every state's clip, with the root at the origin as in [`Animator::pose`], for a camera that is to show all of
/// them. The memory is as that of a layer; it may be the one that is lent to it later.
pub fn visit_poses<'a>(
    bytes: &'a [u8],
    states: &mut [ChannelState],
    values: &mut [i32],
    sampled: &mut [i32],
    visit: &mut dyn FnMut(&Clip<'a>, &[i32]),
) -> Result<(), Error> {
    let bank = Bank::new_checked(bytes)?;
    let table = Table::of_checked(&bank).map_err(Error::Machine)?;
    let (carrier, _) = root::carrier(&bank, clips(&table), states, values)?;
    for index in clips(&table) {
        let clip = clip(&bank, index)?;
        let root = Root::of(&clip.rig(), &[], carrier);
        let (needed, given) = (clip.rig().channels(), sampled.len());
        let sampled = sampled.get_mut(..needed).ok_or(Error::TooSmall { what: "values", needed, given })?;
        let frames = clip.frames();
        let mut player = Player::new(clip, states, values)?;
        for frame in (0..frames).step_by(frames.div_ceil(VISITS).max(1) as usize) {
            while player.frame() < frame {
                player.step();
            }
            sampled.iter_mut().zip(player.pose().values).for_each(|(out, value)| *out = *value);
            if let Some(root) = &root {
                root.leave_place(sampled);
            }
            visit(&clip, sampled);
        }
    }
    Ok(())
}
