//! Facts that the page reads, and error codes.

use pantin::{OpenError, TooSmall};

/// Facts about the clip and the current frame, as 32-bit words in this order.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Facts {
    /// Number of frames of the clip; 0 before its header has arrived.
    pub frames: u32,
    /// Number of playable frames.
    pub playable: u32,
    /// The current frame.
    pub frame: u32,
    /// Frame time in nanoseconds.
    pub frame_time_ns: u32,
    /// Whether frame 0 follows the last one.
    pub looped: u32,
    /// Number of channels of a pose, and of moving channels; 0 while the clip is incomplete.
    pub channels: u32,
    pub moving: u32,
    /// Sizes in the file, in bytes: the rig and the motion.
    pub rig_bytes: u32,
    pub motion_bytes: u32,
    /// Number of joints of the rig, and of channels that move no joint.
    pub joints: u32,
    pub scalars: u32,
    /// Addresses of the rig's scalars and of the current pose, and the scalars' length in bytes.
    pub scalars_at: usize,
    pub scalars_len: usize,
    pub pose: usize,
    /// The event that was asked for: its frame and its id, and the address and the length of its name.
    pub event_frame: u32,
    pub event_id: u32,
    pub event_name_at: usize,
    pub event_name_len: usize,
}

impl Facts {
    /// Facts without a clip.
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
        event_frame: 0,
        event_id: 0,
        event_name_at: 0,
        event_name_len: 0,
    };
}

/// Why a clip cannot be shown.
#[derive(Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Trouble {
    /// The bytes are not a clip.
    Magic = 1,
    /// The clip has another version.
    Version,
    /// The file ends early.
    Truncated,
    /// A CRC does not match.
    Damaged,
    /// The file contradicts itself.
    Malformed,
    /// The rig is in another file.
    Rig,
    /// The clip has more joints or channels than the module's memory holds.
    TooBig,
    /// No frame has arrived yet.
    Nothing,
}

impl From<OpenError> for Trouble {
    fn from(error: OpenError) -> Trouble {
        match error {
            OpenError::BadMagic | OpenError::IsBank => Trouble::Magic,
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
