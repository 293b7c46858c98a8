//! Plays one clip in a web page. An instance of this module is for one clip: its memory is laid out once, and goes with it.
//!
//! ```text
//! room(bytes)          -> where the file belongs; the page writes what has come to its front
//! arrived(bytes)       -> how many are there now: frames become playable while the rest is on its way
//! finish()             -> that was all: the clip is checked as a whole
//! aim(w, h, o, t, l)   -> picture in pixels, view in degrees, look
//! go(frame)            -> exactly that frame, forwards or backwards
//! strokes(), grey()    -> the frame as lines, or as the 128x64 display shows it
//! ```
//! Answers of `arrived`, `finish`, `poses` and `aim` are a [`Trouble`], 0 for none. What there is to know stands in [`Facts`].
#![no_std]
// The page calls these functions, and finds and writes memory by plain addresses.
#![allow(unsafe_code)]

mod actor;
mod arriving;
mod facts;
mod memory;
mod picture;
mod source;
mod world;

use core::mem::MaybeUninit;
use facts::{Facts, Trouble};
use memory::Only;
use picture::Stroke;
use world::World;

/// Made at the first call.
static WORLD: Only<MaybeUninit<World>> = Only::new(MaybeUninit::zeroed());
static MADE: Only<bool> = Only::new(false);

#[panic_handler]
fn panic(_info: &core::panic::PanicInfo) -> ! {
    core::arch::wasm32::unreachable()
}

fn with<T>(act: impl FnOnce(&mut World) -> T) -> T {
    // SAFETY: exports are the only callers, none of them calls another or the page, and the memory has no threads.
    let (world, made) = unsafe { (WORLD.get(), MADE.get()) };
    if !core::mem::replace(made, true) {
        world.write(World::new());
    }
    // SAFETY: it was written before it is read.
    act(unsafe { world.assume_init_mut() })
}

fn code(outcome: Result<(), Trouble>) -> u32 {
    outcome.err().map_or(0, |trouble| trouble as u32)
}

/// Makes room for a file of so many bytes, and tells where it begins; 0 if that is more than there may be. What lies there already stays.
// SAFETY: nothing else is named so; this holds for every export below.
#[unsafe(no_mangle)]
extern "C" fn room(bytes: usize) -> *mut u8 {
    memory::room(bytes)
}

/// The file's first `bytes` bytes are there.
#[unsafe(no_mangle)]
extern "C" fn arrived(bytes: usize) -> u32 {
    with(|world| code(world.arrived(memory::file(bytes))))
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

/// Sets the camera up for a picture of `width` x `height` pixels (at most 2047), seen from `orbit` degrees about the figure and `tilt` above
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

/// Gathers what the frame is drawn with: where it stands, and how many strokes they are in the upper half.
#[unsafe(no_mangle)]
extern "C" fn strokes() -> u64 {
    // SAFETY: as of the world; what was returned before is the page's, which reads it between calls.
    let strokes: &[Stroke] = with(|world| world.strokes(unsafe { memory::picture() }));
    (strokes.len() as u64) << 32 | strokes.as_ptr() as u64
}

/// The frame on a display of 128x64 pixels and 16 greys, a byte a pixel: 17 times the grey. The camera must be set up for that size.
#[unsafe(no_mangle)]
extern "C" fn grey() -> *const u8 {
    // SAFETY: as above.
    with(|world| world.grey(unsafe { memory::picture() })).as_ptr()
}
