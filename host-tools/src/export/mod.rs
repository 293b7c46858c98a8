//! Motion files out: one file a format.

pub mod bvh;
pub mod gltf;
pub mod source;
pub mod table;
