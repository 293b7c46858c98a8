//! Where poses come from: a clip's decoder, with the feature `link` the serial line, or with the feature `steer` a state machine.

mod clip;
#[cfg(feature = "link")]
pub(crate) mod link;
#[cfg(feature = "meet")]
pub(crate) mod paired;
#[cfg(feature = "steer")]
pub(crate) mod steered;

use crate::board::Exit;
use pantin::{Player, Pose};

/// A source of poses.
pub(crate) trait Source {
    /// Whether poses arrive over the serial line. The sender then chooses clip, frame and rate; commands only change the view.
    const LIVE: bool;
    /// Whether buttons and letters are commands. They steer the source otherwise.
    const COMMANDS: bool = true;
    /// Whether all sources' figures stand in one world, before one camera.
    const ONE_WORLD: bool = false;

    /// Takes the buttons that are held, before it moves on: [`Board::held`](crate::Board::held).
    #[cfg(feature = "steer")]
    fn hold(&mut self, _buttons: u16) {}

    /// Moves on by a number of frames, or back. A live source moves on by one unless the number is 0.
    fn advance(&mut self, frames: i32);

    /// Returns the pose of the current frame.
    fn pose(&self) -> Pose<'_>;

    /// Returns where the figure of the pose stands in the world, if it moves about there.
    #[cfg(feature = "steer")]
    fn stand(&self) -> Option<pantin_figure::Stand> {
        None
    }

    /// Returns why the program ends, if the source ends it.
    fn ended(&self) -> Option<Exit> {
        None
    }

    /// Returns the number of the current frame.
    fn frame(&self) -> u32;

    /// Returns the time of a frame in nanoseconds. It changes only if the source is live.
    fn frame_time_ns(&self) -> u32;

    /// Returns what the display reports.
    fn status(&self) -> Status;

    /// Passes on the player of the clip from which rig and camera are set up.
    fn with_player(&mut self, then: impl FnOnce(&mut Player));

    /// Passes on the events since the last picture, after a move by a number of frames, or back.
    #[cfg(feature = "events")]
    fn hear(&mut self, since: crate::events::Since, frames: i32, heard: &mut dyn FnMut(crate::HeardEvent));

    /// Takes a byte from the serial line, and returns the letter of a command that it completes.
    fn receive(&mut self, byte: u8) -> Option<u8> {
        Some(byte)
    }

    /// Returns the letter of a command that waits for more bytes, after none came for a frame's time.
    fn receive_nothing(&mut self) -> Option<u8> {
        None
    }

    /// Writes to the log when playing ends.
    fn log(&self) {}
}

/// A line of text on the display. What is longer than the line is cut off.
pub(crate) type TextLine = heapless::String<32>;

/// What the display reports of a source.
pub(crate) enum Status {
    /// A clip: its current frame, and the number of its frames.
    Clip { frame: u32, frames: u32 },
    /// A state machine: the state that plays.
    #[cfg(feature = "steer")]
    State(TextLine),
    /// The serial line.
    #[cfg(feature = "link")]
    Link(LinkStatus),
}

/// The state of a link.
#[cfg(feature = "link")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct LinkStatus {
    pub counts: pantin_link::Counts,
    /// Packets that arrived damaged.
    pub damaged: u32,
    /// Channels whose values are exact.
    pub exact: u16,
    /// All channels.
    pub channels: u16,
    /// Why the sender's clip cannot be played.
    pub refusal: Option<pantin_link::ClipMismatch>,
}
