//! Two slots, and which of them plays.

use crate::header::{ClipInfo, Header, crc_32};
use crate::inactive_slot::InactiveSlot;
use crate::slot::{self, Slot};

/// Two slots of flash.
#[derive(Debug)]
pub struct Store<S> {
    slots: [S; 2],
}

/// A valid clip in flash.
#[derive(Clone, Copy, Debug)]
pub struct StoredClip<'a> {
    /// The file of the clip, for [`pantin::Clip::new_checked`], or with the feature `bank` that of a bank.
    pub bytes: &'a [u8],
    /// What the header states.
    pub info: ClipInfo,
}

impl<S: Slot> Store<S> {
    /// Takes two slots, usually of the same size.
    pub const fn new(slots: [S; 2]) -> Self {
        const { slot::fits::<S>() };
        Store { slots }
    }

    /// Returns the newest valid clip, if there is one, and the slot for the next.
    pub fn open(&mut self) -> (Option<StoredClip<'_>>, InactiveSlot<'_, S>) {
        let [first, second] = &mut self.slots;
        let newest_is_second = match (read(first.bytes()), read(second.bytes())) {
            (Some((first, _)), Some((second, _))) => second.is_newer_than(&first),
            (first, _) => first.is_none(),
        };
        let (newest, inactive) = if newest_is_second { (second, first) } else { (first, second) };
        match read(newest.bytes()) {
            Some((header, stored)) => (Some(stored), InactiveSlot::new(inactive, header.sequence.wrapping_add(1))),
            None => (None, InactiveSlot::new(inactive, 1)),
        }
    }

    /// Returns the slots.
    pub fn into_slots(self) -> [S; 2] {
        self.slots
    }
}

/// Returns a slot's header and clip if both are valid.
fn read(slot: &[u8]) -> Option<(Header, StoredClip<'_>)> {
    let header = Header::read(slot)?;
    let bytes = slot::clip(slot, header.info.length)?;
    let right = crc_32(bytes) == header.info.crc && slot::check(bytes).is_ok();
    right.then_some((header, StoredClip { bytes, info: header.info }))
}
