//! Statistics of motion, frozen with the format: made by `cargo xtask train`, not by hand.
//!
//! A table lists the cumulative probabilities of an alphabet in 1/4096: entry i is where symbol i + 1 starts.

/// Modes in the order of their symbols.
pub const MODES: [u8; 32] =
    [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31];

/// Which of [`MODE`] follows a mode.
const MODE_AFTER: [u8; 64] = [
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
];

/// Modes: 32 named by [`MODES`], then WK and NONE.
const MODE: [[u16; 33]; 1] = [[
    1171, 1992, 2567, 2969, 3251, 3448, 3586, 3683, 3751, 3798, 3831, 3854, 3870, 3881, 3889, 3895, 3954, 3995, 4024, 4044, 4058,
    4068, 4075, 4080, 4083, 4085, 4087, 4088, 4089, 4090, 4091, 4092, 4094,
]];

/// Which of [`NUMBER`] a context has.
const NUMBER_IN: [u8; 96] = [
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
];

/// Accelerations and slopes in their steps: 0, -1, 1, -2, ...; the last two announce a larger number.
const NUMBER: [[u16; 20]; 1] =
    [[978, 1582, 2186, 2558, 2930, 3159, 3388, 3529, 3670, 3757, 3844, 3897, 3950, 3983, 4016, 4036, 4056, 4068, 4080, 4088]];

/// Rest, constant, moving: after a channel that rests, is constant, moves.
const STATUS: [[u16; 2]; 3] = [[2457, 2867], [1229, 2867], [819, 1229]];

/// By how much a channel's step index differs from the last one's: 0, -1, 1, ...
pub const STEP_CHANGE: [u16; 24] = [
    714, 1217, 1720, 2076, 2432, 2684, 2936, 3114, 3292, 3418, 3544, 3633, 3722, 3785, 3848, 3892, 3936, 3967, 3998, 4020, 4042,
    4058, 4074, 4085,
];
/// Bits of a first position, in half channel steps.
pub const POSITION: [u16; 32] = [
    11, 39, 100, 221, 433, 762, 1211, 1752, 2324, 2865, 3314, 3643, 3855, 3976, 4037, 4065, 4076, 4080, 4082, 4083, 4084, 4085,
    4086, 4087, 4088, 4089, 4090, 4091, 4092, 4093, 4094, 4095,
];
/// Bits of a first velocity, in quarter channel steps.
pub const VELOCITY: [u16; 32] = [
    224, 571, 1045, 1617, 2221, 2793, 3267, 3614, 3838, 3966, 4031, 4060, 4072, 4076, 4078, 4079, 4080, 4081, 4082, 4083, 4084,
    4085, 4086, 4087, 4088, 4089, 4090, 4091, 4092, 4093, 4094, 4095,
];
/// Bits of what a number exceeds the largest symbol by.
pub const EXCESS: [u16; 32] = [
    556, 1332, 2196, 2972, 3528, 3848, 3995, 4050, 4067, 4072, 4074, 4075, 4076, 4077, 4078, 4079, 4080, 4081, 4082, 4083, 4084,
    4085, 4086, 4087, 4088, 4089, 4090, 4091, 4092, 4093, 4094, 4095,
];

/// The modes' table after a segment of this mode.
pub fn mode(after: u8) -> &'static [u16] {
    let index = MODE_AFTER.get(usize::from(after)).copied().unwrap_or(0);
    MODE.get(usize::from(index)).map_or(&[], |table| table)
}

/// The numbers' table in this context.
pub fn number(context: u8) -> &'static [u16] {
    let index = NUMBER_IN.get(usize::from(context)).copied().unwrap_or(0);
    NUMBER.get(usize::from(index)).map_or(&[], |table| table)
}

/// The table of a channel's status after a channel of that status.
pub fn status(after: u8) -> &'static [u16] {
    STATUS.get(usize::from(after)).map_or(&[], |table| table)
}
