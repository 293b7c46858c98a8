//! The module's memory: what has a fixed size is static, and above it lies the file, which may grow.

use crate::picture::Picture;
use core::arch::wasm32;
use core::cell::UnsafeCell;
use pantin::layout::MAX_CHANNELS;
use pantin::{ChannelState, Mark};

/// Bytes that a file may have at most.
pub const MOST_BYTES: usize = 64 << 20;
/// Bytes of a stream's window.
pub const WINDOW: usize = 2048;

const PAGE: usize = 1 << 16;

/// A static that is changed by one at a time.
pub struct Only<T>(UnsafeCell<T>);

// SAFETY: the module's memory is not shared, so there is one thread.
unsafe impl<T> Sync for Only<T> {}

impl<T> Only<T> {
    pub const fn new(value: T) -> Self {
        Only(UnsafeCell::new(value))
    }

    /// # Safety
    /// No other reference to it may be in use.
    #[allow(clippy::mut_from_ref)]
    pub unsafe fn get(&self) -> &mut T {
        // SAFETY: the caller's promise.
        unsafe { &mut *self.0.get() }
    }
}

/// What a stream or a player needs for any clip.
pub struct Seat {
    pub states: [ChannelState; MAX_CHANNELS],
    pub pose: [i32; MAX_CHANNELS],
    pub window: [u8; WINDOW],
}

/// What going back and seeking use: for 22 channels, a snapshot each frame of 512.
pub struct Past {
    pub marks: [Mark; 512],
    pub states: [ChannelState; 32768],
    pub values: [i32; 32768],
}

macro_rules! zeroed {
    ($name:ident: $kind:ty) => {
        static $name: Only<core::mem::MaybeUninit<$kind>> = Only::new(core::mem::MaybeUninit::zeroed());
    };
}
zeroed!(SCOUT: Seat);
zeroed!(SHOWN: Seat);
zeroed!(WHOLE: Seat);
zeroed!(PAST: Past);
zeroed!(PICTURE: Picture);

/// Whose seat it is.
#[derive(Clone, Copy)]
pub enum Who {
    Scout,
    Shown,
    Whole,
}

/// # Safety
/// Nobody may sit there any more.
pub unsafe fn seat(who: Who) -> &'static mut Seat {
    let seat = match who {
        Who::Scout => &SCOUT,
        Who::Shown => &SHOWN,
        Who::Whole => &WHOLE,
    };
    // SAFETY: the caller's promise; a seat is made of integers, for which zeros are values.
    unsafe { seat.get().assume_init_mut() }
}

/// # Safety
/// To be called once.
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

unsafe extern "C" {
    /// The linker's: memory above it is nobody's.
    static __heap_base: u8;
}

fn base() -> *mut u8 {
    (&raw const __heap_base).cast_mut()
}

fn start() -> usize {
    (base() as usize).next_multiple_of(16)
}

/// Bytes above the statics.
fn space() -> usize {
    wasm32::memory_size(0) * PAGE - start()
}

/// Makes room for a file, and tells where it begins; null if there is none.
pub fn room(bytes: usize) -> *mut u8 {
    let missing = bytes.saturating_sub(space()).div_ceil(PAGE);
    if bytes > MOST_BYTES || (missing > 0 && wasm32::memory_grow(0, missing) == usize::MAX) {
        return core::ptr::null_mut();
    }
    base().wrapping_add(start() - base() as usize)
}

/// The front of the file.
pub fn file(bytes: usize) -> &'static [u8] {
    let bytes = bytes.min(space());
    // SAFETY: it lies above the statics and below the memory's end; the page writes behind what it has said to be there only.
    unsafe { core::slice::from_raw_parts(room(0), bytes) }
}
