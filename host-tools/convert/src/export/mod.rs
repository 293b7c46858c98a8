//! Motion files out: one file a format.

pub mod bvh;
mod euler_frames;
#[cfg(feature = "gltf")]
pub mod gltf;
pub mod source;
pub mod table;
