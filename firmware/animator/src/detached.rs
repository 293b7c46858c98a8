//! Animators and characters apart from the memory that they play in, for programs that keep both in one structure.

use crate::animator::Animator;
use crate::character::{Character, Layer};
use crate::machine::{LAYERS, Machine};
use crate::mask::Mask;
use crate::memory::{LayerMemory, Memory};
use crate::track::Track;
use heapless::Vec;
use pantin::{Bank, ChannelState};

/// An [`Animator`] without its memory.
///
/// The memory has to be as the animator left it. In other memory the poses are wrong, and nothing panics.
#[derive(Debug)]
pub struct DetachedAnimator<'a>(Animator<'a, 'static>);

impl<'a, 'm> Animator<'a, 'm> {
    /// Gives the memory back.
    pub fn detach(self) -> DetachedAnimator<'a> {
        DetachedAnimator(self.in_memory(Memory {
            states: &mut [],
            values: &mut [],
            offsets: &mut [],
            pose: &mut [],
            groups: &mut [],
        }))
    }

    /// This animator in other memory.
    fn in_memory<'n>(self, memory: Memory<'n>) -> Animator<'a, 'n> {
        let Memory { states, values, offsets, pose, groups } = memory;
        let Animator {
            track,
            used_groups,
            left,
            left_then,
            rest_ns,
            carried,
            carrier,
            root,
            travel,
            place,
            motion,
            events,
            now,
            before,
            ..
        } = self;
        let track = track.in_memory(states, values);
        Animator {
            track,
            offsets,
            pose,
            groups,
            used_groups,
            left,
            left_then,
            rest_ns,
            carried,
            carrier,
            root,
            travel,
            place,
            motion,
            events,
            now,
            before,
        }
    }
}

impl<'a> DetachedAnimator<'a> {
    /// The animator in its memory again; `None` if there is less of it than it needs.
    pub fn attach<'m>(self, memory: Memory<'m>) -> Option<Animator<'a, 'm>> {
        let Memory { states, values, offsets, pose, groups } = memory;
        let [moving, channels] = self.0.track().needed();
        let (offsets, pose) = (offsets.get_mut(..channels)?, pose.get_mut(..channels)?);
        let enough = states.len() >= moving && values.len() >= channels && groups.len() >= self.0.used_groups;
        enough.then(|| self.0.in_memory(Memory { states, values, offsets, pose, groups }))
    }
}

/// A [`Character`] without its memory, which has to be as the character left it.
#[derive(Debug)]
pub struct DetachedCharacter<'a> {
    bank: Bank<'a>,
    machine: Machine<'a>,
    animator: DetachedAnimator<'a>,
    second: Option<Track<'a, 'static>>,
    layers: Vec<Layer<'a, 'static>, LAYERS>,
}

impl<'a, 'm> Character<'a, 'm> {
    /// Gives all memory back: the animator's, the second track's, that of layers and that of the feet.
    pub fn detach(self) -> DetachedCharacter<'a> {
        let Character { bank, machine, animator, second, layers, .. } = self;
        let second = second.map(|track| track.in_memory(&mut [], &mut []));
        let mut detached = Vec::new();
        for Layer { row, track, ramp, state, .. } in layers {
            let (track, mask) = (track.in_memory(&mut [], &mut []), Mask::empty());
            // As many as there were.
            let _ = detached.push(Layer { row, track, sampled: &mut [], mask, ramp, state });
        }
        DetachedCharacter { bank, machine, animator: animator.detach(), second, layers: detached }
    }
}

impl<'a> DetachedCharacter<'a> {
    /// The character in its memory again: that of the animator, of [`Character::lend_second`] if it was lent, and of each call of
    /// [`Character::lend_layer`] in their order; feet are lent again by [`Character::lend_feet`]. `None` if there is less of it than before.
    pub fn attach<'m>(
        self,
        memory: Memory<'m>,
        second: Option<(&'m mut [ChannelState], &'m mut [i32])>,
        layers: impl IntoIterator<Item = LayerMemory<'m>>,
    ) -> Option<Character<'a, 'm>> {
        let DetachedCharacter { bank, machine, animator, second: track, layers: detached } = self;
        let second = match track {
            Some(track) => {
                let (states, values) = second?;
                Some(attached(track, states, values)?)
            }
            None => None,
        };
        let mut attached_layers = Vec::new();
        let mut memories = layers.into_iter();
        for Layer { row, track, ramp, state, .. } in detached {
            let LayerMemory { states, values, sampled, words } = memories.next()?;
            let rig = track.clip().rig();
            let (sampled, mask) = (sampled.get_mut(..rig.channels())?, Mask::of_words(&rig, words)?);
            let track = attached(track, states, values)?;
            attached_layers.push(Layer { row, track, sampled, mask, ramp, state }).ok()?;
        }
        let animator = animator.attach(memory)?;
        Some(Character { bank, machine, animator, second, layers: attached_layers, feet: None })
    }
}

fn attached<'a, 'm>(track: Track<'a, '_>, states: &'m mut [ChannelState], values: &'m mut [i32]) -> Option<Track<'a, 'm>> {
    let [moving, channels] = track.needed();
    (states.len() >= moving && values.len() >= channels).then(|| track.in_memory(states, values))
}
