//! Draws the faces of clips, next to the player's module: a page loads this module when a clip may drive a face. One instance draws all faces of a page, each
//! in a slot of memory that the page divides.
//!
//! ```text
//! base()                   -> the first address of the page's memory, all of which it divides and has grown itself
//! slot()                   -> bytes of a slot, whose address is a multiple of 16
//! bind(slot, scalars, bytes, count, first) -> whether these scalars, which the page wrote, drive a face
//! aim(slot, w, h, shift, o, t) sets the picture in pixels, its shift to the right, the view in degrees
//! place(slot, pose, channels) -> number of strokes of the pose that the page wrote
//! picture()                -> address of the strokes, which all faces share
//! ```
#![no_std]
// The page calls these functions, and finds and writes memory by plain addresses.
#![allow(unsafe_code)]

use pantin::Scalars;
use pantin_face::{Binding, FaceRenderer, FaceView, MODEL, Model, Morph, VERTICES, Weights};
use pantin_figure::Canvas;
use pantin_web_module::memory::{base as free_from, written};
use pantin_web_module::{Only, Stroke};

/// Maximum number of lines of a face, including its mesh.
const STROKES: usize = 3072;

#[repr(C, align(16))]
struct Slot {
    model: Option<Model<'static>>,
    binding: Binding,
    morph: Morph<VERTICES>,
    renderer: FaceRenderer<VERTICES>,
}

/// Zeros, so that the module's file does not store them.
static PICTURE: Only<[Stroke; STROKES]> = Only::new([Stroke::NONE; STROKES]);

fn picture_of_all() -> &'static mut [Stroke; STROKES] {
    // SAFETY: exports are the only callers, none of them calls another or the page, and the memory has no threads.
    unsafe { PICTURE.get() }
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

/// Makes a face in a slot with any content. Returns whether `count` scalars, the first of which is channel `first`, drive it. The page has written the rig's
/// bytes from these scalars on.
#[unsafe(no_mangle)]
extern "C" fn bind(slot: *mut Slot, scalars: *const u8, bytes: usize, count: usize, first: usize) -> bool {
    let face = Slot { model: None, binding: Binding::EMPTY, morph: Morph::EMPTY, renderer: FaceRenderer::EMPTY };
    // SAFETY: the page passes an address of its own with room for a slot, and no other call has it.
    let face = unsafe {
        slot.write(face);
        &mut *slot
    };
    let Ok(model) = Model::new_checked(MODEL) else { return false };
    // SAFETY: the page has written them, and they are read in this call only.
    let scalars = unsafe { written(scalars, bytes) };
    face.binding.bind_scalars(Scalars::of_bytes(scalars, count), first, &model);
    face.model = Some(model);
    face.binding.is_face() && face.morph.set_up(&model).is_ok()
}

/// Sets the camera up for a part of the picture of `width` x `height` pixels (at most 2047), `right` of the picture's left edge, seen from `orbit`
/// degrees around the face and `tilt` degrees above the horizon.
#[unsafe(no_mangle)]
extern "C" fn aim(slot: *mut Slot, width: u32, height: u32, right: u32, orbit: i32, tilt: i32) {
    // SAFETY: the page passes a slot that is bound.
    let Slot { model: Some(model), renderer, .. } = (unsafe { &mut *slot }) else { return };
    let canvas = Canvas { width: width.clamp(1, 2047) as u16, height: height.clamp(1, 2047) as u16 };
    renderer.set_up(model, canvas, FaceView { orbit: orbit as i16, tilt: tilt as i16 });
    renderer.shift(right as i16, 0);
}

/// Reads a pose with this number of values, at a multiple of 4, collects its strokes, and returns their number.
#[unsafe(no_mangle)]
extern "C" fn place(slot: *mut Slot, pose: *const u8, channels: usize) -> usize {
    // SAFETY: the page passes a slot that is bound.
    let Slot { model: Some(model), binding, morph, renderer } = (unsafe { &mut *slot }) else { return 0 };
    // SAFETY: the page has written it, and it is read in this call only; any bits are integers.
    let (_, pose, _) = unsafe { written(pose, channels.saturating_mul(4)).align_to::<i32>() };
    let strokes = picture_of_all();
    let mut weights = Weights::new();
    binding.read(pose, &mut weights);
    morph.apply(model, &weights);
    renderer.project(model, morph);
    let mut count = 0;
    renderer.each_line(model, |line| {
        if let Some(place) = strokes.get_mut(count) {
            *place = line.into();
            count += 1;
        }
    });
    count
}

/// Returns the address of the strokes.
#[unsafe(no_mangle)]
extern "C" fn picture() -> *const Stroke {
    picture_of_all().as_ptr()
}
