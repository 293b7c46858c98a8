//! User commands, given by a button or by a letter over the serial line. `view_state.rs` carries them out; a board's buttons are in
//! `firmware/boards/common/src/buttons.rs`.

/// A user's command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// Pause, or play on.
    Pause,
    /// Pause, and move one frame forward.
    Step,
    /// Pause, and move one frame back.
    Back,
    /// Change the direction of play.
    Reverse,
    /// Play the next clip.
    NextClip,
    /// Play the previous clip.
    PreviousClip,
    /// Double the speed.
    Faster,
    /// Halve the speed.
    Slower,
    /// Orbit the figure by 15 degrees.
    OrbitLeft,
    /// Orbit the figure by 15 degrees in the other direction.
    OrbitRight,
    /// Raise the camera by 5 degrees.
    TiltUp,
    /// Lower the camera by 5 degrees.
    TiltDown,
    /// Go to the next of four views: three quarters, front, side, behind.
    View,
    /// Follow the figure, or show the whole area that the clip covers.
    Track,
    /// Show the ground, or hide it.
    Ground,
    /// Draw lines with smooth edges, or faster ones without.
    Smooth,
    /// Draw a body with volume, or lines.
    #[cfg(feature = "solid")]
    Style,
    /// Show name, frame and speed, or hide them.
    Hud,
    /// Open the menu, or choose what it shows.
    Menu,
    /// Send the list of letters over the serial line.
    Help,
}

/// The letters of the commands, each with a short description.
pub const LETTERS: [(u8, Command, &str); if cfg!(feature = "solid") { 20 } else { 19 }] = [
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
    #[cfg(feature = "solid")]
    (b'o', Command::Style, "solid or lines"),
    (b'i', Command::Hud, "info"),
    (b'm', Command::Menu, "menu"),
    (b'?', Command::Help, "this list"),
];

impl Command {
    /// Returns the command of a letter.
    pub fn from_letter(letter: u8) -> Option<Command> {
        LETTERS.iter().find(|(own, ..)| *own == letter).map(|(_, command, _)| *command)
    }
}
