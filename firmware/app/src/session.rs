//! A clip to play, what it is played with, and why it is left.

use crate::board::{Board, Exit};
use crate::options::Mode;
use crate::update::Listener;
use crate::view_state::ViewState;
use pantin_figure::surface::Framebuffer;

/// A clip with its name.
#[derive(Clone, Copy, Debug)]
pub struct Entry<'a> {
    /// The name that the display shows.
    pub name: &'a str,
    /// The clip's file.
    pub bytes: &'a [u8],
    /// The rig, for a clip whose file has none, as those of a bank; otherwise empty.
    pub rig: &'a [u8],
}

/// What a clip is played with.
pub(crate) struct PlayContext<'a, B: Board> {
    pub mode: Mode,
    pub view_state: &'a mut ViewState,
    pub framebuffer: &'a mut Framebuffer<B::Layout>,
    pub board: &'a mut B,
    /// Receives a clip that replaces the stored one.
    pub listener: Listener<'a>,
}

/// Why a clip is left.
pub(crate) enum Outcome {
    /// A command chose another clip: this many places further in the list.
    Clip(i32),
    /// The program ends.
    Exit(Exit),
    /// A clip arrived over the serial line, at this frame.
    #[cfg(feature = "update")]
    Received(u32),
    /// The clip was only checked, and can be played.
    #[cfg(feature = "update")]
    Playable,
}
