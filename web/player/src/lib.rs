//! Plays one clip in a web page. An instance of this module plays one clip, and is then dropped with its memory.
//!
//! ```text
//! room(bytes)          -> address for the file; the page writes the received bytes there
//! arrived(bytes)       reports the number of received bytes: frames become playable while the rest is loading
//! apart(rig)           says, before anything else, that a rig of that many bytes comes before a file without one
//! finish()             reports the end of the file: the whole clip is checked
//! event(n)             -> 1 if the clip has an n-th event, which `facts` then has; names are there after `finish`
//! aim(w, h, o, t)      sets the picture in pixels and the view in degrees
//! go(frame)            moves to exactly that frame, forwards or backwards
//! strokes()            -> number of strokes of the frame; the page may append those of a face
//! picture()            -> address of the strokes
//! grey(strokes)        -> address of the 128x64 display's pixels for them
//! ```
//! `arrived`, `finish`, `poses` and `aim` return a [`Trouble`], 0 for none. [`Facts`] describes the clip and the frame.
#![no_std]
// The page calls these functions, and finds and writes memory by plain addresses.
#![allow(unsafe_code)]

mod actor;
mod arriving;
mod facts;
mod grey;
mod memory;
mod picture;
mod source;
mod world;

use facts::{Facts, Trouble};
use pantin_web_module::memory::{room as make_room, written};
use pantin_web_module::{Only, Stroke};
use world::World;

/// Mostly zeros, which the module's file does not store.
static WORLD: Only<World> = Only::new(World::NEW);

fn with<T>(act: impl FnOnce(&mut World) -> T) -> T {
    // SAFETY: exports are the only callers, none of them calls another or the page, and the memory has no threads.
    act(unsafe { WORLD.get() })
}

fn code(outcome: Result<(), Trouble>) -> u32 {
    outcome.err().map_or(0, |trouble| trouble as u32)
}

/// Reserves memory for a file of a number of bytes and returns its address; 0 if that exceeds the limit. Bytes that are there already stay.
// SAFETY: nothing else is named so; this holds for every export below.
#[unsafe(no_mangle)]
extern "C" fn room(bytes: usize) -> *mut u8 {
    make_room(bytes)
}

/// Handles that the file's first `bytes` bytes have arrived.
#[unsafe(no_mangle)]
extern "C" fn arrived(bytes: usize) -> u32 {
    with(|world| code(world.arrived(written(bytes))))
}

/// Handles that the first `rig` bytes are the rig of the file that follows.
#[unsafe(no_mangle)]
extern "C" fn apart(rig: usize) {
    with(|world| world.apart(rig));
}

/// Looks an event up by its place. Returns 0 after the last one.
#[unsafe(no_mangle)]
extern "C" fn event(index: usize) -> u32 {
    with(|world| world.event(index).into())
}

/// Handles the end of the file.
#[unsafe(no_mangle)]
extern "C" fn finish() -> u32 {
    with(|world| code(world.finish()))
}

/// Plays a table instead of a clip: a rig of `rig` bytes, then from the next multiple of 4 on `frames` poses of raw values.
#[unsafe(no_mangle)]
extern "C" fn poses(rig: usize, frames: usize, frame_time_ns: u32, length_exponent: i32) -> u32 {
    with(|world| code(world.poses(rig, frames, frame_time_ns, length_exponent as i8)))
}

/// Sets the camera up for a picture of `width` x `height` pixels (at most 2047; no width shows no bars), seen from `orbit` degrees around the figure and `tilt` degrees
/// above the horizon.
#[unsafe(no_mangle)]
extern "C" fn aim(width: u32, height: u32, orbit: i32, tilt: i32) -> u32 {
    with(|world| code(world.aim(width as u16, height as u16, orbit as i16, tilt as i16)))
}

/// Moves to a frame, or to the last playable one.
#[unsafe(no_mangle)]
extern "C" fn go(frame: u32) {
    with(|world| world.go(frame));
}

/// Returns the address of the [`Facts`].
#[unsafe(no_mangle)]
extern "C" fn facts() -> *const Facts {
    with(|world| world.facts() as *const Facts)
}

/// Collects the strokes of the frame and returns their number.
#[unsafe(no_mangle)]
extern "C" fn strokes() -> usize {
    // SAFETY: as of the world.
    with(|world| world.strokes(unsafe { memory::picture() }))
}

/// Returns the address of the strokes. The buffer holds [`picture::STROKES`].
#[unsafe(no_mangle)]
extern "C" fn picture() -> *const Stroke {
    // SAFETY: as of the world; what is returned is the page's, which reads and writes it between calls.
    unsafe { memory::picture() }.strokes.as_ptr()
}

/// Draws the first `strokes` strokes on a display of 128x64 pixels and 16 greys, one byte per pixel: 17 times the grey. The camera must be set up for that
/// size.
#[unsafe(no_mangle)]
extern "C" fn grey(strokes: usize) -> *const u8 {
    // SAFETY: as of the world.
    unsafe { memory::picture() }.draw(strokes).as_ptr()
}
