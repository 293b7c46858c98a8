//! Probabilities of the symbols of payloads, written by `PANTIN_TRAIN=a.ptn,b.ptn cargo test -p pantin-line sender::train -- --ignored --nocapture`, not by hand.

/// Neither, refresh, cut, both.
pub static FLAGS: [u16; 4] = [1947, 1095, 46, 1008];

/// Channels passed over, or what stands instead of a channel.
pub static PLACE: [u16; 33] = [
    459, 341, 284, 248, 230, 215, 196, 171, 140, 111, 101, 85, 69, 60, 55, 46, 42, 47, 30, 28, 18, 24, 23, 33, 18, 28, 15, 13,
    13, 19, 228, 594, 112,
];

/// Modes.
pub static MODE: [u16; 64] = [
    136, 255, 342, 375, 379, 359, 425, 333, 250, 249, 171, 138, 195, 113, 71, 212, 5, 5, 7, 6, 4, 6, 5, 7, 4, 4, 2, 2, 1, 1, 1,
    1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,
];

/// Accelerations by class of lengths.
pub static ACCELERATION: [[u16; 27]; 4] = [
    [
        349, 133, 105, 205, 134, 211, 282, 177, 186, 205, 168, 203, 175, 201, 221, 196, 253, 194, 245, 118, 54, 30, 13, 18, 18,
        1, 1,
    ],
    [214, 142, 147, 194, 208, 231, 215, 285, 231, 223, 203, 208, 176, 213, 191, 242, 253, 167, 188, 66, 61, 10, 16, 2, 6, 1, 3],
    [124, 128, 120, 287, 268, 175, 205, 248, 250, 219, 205, 183, 184, 171, 185, 237, 238, 223, 207, 100, 90, 19, 24, 2, 2, 1, 1],
    [346, 224, 228, 376, 353, 231, 242, 248, 245, 179, 171, 185, 162, 128, 119, 159, 160, 118, 117, 38, 42, 9, 8, 3, 3, 1, 1],
];

/// Slopes.
pub static SLOPE: [u16; 27] =
    [14, 18, 139, 115, 106, 75, 112, 94, 61, 31, 24, 76, 33, 30, 27, 141, 101, 357, 150, 343, 162, 707, 669, 117, 348, 20, 26];

/// Bits of a refresh's position.
pub static P: [u16; 33] =
    [66, 58, 112, 197, 450, 535, 653, 554, 526, 453, 159, 147, 104, 39, 9, 6, 5, 4, 3, 2, 2, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1];

/// Bits of its velocity.
pub static V: [u16; 33] =
    [309, 103, 182, 287, 325, 456, 543, 567, 503, 381, 233, 109, 41, 15, 8, 6, 5, 4, 3, 2, 2, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1];

/// Bits of its acceleration.
pub static W: [u16; 33] = [
    128, 18, 24, 74, 85, 242, 174, 271, 300, 491, 253, 807, 487, 326, 238, 150, 5, 4, 3, 2, 2, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,
];

/// Accelerations of segments of this class of lengths.
pub fn acceleration(class: u8) -> &'static [u16] {
    let [first, others @ ..] = &ACCELERATION;
    others.get(usize::from(class).wrapping_sub(1)).unwrap_or(first)
}
