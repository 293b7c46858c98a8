//! For a host with WebAssembly: it provides `env.print` and calls `run`.
// The host and this program meet at plain C functions.
#![allow(unsafe_code)]

use core::panic::PanicInfo;

unsafe extern "C" {
    /// Prints `len` bytes of the program's memory.
    safe fn print(text: *const u8, len: usize);
}

/// Prints all lines; 0 if everything played.
// SAFETY: nothing else is named so.
#[unsafe(no_mangle)]
extern "C" fn run() -> i32 {
    i32::from(!crate::vectors::run(&mut |text| print(text.as_ptr(), text.len())))
}

#[panic_handler]
fn panic(_info: &PanicInfo) -> ! {
    core::arch::wasm32::unreachable()
}
