//! A module's memory: what has a fixed size is static, and above it lies what the page writes, which may grow.

use core::arch::wasm32;
use core::cell::UnsafeCell;

/// Bytes that the page may write at most.
pub const MOST_BYTES: usize = 64 << 20;

const PAGE: usize = 1 << 16;

/// A static that is changed by one at a time.
pub struct Only<T>(UnsafeCell<T>);

// SAFETY: a module's memory is not shared, so there is one thread.
unsafe impl<T> Sync for Only<T> {}

impl<T> Only<T> {
    /// Holds a value.
    pub const fn new(value: T) -> Self {
        Only(UnsafeCell::new(value))
    }

    /// The value.
    ///
    /// # Safety
    /// No other reference to it may be in use.
    #[allow(clippy::mut_from_ref)]
    pub unsafe fn get(&self) -> &mut T {
        // SAFETY: the caller's promise.
        unsafe { &mut *self.0.get() }
    }
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

/// Reserves a number of bytes and returns their address, a multiple of 16; null if there is not enough memory.
pub fn room(bytes: usize) -> *mut u8 {
    let missing = bytes.saturating_sub(space()).div_ceil(PAGE);
    if bytes > MOST_BYTES || (missing > 0 && wasm32::memory_grow(0, missing) == usize::MAX) {
        return core::ptr::null_mut();
    }
    base().wrapping_add(start() - base() as usize)
}

/// What the page wrote there, `bytes` of it. It writes behind that only as long as this is in use.
pub fn written(bytes: usize) -> &'static [u8] {
    let bytes = bytes.min(space());
    // SAFETY: it lies above the statics and below the memory's end; the page writes behind what it has said to be there only.
    unsafe { core::slice::from_raw_parts(room(0), bytes) }
}
