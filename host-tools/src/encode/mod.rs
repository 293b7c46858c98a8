//! Bytes of a clip, part by part: mirrors of the decoder's files.

pub mod rig;
pub mod varint;
