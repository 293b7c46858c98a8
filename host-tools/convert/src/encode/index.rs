//! Snapshots in the file (`pantin convert --index`), for players that seek much: decoder/FORMAT.md section 14.

use super::clip::blocks_len;
use super::varint;
use crate::memory::Memory;
use anyhow::{Context, Result, ensure};
use pantin::{ChannelState, Clip, Player};

/// The payload of an index with a snapshot each `spacing` frames of the clip, which has none yet.
pub fn payload(clip: Clip<'_>, spacing: u32, memory: Memory) -> Result<Vec<u8>> {
    ensure!(spacing > 0, "an index of a snapshot each 0 frames: expected 1 or more");
    let mut states = vec![ChannelState::default(); clip.moving()];
    let mut pose = vec![0; clip.rig().channels()];
    let mut player = Player::new(clip, &mut states, &mut pose)?;
    let (mut snapshots, mut held) = (Vec::new(), 0);
    // One without segments has no state to store.
    while clip.frames() > 2 && !player.ended() {
        player.step();
        if player.frame().is_multiple_of(spacing) {
            let mut snapshot = Vec::new();
            pantin::codec::write_snapshot(&player, &mut |byte| snapshot.push(byte));
            held += snapshot.len() as u64;
            memory.check_bytes_held(held).context("the snapshots")?;
            snapshots.push(snapshot);
        }
    }
    Ok(table(spacing, &snapshots))
}

/// Lengths of a head that are tried before one with a byte too many will do.
const EXACT_LENGTHS: u32 = 8;

/// Spacing, number, where each begins, and the snapshots. Where they begin depends on how long it takes to say so.
fn table(spacing: u32, snapshots: &[Vec<u8>]) -> Vec<u8> {
    let (mut head_len, mut tried) = (0, 0);
    loop {
        let mut out = Vec::new();
        varint::put(&mut out, spacing);
        varint::put(&mut out, snapshots.len() as u32);
        let (mut before, mut begin) = (0, head_len);
        for snapshot in snapshots {
            // CRCs count where there is one before.
            let place = place(begin);
            varint::put(&mut out, place - before);
            (before, begin) = (place, begin + snapshot.len());
        }
        // Two lengths may lead to each other for ever, as a CRC between two snapshots moves: then zeros fill up the longer one.
        if out.len() == head_len || tried > EXACT_LENGTHS && out.len() < head_len {
            out.resize(head_len, 0);
            return snapshots.iter().fold(out, |mut out, snapshot| {
                out.extend_from_slice(snapshot);
                out
            });
        }
        head_len = out.len();
        tried += 1;
    }
}

/// Where byte `index` of a payload stands among the blocks with their CRCs.
fn place(index: usize) -> u32 {
    (blocks_len(index + 1) - pantin::codec::layout::CRC_BYTES - 1) as u32
}

/// Plays the clip from each snapshot to the next: every frame must be what stepping from frame 0 gives.
pub fn check(bytes: &[u8], rig: &[u8], spacing: u32) -> Result<()> {
    let clip = Clip::with_rig(bytes, rig).context("the clip with its index does not open")?;
    let mut memory = [(); 2].map(|()| (vec![ChannelState::default(); clip.moving()], vec![0; clip.rig().channels()]));
    let [(states, pose), (other_states, other_pose)] = &mut memory;
    let mut stepped = Player::new(clip, states, pose)?;
    let mut sought = Player::new(clip, other_states, other_pose)?;
    while !stepped.ended() {
        stepped.step();
        if stepped.frame().is_multiple_of(spacing) {
            sought.rewind();
            sought.seek(stepped.frame());
        } else {
            sought.step();
        }
        ensure!(sought.pose().values == stepped.pose().values, "frame {} differs when it is sought", stepped.frame());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use pantin::codec::layout::{BLOCK_BYTES, CRC_BYTES};

    /// The first byte of each snapshot, as a decoder finds it.
    fn found(index: &[u8]) -> Vec<usize> {
        let mut rest = index;
        let mut number = || {
            let (value, len) = varint::get(rest).unwrap();
            rest = &rest[len..];
            value as usize
        };
        let (_, count) = (number(), number());
        let mut at = 0;
        let places = (0..count).map(|_| {
            at += number();
            at - at / (BLOCK_BYTES + CRC_BYTES) * CRC_BYTES
        });
        places.collect()
    }

    #[test]
    fn every_index_ends_and_says_where_its_snapshots_begin() {
        let mut padded = 0;
        for first in (1..600).step_by(2) {
            for second in 120..132 {
                let snapshots = [vec![1; first], vec![2; second], vec![3; 5]];
                let index = table(7, &snapshots);
                let places = found(&index);
                for (place, snapshot) in places.iter().zip(&snapshots) {
                    assert!(index[*place..].starts_with(snapshot), "{first} and {second} bytes");
                }
                assert_eq!(places.len(), 3);
                padded += usize::from(index[places[0] - 1] == 0);
                assert_eq!(index.len(), places[2] + 5);
            }
        }
        // Few of them take a byte more.
        assert!((1..10).contains(&padded), "{padded}");
    }
}
