//! Converts motions in build scripts: a motion, a clip or a bank goes in, and the program gets its bytes as a `static` and its sizes as types.
//!
//! `build.rs`:
//!
//! ```no_run
//! use pantin_build::{Length, Options, Recipe};
//!
//! fn main() -> Result<(), pantin_build::Error> {
//!     let recipe = Recipe::new().options(Options::new().max_error(Length::cm(1.0)));
//!     pantin_build::clip("motions/walk.keys").recipe(recipe).emit()
//! }
//! ```
//!
//! The program includes what the script wrote. No number is typed by hand:
//!
//! ```ignore
//! include!(concat!(env!("OUT_DIR"), "/walk.rs"));
//!
//! let mut room = WalkRoom::new();
//! let mut player = room.player(pantin::Clip::new_checked(&WALK)?)?;
//! ```
//!
//! | item of the file | what it is |
//! |---|---|
//! | `WALK` | the bytes of the clip or the bank, a `static` |
//! | `WalkRoom` | `pantin::Room` with the sizes of the clip, or the largest sizes of any clip of the bank |
//! | `WalkFigure` | `pantin_figure::FigureRenderer` with the size of the figure, after [`Asset::with_figure`] |
//! | `WALK_CHANNELS`, `WALK_MOVING`, `WALK_FIGURE_JOINTS`, `WALK_WORKSPACE` | these sizes |
//! | `WALK_FRAMES`, `WALK_FRAME_TIME_NS`, `WALK_NAMES` | of a clip: number of frames, nanoseconds per frame, names of the channels |
//! | `WALK_CLIPS`, `WALK_CLIP_NAMES` | of a bank: number and names of the clips |
//!
//! `pantin expand walk.ptn -o walk.rs` writes the same items without a build script.
//!
//! Cargo builds build scripts without optimization, which makes conversions slow. Put this into the `Cargo.toml` of the workspace:
//!
//! ```toml
//! [profile.dev.build-override]
//! opt-level = 2
//!
//! [profile.release.build-override]
//! opt-level = 2
//! ```
//!
//! The generated file depends on the input and the recipe alone, not on the machine.

mod asset;
mod error;

pub use asset::{Asset, Generated, bank, clip};
pub use error::Error;
pub use pantin_convert as convert;
pub use pantin_convert::edit::Edits;
pub use pantin_convert::import::ImportOptions;
pub use pantin_convert::{Length, Options, Recipe};
