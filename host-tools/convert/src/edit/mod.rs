//! Changes of a motion between import and fit: a `Motion` in, a `Motion` out.

pub mod append;
mod apply;
pub mod between;
pub mod body;
pub mod contacts;
pub mod curve;
pub mod cut;
pub mod display;
pub(crate) mod display_names;
mod edits;
mod facing;
pub mod find_loop;
pub mod footsteps;
mod freed;
pub mod in_place;
pub mod join;
pub mod loop_seam;
pub mod mirror;
pub mod pace;
pub mod pick;
pub mod rename;
pub mod resample;
pub mod retarget;
pub mod reverse;
mod rotation;
pub mod scale;
pub mod sides;
pub mod smooth;
pub mod turn;

pub use edits::{Body, Edited, Edits};
pub use in_place::InPlace;
pub use pace::Pace;
