//! Key clips (decoder/FORMAT.md sections 18 to 22): bytes of a motion that keeps its keys. Mirrors of the decoder's files.

mod channels;
mod clip;
mod coder;
mod grid;
mod predict;
mod range;

pub use channels::rests;
pub use clip::encode;

use pantin::Event;

/// A channel as a key clip has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum KeyedChannel {
    /// It rests where the rig has it.
    Rest,
    /// It holds one value, in thousandths.
    Constant(i32),
    /// It runs through keys.
    Keyed(Curve),
}

/// The keys of a channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Curve {
    /// One of [`pantin::codec::keys::interpolation`].
    pub interpolation: u8,
    /// Frames: the first is 0, the last the last frame or, in a loop, the number of frames.
    pub times: Vec<u32>,
    /// Values in thousandths, as many.
    pub values: Vec<i32>,
}

/// A motion of keys: one channel for each of the rig's, in its order.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyMotion {
    /// Number of frames.
    pub frames: u32,
    /// Time from one frame to the next.
    pub frame_time_ns: u32,
    /// A position's raw value times 2^exponent is in source units.
    pub length_exponent: i8,
    /// The channels.
    pub channels: Vec<KeyedChannel>,
    /// Event markers, in time order.
    pub events: Vec<Event>,
    /// Names of the events, by id; empty for an id without one.
    pub event_names: Vec<String>,
    /// Whether frame 0 follows the last frame.
    pub looped: bool,
}
