//! The module's statics.

use crate::picture::Picture;
use core::mem::MaybeUninit;
use pantin::codec::layout::MAX_CHANNELS;
use pantin::{ChannelState, SnapshotPos};
use pantin_web_module::Only;

/// Memory of a player for any clip.
pub struct FigureBuffers {
    pub states: [ChannelState; MAX_CHANNELS],
    pub pose: [i32; MAX_CHANNELS],
}

/// Memory for stepping back and seeking: for 22 channels, a snapshot at each of 512 frames.
pub struct Past {
    pub marks: [SnapshotPos; 512],
    pub states: [ChannelState; 32768],
    pub values: [i32; 32768],
}

macro_rules! zeroed {
    ($name:ident: $kind:ty) => {
        static $name: Only<MaybeUninit<$kind>> = Only::new(MaybeUninit::zeroed());
    };
}
zeroed!(SEAT: FigureBuffers);
zeroed!(PAST: Past);
zeroed!(PICTURE: Picture);

/// # Safety
/// No other user may hold it.
pub unsafe fn seat() -> &'static mut FigureBuffers {
    // SAFETY: the caller's promise; a seat is made of integers, for which zeros are values.
    unsafe { SEAT.get().assume_init_mut() }
}

/// # Safety
/// No other user may hold it.
pub unsafe fn past() -> &'static mut Past {
    // SAFETY: the caller's promise; it is made of integers, for which zeros are values.
    unsafe { PAST.get().assume_init_mut() }
}

/// # Safety
/// No other reference to it may be in use.
pub unsafe fn picture() -> &'static mut Picture {
    // SAFETY: the caller's promise; it is made of integers, for which zeros are values.
    unsafe { PICTURE.get().assume_init_mut() }
}
