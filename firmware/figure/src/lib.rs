//! From a pose to a wireframe figure: fixed-point forward kinematics, a perspective camera, lines with depth, and their
//! drawing into any `embedded-graphics` target. No heap, no float, no product wider than 32 bits a frame.
//!
//! [`FigureRenderer`] is the whole way; firmware, host tool and browser call the same code and get the same pixels.
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
pub mod rotation;
#[cfg(feature = "micromath")]
pub mod rotation_float;
pub mod skeleton;
pub mod surface;
pub mod trig;
mod world;

pub use camera::{Canvas, Track, View};
pub use draw::{DrawError, DrawStyle};
pub use ink::Ink;
pub use joint_info::JointInfo;
pub use renderer::FigureRenderer;
pub use skeleton::{Detail, Skeleton};
pub use world::{ChainError, JointChain, WorldJoint};

/// Most joints of a rig that a figure is made of, End Sites included, before fingers and the like are left out.
pub const RIG_JOINTS: usize = 192;

/// Why a rig makes no figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
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
