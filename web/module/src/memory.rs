//! A module's memory: statics of fixed size, and above them what the page writes, which may grow.

use core::arch::wasm32;
use core::cell::UnsafeCell;

/// Maximum number of bytes that the page may write.
pub const MOST_BYTES: usize = 64 << 20;

const PAGE: usize = 1 << 16;

/// A static that only one user at a time changes.
pub struct Only<T>(UnsafeCell<T>);

// SAFETY: a module's memory is not shared, so there is one thread.
unsafe impl<T> Sync for Only<T> {}

impl<T> Only<T> {
    /// Wraps a value.
    pub const fn new(value: T) -> Self {
        Only(UnsafeCell::new(value))
    }

    /// Returns the value.
    ///
    /// # Safety
    /// No other reference to the value may be in use.
    #[allow(clippy::mut_from_ref)]
    pub unsafe fn get(&self) -> &mut T {
        // SAFETY: the caller's promise.
        unsafe { &mut *self.0.get() }
    }
}

unsafe extern "C" {
    /// A symbol of the linker; the memory above it is free.
    static __heap_base: u8;
}

fn base() -> *mut u8 {
    (&raw const __heap_base).cast_mut()
}

fn start() -> usize {
    (base() as usize).next_multiple_of(16)
}

/// The bytes above the statics.
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

/// Returns the `bytes` bytes that the page wrote. While they are in use, the page writes only behind them.
pub fn written(bytes: usize) -> &'static [u8] {
    let bytes = bytes.min(space());
    // SAFETY: it lies above the statics and below the memory's end; the page writes behind what it has said to be there only.
    unsafe { core::slice::from_raw_parts(room(0), bytes) }
}
