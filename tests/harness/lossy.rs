//! A line that loses packets and flips bits, the same way each time; and a receiver at its end, in clip time.

use pantin_line::sender::{LineSettings, Source, TimedPacket};
use pantin_link::packet::{Receiver, kind};
use pantin_link::{Channel, Link, MAX_PACKET, Messages, QUEUE_PACKETS};

/// What a line does to packets.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Damage {
    /// Part of the packets that are lost.
    pub loss: f64,
    /// Part of the bits that are flipped.
    pub flips: f64,
}

/// A damaging line, as its seed has it.
#[derive(Clone, Debug)]
pub struct Lossy {
    state: u64,
}

impl Lossy {
    /// One of many.
    pub fn new(seed: u64) -> Lossy {
        Lossy { state: seed }
    }

    /// 0 to 1: S. Vigna's splitmix64.
    pub fn chance(&mut self) -> f64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// What comes of a packet; whether it was harmed.
    pub fn pass(&mut self, bytes: &[u8], damage: Damage) -> (Vec<u8>, bool) {
        if self.chance() < damage.loss {
            return (vec![], true);
        }
        let mut bytes = bytes.to_vec();
        let mut harmed = false;
        if damage.flips > 0.0 {
            for byte in &mut bytes {
                for bit in 0..8 {
                    let flip = self.chance() < damage.flips;
                    *byte ^= u8::from(flip) << bit;
                    harmed |= flip;
                }
            }
        }
        (bytes, harmed)
    }
}

/// The last frame that a packet of motion tells of.
pub fn last_frame(bytes: &[u8], line: LineSettings) -> Option<u16> {
    let mut receiver = if line.parity { Receiver::<MAX_PACKET>::with_parity() } else { Receiver::new() };
    let packets = bytes.iter().filter_map(|&byte| {
        let packet = receiver.push(byte).filter(|packet| packet.kind == kind::MOTION)?;
        let mut messages = Messages::new(packet.payload);
        messages.by_ref().for_each(drop);
        Some(messages.frame())
    });
    packets.last()
}

/// What arrives in each frame's time, from the first that the line carries on. `pass` makes of a timed, and of the frame's time in which it
/// comes, the bytes that are left of it.
pub fn arrivals(
    timed_packets: impl Iterator<Item = TimedPacket>,
    source: &Source,
    line: LineSettings,
    mut pass: impl FnMut(usize, TimedPacket) -> Vec<u8>,
) -> Vec<Vec<u8>> {
    let mut frames = vec![];
    for timed in timed_packets {
        let there = timed.at + timed.bytes.len() as f64 / line.rate;
        let frame = (there / source.frame_seconds() + f64::from(line.ahead)) as usize;
        frames.resize_with(frames.len().max(frame + 1), Vec::new);
        frames[frame].extend(pass(frame, timed));
    }
    frames
}

/// Plays timed_packets at a receiver. `line` makes of each what arrives; `each` sees the receiver frame by frame.
pub fn play(
    timed_packets: impl Iterator<Item = TimedPacket>,
    source: &Source,
    line: LineSettings,
    mut damage: impl FnMut(&TimedPacket) -> Vec<u8>,
    mut each: impl FnMut(&Link<QUEUE_PACKETS>),
) {
    let channels = source.channels();
    let (mut states, mut pose) = (vec![Channel::default(); channels], vec![0; channels]);
    let mut link = Link::<QUEUE_PACKETS>::new(source.form(), &mut states, &mut pose);
    let mut receiver = if line.parity { Receiver::<MAX_PACKET>::with_parity() } else { Receiver::new() };
    let frame = source.frame_seconds();
    let mut clock = None;
    for timed in timed_packets {
        let there = timed.at + timed.bytes.len() as f64 / line.rate;
        let clock = clock.get_or_insert(timed.at);
        while *clock + frame <= there {
            *clock += frame;
            link.step();
            each(&link);
        }
        for byte in damage(&timed) {
            if let Some(packet) = receiver.push(byte) {
                // Another rig's clip is passed over, as chance may make one.
                let _ = link.receive(&packet);
            }
        }
    }
}
