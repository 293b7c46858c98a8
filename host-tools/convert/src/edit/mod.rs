//! Changes of a motion between import and fit: a `Motion` in, a `Motion` out.

pub mod curve;
pub mod cut;
pub mod display;
mod display_names;
mod edits;
pub mod find_loop;
pub mod footsteps;
pub mod join;
pub mod loop_seam;
pub mod mirror;
pub mod pick;
pub mod resample;
pub mod retarget;
pub mod sides;

pub use edits::{Body, Edited, Edits};
