//! Plays clips as the firmware does, in WebAssembly: what tests compare the element's JavaScript with. One instance of this module plays all clips: each has a slot and a file in memory that the caller divides.
//!
//! ```text
//! base()                     -> the first address of the page's memory, all of which it divides and has grown itself
//! slot()                     -> bytes of a slot, whose address is a multiple of 16
//! start(slot)                makes a player without a clip
//! arrived(slot, file, bytes) reports where the file is and how many bytes of it have arrived: frames become playable while the rest is loading
//! apart(slot, rig)           says, before anything else, that a rig of that many bytes comes before a file without one
//! finish(slot)               reports the end of the file: the whole clip is checked
//! event(slot, n)             -> 1 if the clip has an n-th event, which `facts` then has; names are there after `finish`
//! aim(slot, w, h, o, t, how) sets the picture in pixels, the view in degrees, and how the camera stands
//! go(slot, frame)            moves to exactly that frame, forwards or backwards
//! strokes(slot)              -> number of strokes of the frame; the page may append those of a face
//! picture()                  -> address of the strokes, which all players share
//! grey(strokes)              -> address of the 128x64 display's pixels for them
//! ```
//! With the feature `character` it also plays state machines: `machine(slot, bank, bytes)`, then `update(slot, us)`, `input`, `set`, `name`, `passed`.
//! With the feature `poses` it also plays tables of raw values: `poses`.
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
#[cfg(feature = "character")]
mod steered;
mod world;

use facts::{Facts, Trouble};
use memory::Slot;
use pantin_web_module::Stroke;
use pantin_web_module::memory::{base as free_from, written};
use world::World;

/// Acts on the player of a slot.
fn with<T>(slot: *mut Slot, act: impl FnOnce(&mut World) -> T) -> T {
    // SAFETY: the page passes a slot that it has started. Exports are the only callers, none of them calls another or the page, and the memory has no
    // threads.
    act(unsafe { &mut (*slot).world })
}

fn code(outcome: Result<(), Trouble>) -> u32 {
    outcome.err().map_or(0, |trouble| trouble as u32)
}

/// Returns the first address of the page's memory.
// SAFETY: nothing else is named so; this holds for every export below.
#[unsafe(no_mangle)]
extern "C" fn base() -> *const u8 {
    free_from()
}

/// Returns the number of bytes of a slot.
#[unsafe(no_mangle)]
extern "C" fn slot() -> usize {
    size_of::<Slot>()
}

/// Makes a player without a clip, in memory with any content.
#[unsafe(no_mangle)]
extern "C" fn start(slot: *mut Slot) {
    // SAFETY: the page passes an address of its own with room for a slot.
    unsafe { (&raw mut (*slot).world).write(World::NEW) }
}

/// Handles that the file at `file`, a multiple of 16, has its first `bytes` bytes. The file may have moved since the last call.
#[unsafe(no_mangle)]
extern "C" fn arrived(slot: *mut Slot, file: *const u8, bytes: usize) -> u32 {
    // SAFETY: the page writes behind what it has reported, in a file that stays until its slot is started again or it has moved.
    let file = unsafe { written(file, bytes) };
    // SAFETY: the address of a field of the page's slot.
    let buffers = unsafe { &raw mut (*slot).buffers };
    with(slot, |world| code(world.arrived(file, buffers)))
}

/// Handles that the first `rig` bytes are the rig of the file that follows.
#[unsafe(no_mangle)]
extern "C" fn apart(slot: *mut Slot, rig: usize) {
    with(slot, |world| world.apart(rig));
}

/// Looks an event up by its place. Returns 0 after the last one.
#[unsafe(no_mangle)]
extern "C" fn event(slot: *mut Slot, index: usize) -> u32 {
    with(slot, |world| world.event(index).into())
}

/// Handles the end of the file.
#[unsafe(no_mangle)]
extern "C" fn finish(slot: *mut Slot) -> u32 {
    with(slot, |world| code(world.finish()))
}

/// Plays a table instead of a clip: `bytes` bytes at `file`, which are a rig of `rig` bytes, then from the next multiple of 4 on `frames` poses of raw
/// values.
#[cfg(feature = "poses")]
#[unsafe(no_mangle)]
extern "C" fn poses(
    slot: *mut Slot,
    file: *const u8,
    bytes: usize,
    rig: usize,
    frames: usize,
    frame_time_ns: u32,
    length_exponent: i32,
) -> u32 {
    // SAFETY: as in `arrived`.
    let file = unsafe { written(file, bytes) };
    with(slot, |world| code(world.poses(file, rig, frames, frame_time_ns, length_exponent as i8)))
}

