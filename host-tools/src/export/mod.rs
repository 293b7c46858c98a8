//! Motion files out: one file a format.

pub mod bvh;
pub mod source;
pub mod table;
pub mod gltf;
