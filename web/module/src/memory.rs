//! A module's memory: statics of fixed size. What lies above them is the page's, which divides it, has it grown and writes it.

use core::cell::UnsafeCell;

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

/// Returns the first address of the memory that the page divides.
pub fn base() -> *const u8 {
    &raw const __heap_base
}

/// Returns the `bytes` bytes from `place` on, which the page wrote.
///
/// # Safety
/// They must lie in memory of the page, and the page must not change them while they are in use.
pub unsafe fn written(place: *const u8, bytes: usize) -> &'static [u8] {
    // SAFETY: the caller's promise.
    unsafe { core::slice::from_raw_parts(place, bytes) }
}
