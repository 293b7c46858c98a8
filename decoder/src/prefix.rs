//! The first fields of a file, byte by byte, for a reader that cannot look back.

use crate::layout::*;
use crate::rig::{Id, Rig};
use crate::{OpenError, crc};

#[derive(Clone, Copy, Debug, Default)]
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

/// Goes through magic, version, flags, rig and the motion's length.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Prefix {
    field: Field,
    pub(crate) flags: u8,
    shift: u8,
    /// The varint so far; bytes of the rig that are to come.
    value: u32,
    id: Id,
}

impl Prefix {
    /// Takes the next byte; the motion's length if it was the last.
    pub(crate) fn push(&mut self, byte: u8, rig: &Rig<'_>) -> Result<Option<u32>, OpenError> {
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
            Field::RigLen => {
                if self.varint(byte)? {
                    Field::Rig
                } else {
                    Field::RigLen
                }
            }
            Field::Rig => self.rig(byte, rig)?,
            Field::MotionLen => {
                if self.varint(byte)? {
                    return Ok(Some(self.value));
                }
                Field::MotionLen
            }
        };
        Ok(None)
    }

    /// Whether this byte was the last of a varint.
    fn varint(&mut self, byte: u8) -> Result<bool, OpenError> {
        if self.shift == 28 && byte > 0xf {
            return Err(OpenError::Malformed);
        }
        self.value |= u32::from(byte & 0x7f) << self.shift;
        self.shift += 7;
        Ok(byte & 0x80 == 0)
    }

    fn rig(&mut self, byte: u8, rig: &Rig<'_>) -> Result<Field, OpenError> {
        if self.value > CRC_BYTES as u32 {
            self.id = self.id.and(byte);
        }
        self.value = self.value.saturating_sub(1);
        if self.value > 0 {
            return Ok(Field::Rig);
        }
        self.shift = 0;
        if self.id.0 == rig.id() { Ok(Field::MotionLen) } else { Err(OpenError::WrongRig) }
    }

    /// What the first block's CRC goes on from.
    pub(crate) fn seed(&self, motion_len: u32) -> u16 {
        crc::of_prefix(self.flags, motion_len)
    }
}
