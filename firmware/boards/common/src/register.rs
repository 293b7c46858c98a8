//! Registers of a machine.
#![allow(unsafe_code)]

use core::marker::PhantomData;
use core::ptr;

/// A register as wide as `T`.
#[derive(Debug)]
pub struct Register<T = u32>(usize, PhantomData<T>);

impl<T: Copy> Register<T> {
    /// The register at an address.
    ///
    /// # Safety
    /// The address is aligned for `T` and that of a register, or of memory that is no Rust value's: it may be read and written
    /// at any time.
    pub const unsafe fn at(address: usize) -> Self {
        Register(address, PhantomData)
    }

    /// Reads it.
    #[inline(always)]
    pub fn read(&self) -> T {
        // Safety: promised to `at`.
        unsafe { ptr::read_volatile(ptr::with_exposed_provenance(self.0)) }
    }

    /// Writes it.
    #[inline(always)]
    pub fn write(&self, value: T) {
        // Safety: as above.
        unsafe { ptr::write_volatile(ptr::with_exposed_provenance_mut(self.0), value) }
    }
}
