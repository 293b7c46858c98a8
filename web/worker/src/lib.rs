//! The protocol of modules in a worker of a web page: files in, results out. `web/page/wasm.js` is the page's side.
//!
//! ```text
//! room(bytes)                    -> where the page writes that number of bytes
//! give(name, its len, bytes, ..) a file
//! output(which)                  -> the address of a result, and its length in the upper half
//! ```
//! A module that links this crate exports these functions, and adds its own, which works on the files. The page provides `env.panicked(text, len)`.
// The page calls these functions, and finds and writes memory by plain addresses.
#![allow(unsafe_code)]

use std::cell::RefCell;

unsafe extern "C" {
    /// Reports to the page why the module stops: `len` bytes of text.
    safe fn panicked(text: *const u8, len: usize);
}

thread_local! {
    static FILES: RefCell<Vec<(String, Vec<u8>)>> = const { RefCell::new(Vec::new()) };
    static OUTPUTS: RefCell<Vec<Vec<u8>>> = const { RefCell::new(Vec::new()) };
}

/// Lets panics be reported to the page.
pub fn report_panics() {
    std::panic::set_hook(Box::new(|info| {
        let text = info.to_string();
        panicked(text.as_ptr(), text.len());
    }));
}

/// Returns the files that the page gave since the last call, in its order: names and contents.
pub fn files() -> Vec<(String, Vec<u8>)> {
    FILES.take()
}

/// Sets the results, in place of the last ones.
pub fn set_outputs(outputs: impl Into<Vec<Vec<u8>>>) {
    OUTPUTS.set(outputs.into());
}

/// Takes back memory of [`room`].
///
/// # Safety
/// `place` and `len` must come from a call of [`room`], and must not have been taken back before.
pub unsafe fn taken(place: *mut u8, len: usize) -> Vec<u8> {
    // SAFETY: the caller's promise; `room` made a vector of this length that has no more capacity.
    unsafe { Vec::from_raw_parts(place, len, len) }
}

/// Reserves a number of bytes, until they are taken back.
// SAFETY: nothing else is named so; this holds for every export below.
#[unsafe(no_mangle)]
extern "C" fn room(bytes: usize) -> *mut u8 {
    vec![0; bytes].leak().as_mut_ptr()
}

/// Adds a file, name and content, both in memory of [`room`].
#[unsafe(no_mangle)]
extern "C" fn give(name: *mut u8, name_len: usize, bytes: *mut u8, len: usize) {
    // SAFETY: the page hands over each place once.
    let (name, bytes) = unsafe { (taken(name, name_len), taken(bytes, len)) };
    FILES.with_borrow_mut(|files| files.push((String::from_utf8_lossy(&name).into_owned(), bytes)));
}

/// Returns a result; one that is not there is empty.
#[unsafe(no_mangle)]
extern "C" fn output(which: usize) -> u64 {
    OUTPUTS.with_borrow(|outputs| {
        let bytes = outputs.get(which).map_or(&[][..], Vec::as_slice);
        (bytes.len() as u64) << 32 | bytes.as_ptr() as u64
    })
}
