//! Plays one clip in a web page. An instance of this module is for one clip: its memory is laid out once, and goes with it.
//!
//! ```text
//! room(bytes)          -> where the file belongs; the page writes what has come to its front
//! arrived(bytes)       -> how many are there now: frames become playable while the rest is on its way
//! finish()             -> that was all: the clip is checked as a whole
//! aim(w, h, o, t)      -> picture in pixels, view in degrees
//! go(frame)            -> exactly that frame, forwards or backwards
//! strokes()            -> how many strokes the frame is drawn with; the page may put more behind them, of a face
//! picture()            -> where they stand
//! grey(strokes)        -> what the 128x64 display shows of them
//! ```
//! Answers of `arrived`, `finish`, `poses` and `aim` are a [`Trouble`], 0 for none. What there is to know stands in [`Facts`].
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

/// Mostly zeros, which do not stand in the file.
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

/// The file's first `bytes` bytes are there.
#[unsafe(no_mangle)]
extern "C" fn arrived(bytes: usize) -> u32 {
    with(|world| code(world.arrived(written(bytes))))
}

/// No more bytes will come.
#[unsafe(no_mangle)]
extern "C" fn finish() -> u32 {
    with(|world| code(world.finish()))
}

/// In place of a clip: a rig of `rig` bytes, then from a multiple of 4 on `frames` poses of raw values.
#[unsafe(no_mangle)]
extern "C" fn poses(rig: usize, frames: usize, frame_time_ns: u32, length_exponent: i32) -> u32 {
    with(|world| code(world.poses(rig, frames, frame_time_ns, length_exponent as i8)))
}

/// Sets the camera up for a picture of `width` x `height` pixels (at most 2047; no width shows no bars), seen from `orbit` degrees about the figure and `tilt` above
/// the horizon.
#[unsafe(no_mangle)]
extern "C" fn aim(width: u32, height: u32, orbit: i32, tilt: i32) -> u32 {
    with(|world| code(world.aim(width as u16, height as u16, orbit as i16, tilt as i16)))
}

/// Goes to a frame, or to the last one that is playable.
#[unsafe(no_mangle)]
extern "C" fn go(frame: u32) {
    with(|world| world.go(frame));
}

/// What is known of the clip and of the frame.
#[unsafe(no_mangle)]
extern "C" fn facts() -> *const Facts {
    with(|world| world.facts() as *const Facts)
}

/// Gathers what the frame is drawn with, and counts it.
#[unsafe(no_mangle)]
extern "C" fn strokes() -> usize {
    // SAFETY: as of the world.
    with(|world| world.strokes(unsafe { memory::picture() }))
}

/// Where strokes stand. There is room for [`picture::STROKES`].
#[unsafe(no_mangle)]
extern "C" fn picture() -> *const Stroke {
    // SAFETY: as of the world; what is returned is the page's, which reads and writes it between calls.
    unsafe { memory::picture() }.strokes.as_ptr()
}

/// Draws the first `strokes` strokes on a display of 128x64 pixels and 16 greys, a byte a pixel: 17 times the grey. The camera must be set up for that
/// size.
#[unsafe(no_mangle)]
extern "C" fn grey(strokes: usize) -> *const u8 {
    // SAFETY: as of the world.
    unsafe { memory::picture() }.draw(strokes).as_ptr()
}
