//! One reader for all fields: of a file, of a rig, and of a motion's blocks.

use crate::OpenError;
use crate::blocks::{Input, behind_crc};
use crate::codec::varint::Varint;
use crate::entropy::STATE_BYTES;

/// Reads fields one after the other. It cannot fail: past the end it reads zeros, and [`Reader::check`] reports that and fields out of
/// bounds once all are read. A `Result` a field would be most of an image's code.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reader<'a> {
    bytes: &'a [u8],
    /// Where the next field is.
    pub(crate) position: u32,
    /// Whether CRCs stand among the bytes, which are passed over.
    blocks: bool,
    /// Whether a field was outside its bounds.
    pub(crate) malformed: bool,
}

impl<'a> Reader<'a> {
    /// Reads from the front of a slice.
    pub(crate) fn new(bytes: &'a [u8]) -> Reader<'a> {
        Reader { bytes, position: 0, blocks: false, malformed: false }
    }

    /// Reads from a position in blocks.
    pub(crate) fn of_blocks(input: &Input<'a>, position: u32) -> Reader<'a> {
        Reader { bytes: input.0, position, blocks: true, malformed: false }
    }

    #[inline(never)]
    pub(crate) fn byte(&mut self) -> u8 {
        let byte = self.bytes.get(self.position as usize).copied().unwrap_or(0);
        self.position = self.position.wrapping_add(1);
        if self.blocks {
            self.position = behind_crc(self.position);
        }
        byte
    }

    #[inline(never)]
    pub(crate) fn u32(&mut self) -> u32 {
        (0..4).fold(0, |value, _| value >> 8 | u32::from(self.byte()) << 24)
    }

    /// The state of the entropy decoder, the most significant byte first.
    pub(crate) fn state(&mut self) -> u32 {
        (0..STATE_BYTES).fold(0, |state, _| state << 8 | u32::from(self.byte()))
    }

    /// A number of at most five bytes. One that does not fit 32 bits is malformed, and loses its highest bits.
    #[inline(never)]
    pub(crate) fn varint(&mut self) -> u32 {
        // Most numbers of a rig, which is walked through often: without CRCs between, one byte.
        if let Some(&byte @ ..0x80) = self.bytes.get(self.position as usize).filter(|_| !self.blocks) {
            self.position += 1;
            return byte.into();
        }
        self.any_varint()
    }

    #[inline(never)]
    fn any_varint(&mut self) -> u32 {
        let mut varint = Varint::default();
        while !varint.push(self.byte()) {}
        self.malformed |= varint.too_large;
        varint.value
    }

    /// Passes over numbers of a slice.
    #[inline(never)]
    pub(crate) fn skip_varints(&mut self, count: u32) {
        let mut left = count;
        while left > 0 {
            let byte = self.bytes.get(self.position as usize).copied().unwrap_or(0);
            self.position = self.position.wrapping_add(1);
            left -= u32::from(byte < 0x80);
        }
    }

    /// A varint that holds a signed number as 0, -1, 1, -2, ...
    pub(crate) fn zigzag(&mut self) -> i32 {
        unzigzag(self.varint())
    }

    /// The next `len` bytes of a slice.
    #[inline(never)]
    pub(crate) fn take(&mut self, len: u32) -> &'a [u8] {
        let end = self.position.saturating_add(len);
        let Some(taken) = self.bytes.get(self.position as usize..end as usize) else {
            // Far enough to stay behind the end.
            self.position = u32::MAX / 2;
            return &[];
        };
        self.position = end;
        taken
    }

    /// A length in a varint, then that many bytes.
    pub(crate) fn name(&mut self) -> &'a [u8] {
        let len = self.varint();
        self.take(len)
    }

    /// What was not read.
    pub(crate) fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.position as usize..).unwrap_or(&[])
    }

    /// Whether bytes past the end were read.
    pub(crate) fn overrun(&self) -> bool {
        self.position as usize > self.bytes.len()
    }

    /// Whether all that was read was there, and within its bounds.
    #[inline(never)]
    pub(crate) fn check(&self) -> Result<(), OpenError> {
        if self.malformed {
            Err(OpenError::Malformed)
        } else if self.overrun() {
            Err(OpenError::Truncated)
        } else {
            Ok(())
        }
    }
}

/// 0, 1, 2, 3, ... as 0, -1, 1, -2, ...
pub(crate) const fn unzigzag(n: u32) -> i32 {
    (n >> 1) as i32 ^ -((n & 1) as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_varint_has_32_bits() {
        for (last, number, malformed) in [(0x0e, 0xefff_ffff, false), (0x0f, u32::MAX, false), (0x10, 0x0fff_ffff, true)] {
            let bytes = [0xff, 0xff, 0xff, 0xff, last];
            let mut reader = Reader::new(&bytes);
            assert_eq!((reader.varint(), reader.malformed), (number, malformed), "{last}");
            let mut pieces = Varint::default();
            let lasts: Vec<bool> = bytes.into_iter().map(|byte| pieces.push(byte)).collect();
            assert_eq!(lasts, [false, false, false, false, true]);
            assert_eq!(pieces.checked(), if malformed { Err(OpenError::Malformed) } else { Ok(number) }, "{last}");
        }
        let mut reader = Reader::new(&[0x80, 0x80, 0x80, 0x80, 0x10, 1]);
        assert_eq!((reader.varint(), reader.varint(), reader.malformed), (0, 1, true));
    }
    #[test]
    fn bytes_past_the_end_are_zeros_and_reported() {
        let mut reader = Reader::new(&[1, 2]);
        assert_eq!((reader.byte(), reader.byte(), reader.check()), (1, 2, Ok(())));
        assert_eq!((reader.byte(), reader.check()), (0, Err(OpenError::Truncated)));
        let mut reader = Reader::new(&[1, 2, 3]);
        assert_eq!((reader.take(2), reader.rest(), reader.check()), (&[1, 2][..], &[3][..], Ok(())));
        assert_eq!((reader.take(2), reader.rest(), reader.check()), (&[][..], &[][..], Err(OpenError::Truncated)));
        reader.malformed = true;
        assert_eq!(reader.check(), Err(OpenError::Malformed));
    }
}
