//! Memory-mapped registers.
#![allow(unsafe_code)]

use core::marker::PhantomData;
use core::ptr;

/// A register as wide as `T`.
#[derive(Debug)]
pub struct Register<T = u32>(usize, PhantomData<T>);

impl<T: Copy> Register<T> {
    /// Names the register at an address.
    ///
    /// # Safety
    /// The address is aligned for `T` and is that of a register, or of memory that belongs to no Rust value: it may be read and written
    /// at any time.
    pub const unsafe fn at(address: usize) -> Self {
        Register(address, PhantomData)
    }

    /// Reads the register.
    #[inline(always)]
    pub fn read(&self) -> T {
        // Safety: the caller of `at` guarantees it.
        unsafe { ptr::read_volatile(ptr::with_exposed_provenance(self.0)) }
    }

    /// Writes the register.
    #[inline(always)]
    pub fn write(&self, value: T) {
        // Safety: as above.
        unsafe { ptr::write_volatile(ptr::with_exposed_provenance_mut(self.0), value) }
    }
}
