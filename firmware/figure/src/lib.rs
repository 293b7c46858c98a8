//! Draws a pose as a figure of lines or as a body with volume: fixed-point forward kinematics, a perspective camera, and drawing into any
//! `embedded-graphics` target. No heap, no float; no product is wider than 32 bits in a frame.
//!
//! Firmware, host tool and browser call the same code and get the same pixels.
//!
//! ```
//! use embedded_graphics::mock_display::MockDisplay;
//! use embedded_graphics::pixelcolor::BinaryColor;
//! use pantin::{Clip, Room};
//! use pantin_figure::{Canvas, FigureRenderer, View};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let walk: &'static [u8] = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../motions/walk.ptn"));
//! let mut room = Room::<96, 144>::new();
//! let mut player = room.player(Clip::new_checked(walk)?)?;
//! // The camera takes in the whole clip, as large as the canvas allows.
//! let canvas = Canvas { width: 64, height: 64 };
//! let mut figure = FigureRenderer::<36>::of_clip(&mut player, canvas, View::default())?;
//! let mut display = MockDisplay::<BinaryColor>::new();
//! # display.set_allow_out_of_bounds_drawing(true);
//! # display.set_allow_overdraw(true);
//! figure.draw(player.pose(), &mut display)?;
//! # assert!(display.affected_area().size.height > 40);
//! # Ok(())
//! # }
//! ```
//!
//! # Which type do I want?
//!
//! | to | use |
//! |---|---|
//! | draw a clip into a display driver | [`FigureRenderer::of_clip`], then [`FigureRenderer::draw`] for each frame |
//! | do so with little stack | [`FigureRenderer::empty`], [`FigureRenderer::set_up`] and [`FigureRenderer::aim`] |
//! | draw a body with volume instead of lines | [`solid::SolidFigure`] |
//! | draw several bodies that may reach around each other | [`solid::draw_together`] |
//! | draw several figures side by side | a renderer each, [`FigureRenderer::shift`] and [`FigureRenderer::draw_over`] |
//! | draw a figure that stands somewhere in the world | [`FigureRenderer::set_pose_at`] |
//! | look from elsewhere | [`View`] with [`FigureRenderer::aim`] |
//! | draw lines yourself | [`FigureRenderer::lines`] |
//! | draw faster into memory of a display's own layout | [`surface::Framebuffer`] with [`FigureRenderer::draw_on`] |
//! | know where joints are in the world | [`pantin_math::Kinematics`], or [`JointChain`] |
//!
//! A renderer takes poses of the form of its clip ([`pantin::Form`]). For others it returns [`pantin::WrongForm`], which names the difference.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

pub mod bounds;
pub mod camera;
pub mod draw;
pub mod ink;
mod joint_info;
pub mod kinematics;
pub mod lines;
mod names;
pub mod raster;
pub mod renderer;
mod root;
#[cfg(feature = "micromath")]
pub mod rotation_float;
pub mod skeleton;
pub mod solid;
pub mod surface;

pub use camera::{CameraTarget, Canvas, View};
pub use draw::{DrawError, DrawStyle};
pub use ink::Ink;
pub use joint_info::JointInfo;
pub use pantin_math::{ChainError, JointChain, WorldJoint, rotation, trig};
pub use renderer::{FigureRenderer, Stand};
pub use skeleton::{Detail, Skeleton};

/// Most joints of a rig that a figure is made of, End Sites included, before fingers and the like are left out.
pub const RIG_JOINTS: usize = 192;

/// Why a rig makes no figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Error {
    /// There are more joints than memory for them: the scratch elements that a rig needs, or the joints of the figure, of
    /// which at least this many are needed.
    TooManyJoints {
        /// What is needed.
        needed: usize,
        /// What was given.
        given: usize,
    },
    /// More channels drive the figure than there is memory for: four a joint.
    TooManyChannels {
        /// What is needed at least.
        needed: usize,
        /// What was given.
        given: usize,
    },
}

impl core::fmt::Display for Error {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Error::TooManyJoints { needed, given } => {
                write!(f, "the figure needs memory for {needed} joints or more; {given} were given")
            }
            Error::TooManyChannels { needed, given } => {
                write!(f, "the figure needs memory for {needed} channels or more; {given} were given")
            }
        }
    }
}

impl core::error::Error for Error {}
