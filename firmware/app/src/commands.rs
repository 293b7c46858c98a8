//! What the one before the display can ask for, by a button or a letter over the line.

/// A wish.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
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
pub const LETTERS: [(u8, Command, &str); 18] = [
    (b' ', Command::Pause, "pause"),
    (b'.', Command::Step, "step"),
    (b',', Command::Back, "step back"),
    (b'r', Command::Reverse, "reverse"),
    (b'n', Command::NextClip, "next clip"),
    (b'p', Command::PreviousClip, "previous clip"),
    (b'+', Command::Faster, "faster"),
    (b'-', Command::Slower, "slower"),
    (b'a', Command::OrbitLeft, "orbit left"),
    (b'd', Command::OrbitRight, "orbit right"),
    (b'w', Command::TiltUp, "tilt up"),
    (b's', Command::TiltDown, "tilt down"),
    (b'v', Command::View, "view"),
    (b'f', Command::Track, "follow or fixed"),
    (b'g', Command::Ground, "ground"),
    (b'l', Command::Smooth, "smooth lines"),
    (b'i', Command::Hud, "info"),
    (b'?', Command::Help, "this list"),
];

impl Command {
    /// The key of a letter.
    pub fn from_letter(letter: u8) -> Option<Command> {
        LETTERS.iter().find(|(own, ..)| *own == letter).map(|(_, key, _)| *key)
    }
}