/// Plays the state machine of a bank of `bytes` bytes instead of a clip.
#[cfg(feature = "character")]
#[unsafe(no_mangle)]
extern "C" fn machine(slot: *mut Slot, bank: *const u8, bytes: usize) -> u32 {
    // SAFETY: as in `arrived`; a slot has one character, which is gone when the slot is started again.
    let (bank, buffers) = unsafe { (written(bank, bytes), &mut (*slot).steered) };
    with(slot, |world| code(world.machine(bank, buffers)))
}

/// Lets a character's time pass. Returns its state, and 256 more if it was entered now.
#[cfg(feature = "character")]
#[unsafe(no_mangle)]
extern "C" fn update(slot: *mut Slot, elapsed_us: u32) -> u32 {
    with(slot, |world| world.update(elapsed_us))
}

/// Fires an input (2), holds it down (1) or lets it go (0).
#[cfg(feature = "character")]
#[unsafe(no_mangle)]
extern "C" fn input(slot: *mut Slot, index: u32, what: u32) {
    with(slot, |world| {
        world.steer(|character, _| match what {
            2 => character.fire(index as u8),
            what => character.hold(index as u8, what == 1),
        });
    });
}

/// Sets a parameter.
#[cfg(feature = "character")]
#[unsafe(no_mangle)]
extern "C" fn set(slot: *mut Slot, parameter: u32, value: i32) {
    with(slot, |world| world.steer(|character, _| character.set(parameter as u8, value.clamp(-32768, 32767) as i16)));
}

/// Returns the least (0), the greatest (1) or the first (2) value of a parameter.
#[cfg(feature = "character")]
#[unsafe(no_mangle)]
extern "C" fn range(slot: *mut Slot, parameter: u32, which: usize) -> i32 {
    with(slot, |world| world.steer(|character, _| character.range(parameter as u8, which)).into())
}

/// Returns 1 and puts the name into the facts, as that of an event, if there is a state (0), an input (1) or a parameter (2) of that number.
#[cfg(feature = "character")]
#[unsafe(no_mangle)]
extern "C" fn name(slot: *mut Slot, kind: u32, index: u32) -> u32 {
    with(slot, |world| world.steer(|character, facts| character.name(kind, index as u8, facts)).into())
}

/// Returns 1 and puts it into the facts, if the last update passed an n-th event.
#[cfg(feature = "character")]
#[unsafe(no_mangle)]
extern "C" fn passed(slot: *mut Slot, index: usize) -> u32 {
    with(slot, |world| world.steer(|character, facts| character.passed(index, facts)).into())
}

/// Sets the camera up for a picture of `width` x `height` pixels (at most 2047; no width shows no bars), seen from `orbit` degrees around the figure and `tilt`
/// degrees above the horizon. `how` is 1 for a camera that stands still, 0 for one that follows the figure, plus twice the axis that is up: 1 x, 2 y, 3 z; 0
/// for the rig's.
#[unsafe(no_mangle)]
extern "C" fn aim(slot: *mut Slot, width: u32, height: u32, orbit: i32, tilt: i32, how: u32) -> u32 {
    with(slot, |world| code(world.aim(width as u16, height as u16, orbit as i16, tilt as i16, how)))
}

/// Moves to a frame, or to the last playable one.
#[unsafe(no_mangle)]
extern "C" fn go(slot: *mut Slot, frame: u32) {
    with(slot, |world| world.go(frame));
}

/// Returns the address of the [`Facts`].
#[unsafe(no_mangle)]
extern "C" fn facts(slot: *mut Slot) -> *const Facts {
    with(slot, |world| world.facts() as *const Facts)
}

/// Collects the strokes of the frame and returns their number.
#[unsafe(no_mangle)]
extern "C" fn strokes(slot: *mut Slot) -> usize {
    // SAFETY: as of the slot.
    with(slot, |world| world.strokes(unsafe { memory::picture() }))
}

/// Returns the address of the strokes. The buffer holds [`picture::STROKES`].
#[unsafe(no_mangle)]
extern "C" fn picture() -> *const Stroke {
    // SAFETY: as of the slot; what is returned is the page's, which reads and writes it between calls.
    unsafe { memory::picture() }.strokes.as_ptr()
}

/// Draws the first `strokes` strokes on a display of 128x64 pixels and 16 greys, one byte per pixel: 17 times the grey. The camera must be set up for that
/// size.
#[unsafe(no_mangle)]
extern "C" fn grey(strokes: usize) -> *const u8 {
    // SAFETY: as of the slot.
    unsafe { memory::picture() }.draw(strokes).as_ptr()
}
