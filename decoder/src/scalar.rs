//! The channels of a rig that move no joint: morph weights, servos, lights.

use crate::bytes::Reader;
use crate::layout::LISTED;
use crate::names;

/// In place of the index of a name in a list: the rig has the name's bytes.
const SPELLED: u8 = 255;

/// One channel that moves no joint.
#[derive(Clone, Copy, Debug)]
pub struct Scalar<'a> {
    name: &'a [u8],
    /// Its name's index in the list, where it has no bytes.
    listed: u8,
    /// A pose's value times 2^(exponent - 31) is the scalar: it lies within -2^exponent .. 2^exponent.
    pub exponent: i8,
}

impl<'a> Scalar<'a> {
    /// Its name; empty for one that is not UTF-8, or that no list has.
    pub fn name(&self) -> &'a str {
        let bytes = if self.listed == SPELLED { self.name } else { names::nth(names::LIVE_LINK, self.listed) };
        core::str::from_utf8(bytes).unwrap_or("")
    }

    /// [`names::hash`] of its name's bytes; of none for one that no list has.
    pub fn name_hash(&self) -> u32 {
        if self.listed == SPELLED {
            return names::hash(self.name);
        }
        names::HASHES.get(usize::from(self.listed)).copied().unwrap_or(names::HASH_OF_NOTHING)
    }
}

/// A scalar of a rig, found once ([`crate::Rig::find_scalar`]) and then asked for frame by frame ([`crate::Pose::scalar`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ScalarRef {
    pub(crate) rig_id: u32,
    pub(crate) channel: u16,
    pub(crate) exponent: i8,
}

impl ScalarRef {
    /// The index of its channel in a pose.
    pub fn channel(&self) -> usize {
        usize::from(self.channel)
    }

    /// Its range is -2^exponent to 2^exponent.
    pub fn exponent(&self) -> i8 {
        self.exponent
    }

    pub(crate) fn rig_id(&self) -> u32 {
        self.rig_id
    }
}

/// Iterates over the scalars of a rig.
#[derive(Clone, Debug)]
pub struct Scalars<'a> {
    pub(crate) reader: Reader<'a>,
    left: u16,
    /// The last one that a list named, and how many after it are named by the list too.
    listed: u8,
    more: u8,
    exponent: i8,
}

impl<'a> Scalars<'a> {
    pub(crate) fn new(reader: Reader<'a>, left: u16) -> Scalars<'a> {
        Scalars { reader, left, listed: 0, more: 0, exponent: 0 }
    }

    /// Of bytes that [`Scalars::bytes`] gave: of a checked rig, of which no more is at hand.
    pub fn of_bytes(bytes: &'a [u8], count: usize) -> Scalars<'a> {
        Scalars::new(Reader::new(bytes), count as u16)
    }

    /// Where those that are still to come stand in the rig.
    pub fn bytes(&self) -> &'a [u8] {
        self.reader.rest()
    }

    #[inline(never)]
    pub(crate) fn read(&mut self) -> Scalar<'a> {
        self.left = self.left.saturating_sub(1);
        self.listed = self.listed.wrapping_add(1);
        let mut name = &[][..];
        if self.more == 0 {
            self.exponent = self.reader.byte() as i8;
            self.listed = SPELLED;
            if self.exponent == LISTED {
                self.listed = self.reader.byte();
                self.more = self.reader.byte();
                self.exponent = self.reader.byte() as i8;
            } else {
                name = self.reader.name();
            }
        } else {
            self.more -= 1;
        }
        Scalar { name, listed: self.listed, exponent: self.exponent }
    }
}

impl<'a> Iterator for Scalars<'a> {
    type Item = Scalar<'a>;

    fn next(&mut self) -> Option<Scalar<'a>> {
        if self.left == 0 { None } else { Some(self.read()) }
    }
}
