//! Room for clips on boards with 64 KiB of RAM or more.

/// Most channels of a clip.
pub const CHANNELS: usize = 400;
/// Most channels of a clip that move.
pub const MOVING: usize = 320;
/// Most joints of a figure without fingers and the like.
pub const JOINTS: usize = 80;
