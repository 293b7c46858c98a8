//! Converts one motion in a worker of a web page. An instance of this module converts one motion, and is then dropped with its memory.
//!
//! ```text
//! room(bytes)                    -> where the page writes that number of bytes
//! give(name, its len, bytes, ..) one of the motion's files; the first is the motion
//! convert(options, their len)    -> 1 if there is a clip; the options are JSON
//! output(which)                  -> the address of a result, and its length in the upper half
//! ```
//! The page provides `env.progress(part)`, part from 0 to 1, and `env.panicked(text, len)`.
// The page calls these functions, and finds and writes memory by plain addresses.
#![allow(unsafe_code)]

mod convert;
mod sources;

use convert::Outputs;
use std::cell::RefCell;
use std::path::PathBuf;

unsafe extern "C" {
    /// Reports the progress to the page, 0 to 1.
    safe fn progress(part: f64);
    /// Reports to the page why the module stops: `len` bytes of text.
    safe fn panicked(text: *const u8, len: usize);
}

thread_local! {
    static FILES: RefCell<Vec<(PathBuf, Vec<u8>)>> = const { RefCell::new(Vec::new()) };
    static OUTPUTS: RefCell<Outputs> = RefCell::default();
}

/// Reserves a number of bytes, permanently.
// SAFETY: nothing else is named so; this holds for every export below.
#[unsafe(no_mangle)]
extern "C" fn room(bytes: usize) -> *mut u8 {
    vec![0; bytes].leak().as_mut_ptr()
}

/// Frees memory of [`room`].
///
/// # Safety
/// `place` and `len` must come from a call of [`room`], and must not have been freed before.
unsafe fn taken(place: *mut u8, len: usize) -> Vec<u8> {
    // SAFETY: the caller's promise; `room` made a vector of this length that has no more capacity.
    unsafe { Vec::from_raw_parts(place, len, len) }
}

/// Adds one of the motion's files, name and content, both in memory of [`room`]. The motion itself comes first.
#[unsafe(no_mangle)]
extern "C" fn give(name: *mut u8, name_len: usize, bytes: *mut u8, len: usize) {
    // SAFETY: the page hands over each place once.
    let (name, bytes) = unsafe { (taken(name, name_len), taken(bytes, len)) };
    FILES.with_borrow_mut(|files| files.push((String::from_utf8_lossy(&name).into_owned().into(), bytes)));
}

/// Converts the added files. Returns 1 if there is a clip, 0 if there is none; the report has the reason: `kind`, `setting`, `remedy`, `place` and `text`.
#[unsafe(no_mangle)]
extern "C" fn convert(options: *mut u8, len: usize) -> u32 {
    std::panic::set_hook(Box::new(|info| {
        let text = info.to_string();
        panicked(text.as_ptr(), text.len());
    }));
    // SAFETY: the page hands over the place once.
    let options = unsafe { taken(options, len) };
    let made = convert::convert(FILES.take(), &options, &mut |part| progress(part));
    let good = made.is_ok();
    OUTPUTS.set(made.unwrap_or_else(|error| Outputs::failed(&error)));
    good.into()
}

/// Returns a result: 0 the report as JSON, 1 the clip, 2 the clip as a C header, 3 its rig, 4 the motion's own poses, one raw value per channel and frame.
#[unsafe(no_mangle)]
extern "C" fn output(which: usize) -> u64 {
    OUTPUTS.with_borrow(|outputs| {
        let bytes = outputs.parts.get(which).map_or(&[][..], Vec::as_slice);
        (bytes.len() as u64) << 32 | bytes.as_ptr() as u64
    })
}
