//! Every number of key clips, and nowhere else: FORMAT.md sections 18 to 22 explain each. Encoder and decoder take them from here.

/// Version byte of a key clip, and of a bank that holds one.
pub const KEY_VERSION: u8 = 2;
/// Flags that a key clip may have: those of version 1 without exponential maps and without an index.
pub const KEY_FLAGS: u8 = crate::layout::KNOWN_FLAGS & !(crate::layout::HAS_EXPONENTIALS | crate::layout::HAS_INDEX);
/// In memory alone, and for [`crc::of_prefix`](crate::codec::crc::of_prefix): the flag of a clip that its version byte makes a key clip.
pub const KEYS: u8 = 0x80;

/// Most frames of a key clip: the bit budget of the solver.
pub const MAX_KEY_FRAMES: u32 = 8191;
/// Most words of the memory that a key clip's keys take.
pub const MAX_WORDS: usize = 0xffff;
/// Most states that a key clip needs: one a channel, and those of [`MAX_WORDS`].
pub const MAX_STATES: u32 = (crate::layout::MAX_CHANNELS + MAX_WORDS.div_ceil(STATE_WORDS)) as u32;
/// Words of one [`ChannelState`](crate::ChannelState).
pub const STATE_WORDS: usize = 5;
/// Frames of a part of a span; only the last part of a span is shorter.
pub const PART_FRAMES: u32 = 64;

/// What one quantum is, in thousandths of a degree, of the source's unit of length, or of 1.
pub const QUANTA: [u16; 12] = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000];
/// Bits of a quantum's index.
pub const QUANTUM_BITS: u32 = 4;
/// The quantum before the first one of each class: 0.1.
pub const FIRST_QUANTUM: u8 = 6;
/// Key values are less than this in magnitude, in thousandths.
pub const MAX_THOUSANDTHS: i64 = 1 << 26;

/// Raw units of an angle in a thousandth of a degree, times 2^[`ANGLE_SHIFT`].
pub const ANGLE_FACTOR: u32 = 3_127_499_741;
/// Bits of the fraction of [`ANGLE_FACTOR`].
pub const ANGLE_SHIFT: u32 = 18;
/// A thousandth, times 2^[`DECIMAL_SHIFT`].
pub const DECIMAL_FACTOR: u32 = 2_199_023_256;
/// Bits of the fraction of [`DECIMAL_FACTOR`].
pub const DECIMAL_SHIFT: u32 = 41;
/// Most bits of the fraction of a raw value that is no angle.
pub const MAX_FRACTION: u32 = 32;

/// A channel's interpolation.
pub mod interpolation {
    /// Straight lines.
    pub const LINEAR: u8 = 0;
    /// Cubics with Catmull-Rom tangents.
    pub const CATMULL_ROM: u8 = 1;
    /// The natural cubic spline.
    pub const NATURAL: u8 = 2;
    /// The spline with a piecewise linear second difference.
    pub const DISCRETE: u8 = 3;
}

/// Chances are multiples of 2^-12.
pub const CHANCE_BITS: u32 = 12;
/// The chance of an even bit: that of raw bits, and of each context at first.
pub const EVEN: u32 = 1 << (CHANCE_BITS - 1);
/// Least and greatest chance of a 1.
pub const CHANCES: [u32; 2] = [40, 4056];
/// How far a context's chance moves towards the bit that came, in 2^-16: by how many bits came before, up to 15.
pub const RATES: [u16; 16] =
    [40960, 25206, 18204, 14247, 11703, 9930, 8623, 7620, 6827, 6183, 5650, 5201, 4819, 4489, 4201, 3948];

/// Indices of the first contexts of each kind of bit.
pub mod context {
    /// Whether the channel has keys: by the status before and the class, 9.
    pub const KEYED: usize = 0;
    /// Whether one without keys is constant: the same 9.
    pub const CONSTANT: usize = KEYED + 9;
    /// Whether the quantum is the last one of the class, 3.
    pub const QUANTUM: usize = CONSTANT + 9;
    /// Whether the grid is that of the keyed channel before.
    pub const SAME_GRID: usize = QUANTUM + 3;
    /// Whether the grid is new.
    pub const NEW_GRID: usize = SAME_GRID + 1;
    /// The interpolation of a new grid: by the one before (4: none), 3 each.
    pub const INTERPOLATION: usize = NEW_GRID + 1;
    /// Whether a new grid has the two ends alone: by interpolation, 4.
    pub const ENDS: usize = INTERPOLATION + 15;
    /// Whether the second half of a new grid is the first one again.
    pub const HALF: usize = ENDS + 4;
    /// The number of key times.
    pub const COUNT: usize = HALF + 1;
    /// Gaps between key times: without and with raw bits, [`LONG`] each.
    pub const GAP: usize = COUNT + LONG;
    /// Whether the last key has the first one's value: by class, and whether the keys are two.
    pub const CLOSED: usize = GAP + 2 * LONG;
    /// Whether the channel is predicted by itself half a cycle before.
    pub const BY_HALF: usize = CLOSED + 6;
    /// Whether it is predicted by a leader: by class, 3.
    pub const BY_LEADER: usize = BY_HALF + 1;
    /// Whether the leader is as far back as the last one.
    pub const SAME_DISTANCE: usize = BY_LEADER + 3;
    /// How far back the leader is.
    pub const DISTANCE: usize = SAME_DISTANCE + 1;
    /// Whether the prediction is turned around: of half a cycle, of a leader.
    pub const SIGN: usize = DISTANCE + LONG;
    /// Whether the leader is read half a cycle later.
    pub const SHIFT: usize = SIGN + 2;
    /// Whether half a cycle is repeated exactly.
    pub const EXACT: usize = SHIFT + 1;
    /// The length of a residual: by predictor (the key before, another) and the length before, 8 times [`LONG`].
    pub const LENGTH: usize = EXACT + 1;
    /// The sign of a residual: by predictor.
    pub const NEGATIVE: usize = LENGTH + 8 * LONG;
    /// How many contexts there are.
    pub const COUNT_OF_ALL: usize = NEGATIVE + 2;
    /// Number of contexts of a number in unary. Each leading one has its own context; from this number on, they share the last.
    pub const LONG: usize = 12;
}

/// Most ones of a number of [`context::COUNT`] and [`context::DISTANCE`] in unary.
pub const MAX_GAMMA: u32 = 12;
/// Most bits of a residual.
pub const MAX_LENGTH: u32 = 27;

/// The class of the length of a residual: for 0 to 2 bits, for 3 and 4, for more. 0 is that of no residual.
pub const fn length_class(bits: u32) -> usize {
    match bits {
        0..=2 => 1,
        3..=4 => 2,
        _ => 3,
    }
}

/// Bits of the raw part of a gap, if `left` gaps are possible and `after` keys follow: such that an even gap has about one more.
pub const fn gap_bits(left: u32, after: u32) -> u32 {
    let mut bits = 0;
    while (after + 2) << (bits + 1) <= ((3 * left) >> 2) + after + 1 {
        bits += 1;
    }
    bits
}
