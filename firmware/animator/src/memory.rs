//! The memory that the caller lends to an animator.

use crate::groups::Group;
use crate::transition::Offset;
use pantin::ChannelState;

/// Memory for an [`crate::Animator`]: 20 bytes for each moving channel, 24 for each channel (its value, its offset, the pose that comes out), and 6
/// for each group of channels.
#[derive(Debug)]
pub struct Memory<'m> {
    /// An element for each moving channel of the clip that has most.
    pub states: &'m mut [ChannelState],
    /// An element for each channel of the rig.
    pub values: &'m mut [i32],
    /// An element for each channel of the rig.
    pub offsets: &'m mut [Offset],
    /// An element for each channel of the rig.
    pub pose: &'m mut [i32],
    /// Elements as [`Group`] says.
    pub groups: &'m mut [Group],
}

/// [`Memory`] as one value that can be a `static`: for clips with up to `MOVING` moving channels, `CHANNELS` channels and as many groups.
#[derive(Clone, Debug)]
pub struct Workspace<const MOVING: usize, const CHANNELS: usize> {
    states: [ChannelState; MOVING],
    values: [i32; CHANNELS],
    offsets: [Offset; CHANNELS],
    pose: [i32; CHANNELS],
    groups: [Group; CHANNELS],
}

impl<const MOVING: usize, const CHANNELS: usize> Workspace<MOVING, CHANNELS> {
    /// Empty memory.
    pub const fn new() -> Self {
        Workspace {
            states: [ChannelState::NEW; MOVING],
            values: [0; CHANNELS],
            offsets: [Offset::ZERO; CHANNELS],
            pose: [0; CHANNELS],
            groups: [Group::NONE; CHANNELS],
        }
    }

    /// The memory, to be lent.
    pub fn lend(&mut self) -> Memory<'_> {
        let Workspace { states, values, offsets, pose, groups } = self;
        Memory { states, values, offsets, pose, groups }
    }
}

impl<const MOVING: usize, const CHANNELS: usize> Default for Workspace<MOVING, CHANNELS> {
    fn default() -> Self {
        Self::new()
    }
}

/// Memory for a layer of a [`crate::Character`]: 20 bytes for each moving channel of its clip, 8 for each channel of the rig, and a bit for each joint
/// and scalar.
#[derive(Debug)]
pub struct LayerMemory<'m> {
    /// An element for each moving channel of the layer's clip.
    pub states: &'m mut [ChannelState],
    /// An element for each channel of the rig.
    pub values: &'m mut [i32],
    /// An element for each channel of the rig.
    pub sampled: &'m mut [i32],
    /// As [`crate::Mask::new`] says. With an element more for each run of channels that the layer moves, it is mixed in fewer instructions.
    pub words: &'m mut [u32],
}

/// Words of a mask that holds the joints and scalars of every rig that a [`LayerWorkspace`] is for.
const WORDS: usize = 16;

/// [`LayerMemory`] as one value that can be a `static`: for a clip with up to `MOVING` moving channels, and a rig with up to `CHANNELS` channels and 512
/// joints and scalars.
#[derive(Clone, Debug)]
pub struct LayerWorkspace<const MOVING: usize, const CHANNELS: usize> {
    states: [ChannelState; MOVING],
    values: [i32; CHANNELS],
    sampled: [i32; CHANNELS],
    words: [u32; WORDS],
}

impl<const MOVING: usize, const CHANNELS: usize> LayerWorkspace<MOVING, CHANNELS> {
    /// Empty memory.
    pub const fn new() -> Self {
        LayerWorkspace { states: [ChannelState::NEW; MOVING], values: [0; CHANNELS], sampled: [0; CHANNELS], words: [0; WORDS] }
    }

    /// The memory, to be lent.
    pub fn lend(&mut self) -> LayerMemory<'_> {
        let LayerWorkspace { states, values, sampled, words } = self;
        LayerMemory { states, values, sampled, words }
    }
}

impl<const MOVING: usize, const CHANNELS: usize> Default for LayerWorkspace<MOVING, CHANNELS> {
    fn default() -> Self {
        Self::new()
    }
}
