//! Every number of the format, and nowhere else. FORMAT.md explains each; encoder, decoder and tools take them from here.

/// First bytes of every clip.
pub const MAGIC: [u8; 2] = *b"Pn";
/// Version byte. What a file of this version decodes to never changes.
pub const VERSION: u8 = 1;

/// Flag: the rig stands in the file, after the flags.
pub const HAS_RIG: u8 = 1;
/// Flag: frame 0 follows the last frame.
pub const LOOPED: u8 = 2;
/// Flag: a bit for each joint with three Euler rotations says whether it is coded as an exponential map.
pub const HAS_EXPONENTIALS: u8 = 4;
/// Flag: event markers stand before the channels.
pub const HAS_EVENTS: u8 = 8;
/// Flag: snapshots stand after the motion.
pub const HAS_INDEX: u8 = 16;
/// Flag: names of event markers stand at the end of the file.
pub const HAS_EVENT_NAMES: u8 = 32;
/// Flag: sections follow that this version does not define; a decoder ignores them.
pub const HAS_SECTIONS: u8 = 64;
/// Flags that a decoder knows.
pub const KNOWN_FLAGS: u8 = 127;

/// First bytes of every bank.
pub const BANK_MAGIC: [u8; 2] = *b"Pb";
/// Types of a bank's sections that a decoder knows.
pub mod section {
    /// The rig of all clips.
    pub const RIG: u8 = 1;
    /// The clips' names and lengths.
    pub const CONTENTS: u8 = 2;
    /// The clips, one after the other.
    pub const CLIPS: u8 = 3;
    /// How many there are, from 1 on.
    pub const KNOWN: usize = 3;
}
/// Bits of a joint's head: the number of its channels.
pub const JOINT_CHANNELS: u8 = 0xf;
/// Bit of a joint's head: it is an End Site.
pub const END_SITE: u8 = 0x10;
/// Bit of a joint's head: it only steers other joints, and is not drawn.
pub const HELPER: u8 = 0x20;
/// Most joints of a rig, End Sites included.
pub const MAX_JOINTS: usize = 1023;
/// Most channels of a pose.
pub const MAX_CHANNELS: usize = 1023;
/// Most frames of a clip.
pub const MAX_FRAMES: u32 = 1 << 24;

/// Bytes of the motion that share one CRC; the last block may be shorter.
pub const BLOCK_BYTES: usize = 254;
/// Bytes of a CRC.
pub const CRC_BYTES: usize = 2;

/// Frame rates that take one byte: index 0 means that the frame time follows in nanoseconds.
pub const FRAME_RATES: [u8; 10] = [0, 120, 60, 30, 24, 25, 50, 100, 36, 15];

/// The frame times of [`FRAME_RATES`] in nanoseconds, rounded.
pub const FRAME_TIMES_NS: [u32; FRAME_RATES.len()] = frame_times();

const fn frame_times() -> [u32; FRAME_RATES.len()] {
    let mut times = [0; FRAME_RATES.len()];
    let mut i = 1;
    while i < times.len() {
        let rate = FRAME_RATES[i] as u32;
        times[i] = (1_000_000_000 + rate / 2) / rate;
        i += 1;
    }
    times
}

/// Lengths of a segment in frames, by index.
pub const LENGTHS: [u8; 16] = [1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 48, 64, 96];

/// The step of an acceleration and, from entry 16 on, of a slope, by length, before the channel's step scales it:
/// 2^30 / (L (L + 1)) and 3 * 2^30 / (L (L + 1) (L + 2)), so that over the segment either moves p by a channel step or less (METHOD 5).
pub const STEPS: [u32; 32] = falling_steps();
/// What a scaled step is shifted down by where the channel's step is 0.
pub const STEPS_SHIFT: u32 = 30;

const fn falling_steps() -> [u32; 32] {
    let mut steps = [0; 32];
    let mut i = 0;
    while i < 16 {
        let l = LENGTHS[i] as u32;
        steps[i] = (1 << 30) / (l * (l + 1));
        steps[i + 16] = (3 << 30) / (l * (l + 1) * (l + 2));
        i += 1;
    }
    steps
}

/// Classes of lengths by index, which choose a number's statistics: 1, 2 and 3, 4 to 8, longer.
pub const LENGTH_CLASSES: [u8; 16] = [0, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 3, 3, 3, 3, 3];

/// Segment types: bits 4 and 5 of a mode; bits 0 to 3 are the length's index.
pub mod segment_type {
    /// A new constant acceleration.
    pub const W: u8 = 0;
    /// The acceleration carries on, with a new slope.
    pub const K: u8 = 1;
    /// A new acceleration and a new slope.
    pub const WK: u8 = 2;
    /// Acceleration and slope carry on.
    pub const CARRY: u8 = 3;
}
/// The mode of a channel that has had no segment yet. No segment has it: type CARRY ends at length index 14.
pub const START_MODE: u8 = 63;

/// Magnitudes of w or k up to this have a symbol of their own.
pub const DIRECT: u32 = 6;
/// The magnitudes behind them come in groups of 2, 4, 8, ..., this many: a symbol and as many bits as its place among them.
pub const GROUPS: u32 = 6;
/// Index of the last magnitude symbol: the number of bits follows, then the bits.
pub const FAR_NUMBER: u32 = DIRECT + GROUPS + 1;

/// Returns the first magnitude of the group whose members have `bits` more bits.
pub const fn group(bits: u32) -> u32 {
    DIRECT - 1 + (1 << bits)
}

/// A channel's status: how it begins, and whether it has segments of its own.
pub mod status {
    /// It rests where the rig has it.
    pub const RESTS: u8 = 0;
    /// It holds one value.
    pub const CONSTANT: u8 = 1;
    /// It moves by segments of its own.
    pub const MOVES: u8 = 2;
    /// It moves as a channel before it does.
    pub const FOLLOWS: u8 = 3;
}
/// How many statuses there are.
pub const STATUSES: usize = 4;
/// Contexts of a status: whether the channel is a position, the status before, and that of the last channel of its kind.
pub const STATUS_CONTEXTS: usize = 32;
/// Bits that say how many moving channels back, less one, the channel stands that one follows.
pub const FOLLOW_BITS: u32 = 5;

/// In place of a scalar's exponent: this and more scalars are named by Live Link Face's list.
pub const LISTED: i8 = 127;

/// Largest index of a channel's step: 1, 1, 2, 3, 4, 6, 8, 12, ... raw units.
pub const MAX_STEP: u8 = 59;
/// The step index from which the first channel's change is counted.
pub const FIRST_STEP: u8 = 44;
/// Changes of the channel's step with a symbol of their own; the symbol after them says that the step follows in bits.
pub const STEP_CHANGES: u32 = 24;
/// Bits of a channel's step told by itself.
pub const STEP_BITS: u32 = 6;
