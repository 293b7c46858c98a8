//! Bytes of a clip, part by part: mirrors of the decoder's files.

pub mod bank;
pub mod clip;
pub mod entropy;
pub mod index;
pub mod keys;
pub mod rans;
pub mod rig;
pub mod same_rig;
pub mod segment;
mod travel;
pub mod varint;
