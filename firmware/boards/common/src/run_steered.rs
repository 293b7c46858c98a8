//! A character in an emulator: buttons, or letters over the serial line, steer it.

use crate::CHARACTER;
use crate::exit::exit;
use crate::run_emulated::options;
#[cfg(feature = "meet")]
use pantin_app::meet as program;
#[cfg(not(feature = "meet"))]
use pantin_app::steer as program;
use pantin_app::{Board, CHARACTER_KEYS};
use pantin_figure::surface::Framebuffer;

/// Channels of its rig, at most.
const CHANNELS: usize = 64;

/// Plays the character, or with the feature `meet` two that meet, as the command line says, and ends the emulator.
pub fn run_steered<B: Board>(mut board: B) -> ! {
    let mut framebuffer = Framebuffer::new();
    exit(program::<B, CHANNELS>(CHARACTER, &CHARACTER_KEYS, 0, options(), &mut framebuffer, &mut board).into())
}
