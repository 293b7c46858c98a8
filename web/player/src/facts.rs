//! What the page may ask for, and why something went wrong.

use pantin::{OpenError, TooSmall};

/// What is known of the clip and of the frame, as 32-bit words in this order.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Facts {
    /// Frames of the clip; 0 before its head has come.
    pub frames: u32,
    /// Frames that can be shown.
    pub playable: u32,
    /// The frame that is shown.
    pub frame: u32,
    /// Nanoseconds from a frame to the next.
    pub frame_time_ns: u32,
    /// Whether frame 0 follows the last one.
    pub looped: u32,
    /// Channels of a pose, and how many of them the clip codes as moving; 0 while it is not there as a whole.
    pub channels: u32,
    pub moving: u32,
    /// Of the file: bytes of the rig, and of the motion.
    pub rig_bytes: u32,
    pub motion_bytes: u32,
    /// Joints of the rig, and channels that move none.
    pub joints: u32,
    pub scalars: u32,
    /// Where the rig's scalars and the pose that is shown stand, and how many bytes these scalars have.
    pub scalars_at: usize,
    pub scalars_len: usize,
    pub pose: usize,
}

impl Facts {
    /// Of no clip.
    pub const NONE: Facts = Facts {
        frames: 0,
        playable: 0,
        frame: 0,
        frame_time_ns: 0,
        looped: 0,
        channels: 0,
        moving: 0,
        rig_bytes: 0,
        motion_bytes: 0,
        joints: 0,
        scalars: 0,
        scalars_at: 0,
        scalars_len: 0,
        pose: 0,
    };
}

/// Why there is nothing to see.
#[derive(Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Trouble {
    /// No clip.
    Magic = 1,
    /// One of another version.
    Version,
    /// It ends early.
    Truncated,
    /// A CRC does not match.
    Damaged,
    /// It contradicts itself.
    Malformed,
    /// Its rig stands in another file.
    Rig,
    /// More joints or channels than there is room for.
    TooBig,
    /// Nothing to show has come yet.
    Nothing,
}

impl From<OpenError> for Trouble {
    fn from(error: OpenError) -> Trouble {
        match error {
            OpenError::BadMagic => Trouble::Magic,
            OpenError::UnsupportedVersion(_) => Trouble::Version,
            OpenError::Truncated => Trouble::Truncated,
            OpenError::BadCrc => Trouble::Damaged,
            OpenError::WrongRig => Trouble::Rig,
            _ => Trouble::Malformed,
        }
    }
}

impl From<TooSmall> for Trouble {
    fn from(_: TooSmall) -> Trouble {
        Trouble::TooBig
    }
}

impl From<pantin_figure::Error> for Trouble {
    fn from(_: pantin_figure::Error) -> Trouble {
        Trouble::TooBig
    }
}
