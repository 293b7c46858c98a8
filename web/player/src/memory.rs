//! Memory of a player, which the page provides, and of the picture, which all players share.

use crate::picture::Picture;
use crate::world::World;
use core::mem::MaybeUninit;
use pantin::codec::layout::MAX_CHANNELS;
use pantin::{ChannelState, SnapshotPos};
use pantin_web_module::Only;

/// One player: the page provides [`size_of`] this many bytes, a multiple of 16, and calls `start` before anything else.
#[repr(C, align(16))]
pub struct Slot {
    pub world: World,
    pub buffers: Buffers,
    #[cfg(feature = "character")]
    pub steered: crate::steered::Buffers,
}

/// What a clip is played with. It is made of integers: any bits are values.
pub struct Buffers {
    pub states: [ChannelState; MAX_CHANNELS],
    pub pose: [i32; MAX_CHANNELS],
    pub past: Past,
}

/// Memory for stepping back and seeking: for 22 moving channels, 93 snapshots.
pub struct Past {
    pub marks: [SnapshotPos; 128],
    pub states: [ChannelState; 2048],
    pub values: [i32; 2048],
}

/// Integers, for which zeros are values.
static PICTURE: Only<MaybeUninit<Picture>> = Only::new(MaybeUninit::zeroed());

/// # Safety
/// No other reference to it may be in use.
pub unsafe fn picture() -> &'static mut Picture {
    // SAFETY: the caller's promise; it is made of integers, for which zeros are values.
    unsafe { PICTURE.get().assume_init_mut() }
}
