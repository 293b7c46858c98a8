//! Draws the face of one clip, next to the player's module: a page loads this module when a clip may drive a face. An instance is for one clip.
//!
//! ```text
//! room(bytes)              -> address where the page writes a rig's scalars, and later poses
//! bind(bytes, count, first) -> whether these scalars drive a face
//! aim(w, h, shift, o, t)   sets the picture in pixels, its shift to the right, the view in degrees
//! place(channels)          -> number of strokes of the pose that the page wrote
//! picture()                -> address of the strokes
//! ```
#![no_std]
// The page calls these functions, and finds and writes memory by plain addresses.
#![allow(unsafe_code)]

use pantin::Scalars;
use pantin_face::{Binding, FaceRenderer, FaceView, MODEL, Model, Morph, VERTICES, Weights};
use pantin_figure::Canvas;
use pantin_web_module::memory::{room as make_room, written};
use pantin_web_module::{Only, Stroke};

/// Maximum number of lines of a face, including its mesh.
const STROKES: usize = 3072;

struct Face {
    model: Option<Model<'static>>,
    binding: Binding,
    morph: Morph<VERTICES>,
    renderer: FaceRenderer<VERTICES>,
    strokes: [Stroke; STROKES],
}

/// Zeros, so that the module's file does not store them.
static FACE: Only<Face> = Only::new(Face {
    model: None,
    binding: Binding::EMPTY,
    morph: Morph::EMPTY,
    renderer: FaceRenderer::EMPTY,
    strokes: [Stroke::NONE; STROKES],
});

fn face() -> &'static mut Face {
    // SAFETY: exports are the only callers, none of them calls another or the page, and the memory has no threads.
    unsafe { FACE.get() }
}

/// Reserves a number of bytes and returns their address; 0 if that exceeds the limit.
// SAFETY: nothing else is named so; this holds for every export below.
#[unsafe(no_mangle)]
extern "C" fn room(bytes: usize) -> *mut u8 {
    make_room(bytes)
}

/// Returns whether `count` scalars, the first of which is channel `first`, drive a face. The page has written the rig's bytes from these scalars on.
/// Must be called once.
#[unsafe(no_mangle)]
extern "C" fn bind(bytes: usize, count: usize, first: usize) -> bool {
    let face = face();
    let Ok(model) = Model::new_checked(MODEL) else { return false };
    face.binding.bind_scalars(Scalars::of_bytes(written(bytes), count), first, &model);
    face.model = Some(model);
    face.binding.is_face() && face.morph.set_up(&model).is_ok()
}

/// Sets the camera up for a part of the picture of `width` x `height` pixels (at most 2047), `right` of the picture's left edge, seen from `orbit`
/// degrees around the face and `tilt` degrees above the horizon.
#[unsafe(no_mangle)]
extern "C" fn aim(width: u32, height: u32, right: u32, orbit: i32, tilt: i32) {
    let Face { model: Some(model), renderer, .. } = face() else { return };
    let canvas = Canvas { width: width.clamp(1, 2047) as u16, height: height.clamp(1, 2047) as u16 };
    renderer.set_up(model, canvas, FaceView { orbit: orbit as i16, tilt: tilt as i16 });
    renderer.shift(right as i16, 0);
}

/// Reads a pose with this number of values, collects its strokes, and returns their number.
#[unsafe(no_mangle)]
extern "C" fn place(channels: usize) -> usize {
    let Face { model: Some(model), binding, morph, renderer, strokes } = face() else { return 0 };
    // SAFETY: any bits are integers.
    let (_, pose, _) = unsafe { written(channels.saturating_mul(4)).align_to::<i32>() };
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
    face().strokes.as_ptr()
}
