//! From weights to a wireframe face: a model checked once, its units added and turned in fixed point, a camera, lines.
//! No heap, no float, no product wider than 32 bits, no division.
//!
//! ```text
//! Model::new_checked(bytes)   the face in flash (MODEL.md): points, curves, shapes, names
//! Binding::of(rig, model)     which of a clip's scalars drive which shapes, by name, once
//! Binding::weigh(pose)        a frame: scalars -> Weights
//! Morph::place(model, weights)         -> vertices
//! Look::project(model, morph)          -> places on the display
//! Look::lines(model, |line| ..)        -> lines, the bright ones last
//! ```
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

mod aperture;
pub mod binding;
mod bytes;
pub mod curve;
pub mod model;
pub mod morph;
mod outline;
mod pen;
mod projection;
pub mod renderer;
pub mod shape;
mod strokes;
mod turn;

pub use binding::Binding;
pub use model::{Error, Model, Target};
pub use morph::{Morph, Weights};
pub use renderer::{FaceRenderer, View};

/// Pantin's own face, as [`Model::new_checked`] takes it. `pantin face model` writes it; docs/FACE.md lists its units.
pub static MODEL: &[u8] = include_bytes!("../face.model");

/// Most vertices of Pantin's own face; other models take more room.
pub const VERTICES: usize = 216;
/// Most shapes of a model.
pub const SHAPES: usize = 48;
/// Most names of a clip that drive a face.
pub const BINDINGS: usize = 80;
/// A whole weight: Q15.
pub const FULL: i32 = 1 << 15;
