//! Motion files out: one file a format.

pub mod bvh;
