//! Payloads of the packets that describe a clip: HEAD and STARTS.

use super::writer::Writer;
use pantin_link::wire::{COUNT_BITS, Coder, FIRST_BITS, HEAD_CHECK};
use pantin_link::{ChannelKind, Head};

/// Returns the payload of a HEAD, sent at the line frame `now`.
pub(crate) fn write_head(head: &Head, now: u32) -> Vec<u8> {
    let mut writer = Writer::default();
    head.code(&mut writer, now);
    writer.finish(HEAD_CHECK)
}

/// Returns the payload of a STARTS of at most `room` bytes that describes channels from `first` on, and the number of channels in it.
pub(crate) fn write_starts(first: u16, kinds: &[ChannelKind], identity: u16, room: usize) -> (Vec<u8>, usize) {
    let payload = |count: usize| {
        let mut writer = Writer::default();
        writer.bits(FIRST_BITS, u32::from(first));
        writer.bits(COUNT_BITS, count as u32);
        for kind in &kinds[..count] {
            kind.code(&mut writer);
        }
        writer.finish(identity)
    };
    let mut count = 0;
    while count < kinds.len().min(255) && payload(count + 1).len() <= room {
        count += 1;
    }
    (payload(count), count)
}
