//! Plays clips in a terminal: the firmware's figure or face in braille dots or half blocks, or a clip's channels as bars.

pub mod cells;
pub mod colours;
pub mod figure;
pub mod keys;
pub mod meters;
pub mod picture;
pub mod play_time;
pub mod playback;
pub mod session;
pub mod settings;
pub mod steering;
pub mod terminal;
