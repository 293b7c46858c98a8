//! The first fields of a file, byte by byte: magic, version, flags, the rig and the motion's length.

use crate::bytes::Varint;
use crate::layout::*;
use crate::rig::Id;
use crate::{OpenError, crc};

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Field {
    #[default]
    Magic0,
    Magic1,
    Version,
    Flags,
    RigLen,
    Rig,
    MotionLen,
}

/// What the fields read so far say.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Prefix {
    field: Field,
    pub(crate) flags: u8,
    varint: Varint,
    /// Bytes of the rig that have not arrived.
    rig_left: u32,
    id: Id,
}

impl Prefix {
    /// Takes the next byte, and returns the motion's length if it was the last. `rig_id` is that of the only rig which the file may
    /// hold; without one, the rig is passed over by [`Prefix::skip_rig`].
    #[inline(never)]
    pub(crate) fn push(&mut self, byte: u8, rig_id: Option<u32>) -> Result<Option<u32>, OpenError> {
        self.field = match self.field {
            Field::Magic0 if byte == MAGIC[0] => Field::Magic1,
            Field::Magic1 if byte == MAGIC[1] => Field::Version,
            Field::Magic0 | Field::Magic1 => return Err(OpenError::BadMagic),
            Field::Version if byte == VERSION => Field::Flags,
            Field::Version => return Err(OpenError::UnsupportedVersion(byte)),
            Field::Flags if byte & !KNOWN_FLAGS != 0 => return Err(OpenError::Malformed),
            Field::Flags => {
                self.flags = byte;
                if byte & HAS_RIG != 0 { Field::RigLen } else { Field::MotionLen }
            }
            Field::RigLen if self.varint.push(byte) => {
                self.rig_left = self.varint.checked()?;
                self.varint = Varint::default();
                Field::Rig
            }
            Field::Rig => self.rig(byte, rig_id)?,
            Field::MotionLen if self.varint.push(byte) => return self.varint.checked().map(Some),
            field @ (Field::RigLen | Field::MotionLen) => field,
        };
        Ok(None)
    }

    fn rig(&mut self, byte: u8, rig_id: Option<u32>) -> Result<Field, OpenError> {
        if self.rig_left > CRC_BYTES as u32 {
            self.id = self.id.and(byte);
        }
        self.rig_left = self.rig_left.saturating_sub(1);
        if self.rig_left > 0 {
            return Ok(Field::Rig);
        }
        if rig_id.is_none_or(|id| self.id.0 == id) { Ok(Field::MotionLen) } else { Err(OpenError::WrongRig) }
    }

    /// How many bytes of the rig follow; `None` where another field does.
    pub(crate) fn rig_len(&self) -> Option<u32> {
        (self.field == Field::Rig).then_some(self.rig_left)
    }

    /// Goes on behind the rig, whose bytes were taken elsewhere.
    pub(crate) fn skip_rig(&mut self) {
        self.field = Field::MotionLen;
    }

    /// What the first block's CRC continues.
    pub(crate) fn seed(&self, motion_len: u32) -> u16 {
        crc::of_prefix(self.flags, motion_len)
    }
}
