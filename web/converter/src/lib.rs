//! Converts one motion in a worker of a web page. An instance of this module converts one motion, and is then dropped with its memory.
//!
//! The page gives the motion's files by the protocol of `pantin-web-worker`; the first is the motion. Then:
//!
//! ```text
//! convert(options, their len)    -> 1 if there is a clip; the options are JSON
//! ```
//! Results: 0 the report as JSON, 1 the clip, 2 the clip as a C header, 3 its rig, 4 the motion's own poses, one raw value per channel and frame, 5 the clip as a .glb.
//! The page provides `env.progress(part)`, part from 0 to 1.
// The page calls this function, and finds and writes memory by plain addresses.
#![allow(unsafe_code)]

mod c_library;
mod convert;
mod sources;

use convert::Outputs;
use pantin_web_worker as worker;

unsafe extern "C" {
    /// Reports the progress to the page, 0 to 1.
    safe fn progress(part: f64);
}

/// Converts the files that the page gave. Returns 1 if there is a clip, 0 if there is none; the report has the reason: `kind`, `setting`, `remedy`, `place` and `text`.
// SAFETY: nothing else is named so.
#[unsafe(no_mangle)]
extern "C" fn convert(options: *mut u8, len: usize) -> u32 {
    worker::report_panics();
    // SAFETY: the page hands over the place once.
    let options = unsafe { worker::taken(options, len) };
    let files = worker::files().into_iter().map(|(name, bytes)| (name.into(), bytes)).collect();
    let made = convert::convert(files, &options, &mut |part| progress(part));
    let good = made.is_ok();
    worker::set_outputs(made.unwrap_or_else(|error| Outputs::failed(&error)).parts);
    good.into()
}
