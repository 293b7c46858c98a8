//! Every number of the format, and nowhere else. FORMAT.md explains each; encoder, decoder and tools take them from here.

/// First bytes of every clip.
pub const MAGIC: [u8; 2] = *b"Pn";
/// Version byte: values from 0xe0 are experimental and promise nothing.
pub const VERSION: u8 = 0xe1;

/// Most joints of a rig, End Sites included.
pub const MAX_JOINTS: usize = 1023;
/// Most channels of a pose.
pub const MAX_CHANNELS: usize = 1023;
/// Most frames of a clip.
pub const MAX_FRAMES: u32 = 1 << 24;
