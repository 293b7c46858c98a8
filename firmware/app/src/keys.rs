//! What the one before the display can ask for, by a button or a letter over the line.

/// A wish.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    /// Stop where it is, or go on.
    Pause,
    /// A frame forward; pauses.
    Step,
    /// A frame back; pauses.
    Back,
    /// Play the other way round.
    Reverse,
    /// The next clip.
    NextClip,
    /// The clip before.
    PreviousClip,
    /// Twice as fast.
    Faster,
    /// Half as fast.
    Slower,
    /// Go round the figure: 15 degrees.
    OrbitLeft,
    /// The other way round.
    OrbitRight,
    /// Look from higher up: 5 degrees.
    TiltUp,
    /// From lower down.
    TiltDown,
    /// From the front, the side, or between.
    View,
    /// Follow the figure, or see all that the clip covers.
    Track,
    /// The ground, shown or not.
    Ground,
    /// Lines with smooth edges, or fast ones.
    Smooth,
    /// Name, frame and speed, shown or not.
    Hud,
    /// The list of letters, over the line.
    Help,
}

/// Letters and their keys, with what they do in a few words.
pub const LETTERS: [(u8, Key, &str); 18] = [
    (b' ', Key::Pause, "pause"),
    (b'.', Key::Step, "step"),
    (b',', Key::Back, "step back"),
    (b'r', Key::Reverse, "reverse"),
    (b'n', Key::NextClip, "next clip"),
    (b'p', Key::PreviousClip, "previous clip"),
    (b'+', Key::Faster, "faster"),
    (b'-', Key::Slower, "slower"),
    (b'a', Key::OrbitLeft, "orbit left"),
    (b'd', Key::OrbitRight, "orbit right"),
    (b'w', Key::TiltUp, "tilt up"),
    (b's', Key::TiltDown, "tilt down"),
    (b'v', Key::View, "view"),
    (b'f', Key::Track, "follow or fixed"),
    (b'g', Key::Ground, "ground"),
    (b'l', Key::Smooth, "smooth lines"),
    (b'i', Key::Hud, "info"),
    (b'?', Key::Help, "this list"),
];

impl Key {
    /// The key of a letter.
    pub fn of_letter(letter: u8) -> Option<Key> {
        LETTERS.iter().find(|(own, ..)| *own == letter).map(|(_, key, _)| *key)
    }
}
