//! What buttons and letters do to a state machine.

/// What a button does, and a letter that does the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SteerKey<'a> {
    /// The button's bit in [`Board::held`], or 0.
    pub button: u16,
    /// The letter, or 0. A line tells nobody that a key was released: a letter that holds an input releases it when it comes again.
    pub letter: u8,
    /// The input that it gives. A state machine without such an input passes over it.
    pub input: &'a str,
    /// Whether it holds the input as long as it is held, or fires it once.
    pub holds: bool,
}

/// What five buttons (up, down, left, right, select, from the lowest bit) and letters do to the character of `motions/character.toml`.
pub const CHARACTER_KEYS: [SteerKey<'static>; 11] = {
    const fn key(button: u16, letter: u8, input: &str, holds: bool) -> SteerKey<'_> {
        SteerKey { button, letter, input, holds }
    }
    let [up, down, left, right, select] = [1 << 0, 1 << 1, 1 << 2, 1 << 3, 1 << 4];
    [
        key(up, b'w', "go", true),
        key(0, b'f', "fast", true),
        key(select, b' ', "jump", false),
        key(left, b'a', "left", false),
        key(right, b'd', "right", false),
        // Each state knows one of them.
        key(down, b's', "sit", false),
        key(down, b's', "stand", false),
        key(down, b's', "trip", false),
        key(0, b'h', "wave", false),
        key(0, b'b', "bow", false),
        key(0, b'n', "dance", true),
    ]
};
