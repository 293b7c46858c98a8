//! The first fields of a file that arrives in pieces, byte by byte: magic, version, flags, the rig and the motion's length.

use crate::clip::check_fixed;
use crate::codec::varint::Varint;
use crate::layout::*;
use crate::rig::Id;
use crate::{OpenError, crc};

/// Which field the next byte is of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Field {
    #[default]
    Fixed,
    RigLen,
    Rig,
    MotionLen,
}

/// What the fields read so far say.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Prefix {
    field: Field,
    /// Bytes of the first field that have arrived: magic, version and flags.
    len: u8,
    fixed: [u8; 4],
    varint: Varint,
    /// Bytes of the rig that have not arrived.
    rig_left: u32,
    id: Id,
}

impl Prefix {
    /// Takes the next byte, and returns whether it was the last. `rig_id` is that of the only rig which the file may
    /// hold; without one, the caller checks it.
    #[inline(never)]
    pub(crate) fn push(&mut self, byte: u8, rig_id: Option<u32>) -> Result<bool, OpenError> {
        match self.field {
            Field::Fixed => {
                if let Some(place) = self.fixed.get_mut(usize::from(self.len)) {
                    *place = byte;
                }
                self.len += 1;
                if usize::from(self.len) == self.fixed.len() {
                    self.fixed[3] = check_fixed(self.fixed)?;
                    self.field = if self.flags() & HAS_RIG != 0 { Field::RigLen } else { Field::MotionLen };
                }
            }
            Field::Rig => {
                if self.rig_left > CRC_BYTES as u32 {
                    self.id = self.id.and(byte);
                }
                self.rig_left = self.rig_left.saturating_sub(1);
                if self.rig_left == 0 {
                    if rig_id.is_some_and(|id| self.id.0 != id) {
                        return Err(OpenError::WrongRig);
                    }
                    self.field = Field::MotionLen;
                }
            }
            Field::RigLen | Field::MotionLen => {
                if self.varint.push(byte) {
                    let value = self.varint.checked()?;
                    if self.field == Field::MotionLen {
                        return Ok(true);
                    }
                    (self.rig_left, self.varint) = (value, Varint::default());
                    self.field = Field::Rig;
                }
            }
        }
        Ok(false)
    }

    /// How many bytes of the rig follow; `None` where another field does.
    pub(crate) fn rig_len(&self) -> Option<u32> {
        (self.field == Field::Rig).then_some(self.rig_left)
    }

    /// The file's flags, once they have arrived.
    pub(crate) fn flags(&self) -> u8 {
        self.fixed[3]
    }

    /// The motion's length, once it has arrived.
    pub(crate) fn motion_len(&self) -> u32 {
        self.varint.value
    }

    /// What the first block's CRC continues.
    pub(crate) fn seed(&self) -> u16 {
        crc::of_prefix(self.flags(), self.motion_len())
    }
}
