//! Firmware that plays motion clips on a small display: everything but the hardware.
//!
//! The program decodes a clip frame by frame, draws it as a figure (with the feature `face` also as a face) and obeys user commands from
//! buttons or from the serial line ([`commands`]). A board implements the trait [`Board`]: display, timer, serial line and buttons. Then
//! one of these functions is the whole program:
//!
//! - [`run`](run()) plays clips one after the other;
//! - `run_stored` (feature `update`) also plays a clip from flash, which `pantin update` replaces over the serial line;
//! - [`multi`](multi()) plays several clips side by side;
//! - `steer` (feature `steer`) plays the state machine of a bank, which the buttons steer.
//! - `meet` (feature `meet`) lets that character meet another one, which reacts to it.
//!
//! With the feature `link`, [`run`](run()) can play poses that arrive over the serial line instead of a clip's. With the feature `events`,
//! `Board::event` hears footfalls, sounds and other events when their frames are shown. With the feature `bank`, `run_stored` plays all clips of a
//! bank in flash; a program can be built with the clips of a bank without it ([`Entry::rig`]).
//!
//! # A minimal board
//!
//! ```
//! use pantin_app::{Board, Entry, Exit, MaxClip, Mode, Options};
//! use pantin_figure::rotation::Rotation;
//! use pantin_figure::surface::{Framebuffer, MonoPages};
//!
//! struct MyBoard {
//!     // Display, timer and serial port of the board's HAL stand here.
//!     lit: u32,
//! }
//!
//! impl Board for MyBoard {
//!     /// 128x64 pixels, one bit each, in 1,024 bytes: the memory of an SSD1306.
//!     type Layout = MonoPages<128, 64, 1024>;
//!     type Rotation = Rotation;
//!     /// Clips of at most 144 channels, 96 of them moving, and 36 joints: they fit in 16 KiB of RAM.
//!     type Capacity = MaxClip<144, 96, 36>;
//!
//!     fn present(&mut self, framebuffer: &mut Framebuffer<Self::Layout>) {
//!         // A driver sends only the windows that `framebuffer.send()` returns. This one counts bright pixels.
//!         let pixels = (0..64).flat_map(|row| (0..128).map(move |column| (column, row)));
//!         self.lit = pixels.filter(|(column, row)| framebuffer.pixel(*column, *row).is_on()).count() as u32;
//!     }
//!
//!     fn start_timer(&mut self, _period_ns: u32) {}
//!
//!     fn ticks(&mut self) -> u32 {
//!         1 // The timer's ticks since the last call.
//!     }
//!
//!     fn send(&mut self, _bytes: &[u8]) {}
//!
//!     fn poll(&mut self) -> Option<u8> {
//!         None // The next byte from the serial line.
//!     }
//! }
//!
//! # const WALK: &[u8] = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../motions/walk.ptn"));
//! // const WALK: &[u8] = include_bytes!("walk.ptn");
//! let clips = [Entry { name: "walk", bytes: WALK, rig: &[] }];
//! // `Mode::Play` never ends.
//! let options = Options { mode: Mode::Frames(30), ..Options::parse([]) };
//! let mut board = MyBoard { lit: 0 };
//! let exit = pantin_app::run(&clips, options, &mut Framebuffer::new(), &mut board);
//! assert_eq!(exit, Exit::Done);
//! assert!(board.lit > 100);
//! ```
//!
//! # Modules
//!
//! A frame passes through them in this order: a *source* (clip, link or state machine) gives a pose, a *content* (body, face or both) draws it on the
//! framebuffer, and the board presents that. `run` holds the only loop over frames. Modules import only modules that stand
//! before them here: `commands`, `keys`, `capacity`, `events`, `board`, `options`, `idle`, `menu` with `view_state`, `update`, `session`, `source`, `content`, `hud`, `run`,
//! `multi`, `stored`, `steer`.
//!
//! A function that needs a large workspace or buffer keeps it in a stack frame of its own and is marked `#[inline(never)]`: the stack then
//! holds the largest of them, not their sum.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

mod board;
mod capacity;
pub mod commands;
mod content;
#[cfg(feature = "events")]
mod events;
pub mod frame_stream;
mod hud;
mod idle;
#[cfg(feature = "steer")]
mod keys;
mod log;
#[cfg(feature = "meet")]
mod meet;
mod menu;
mod multi;
mod options;
mod run;
mod session;
mod source;
#[cfg(feature = "steer")]
mod steer;
#[cfg(feature = "update")]
mod stored;
mod text_screen;
mod update;
mod view_state;

pub use board::{Board, Exit};
pub use capacity::{Capacity, MaxClip, RIG, Renderer, Style};
pub use commands::Command;
#[cfg(feature = "events")]
pub use events::HeardEvent;
#[cfg(feature = "steer")]
pub use keys::{CHARACTER_KEYS, SteerKey};
#[cfg(feature = "meet")]
pub use meet::meet;
pub use multi::{FIGURES, FigureBuffers, multi};
#[cfg(feature = "key")]
pub use options::Key;
pub use options::{Mode, NEXT, Options, QUIT, SHOWN};
pub use run::run;
pub use session::Entry;
#[cfg(feature = "steer")]
pub use steer::steer;
#[cfg(feature = "update")]
pub use stored::run_stored;
pub use text_screen::TextScreen;
