//! Clips in pieces, before anything checked them as a whole: an error or poses, in bounded time.

use pantin::codec::layout::HAS_RIG;
use pantin::{ChannelState, Clip, PartialClip, Player, Progress, Rig, RigCollector, Stream};

use crate::clips::RIG;
use crate::fix;
use crate::noise::Noise;

/// Channels and bytes of a rig that the receivers have memory for.
const CHANNELS: usize = 400;
const RIG_BYTES: usize = 4096;
/// Frames that one input may make.
const FRAMES: u32 = 200;

/// Mends the CRCs, then feeds the bytes in pieces to a stream behind a rig collector, and as a buffer that grows. Returns whether both show the
/// same frames as a player does, which they must if the clip opens.
pub fn stream_play(bytes: &[u8]) -> bool {
    let mut bytes = bytes.to_vec();
    fix::clip(&mut bytes);
    let whole = Clip::with_rig(&bytes, RIG).ok().filter(|clip| clip.rig().channels() <= CHANNELS && clip.rig_len() <= RIG_BYTES);
    let expected = whole.map(|clip| {
        let (mut states, mut pose) = (vec![ChannelState::default(); CHANNELS], vec![0; CHANNELS]);
        let mut player = Player::new(clip, &mut states, &mut pose).expect("memory as asked for");
        let mut hashes = vec![hash(player.pose().values)];
        while hashes.len() < clip.frames().min(FRAMES) as usize {
            player.step();
            hashes.push(hash(player.pose().values));
        }
        hashes
    });
    let (streamed, grown) = (streamed(&bytes), grown(&bytes));
    let (Some(expected), Some(clip)) = (expected, whole) else { return false };
    assert!(streamed == expected, "a stream shows {} frames of {}, or others", streamed.len(), expected.len());
    // A growing buffer needs the rig in front of its clip.
    assert!(
        clip.rig_len() == 0 || grown == expected,
        "a growing buffer shows {} frames of {}, or others",
        grown.len(),
        expected.len()
    );
    true
}

fn hash(values: &[i32]) -> u64 {
    values.iter().fold(0, |hash: u64, &value| (hash ^ u64::from(value as u32)).wrapping_mul(0x100_0000_01b3).rotate_left(7))
}

/// The frames of a stream, up to an error; its rig comes with it, or is known.
fn streamed(bytes: &[u8]) -> Vec<u64> {
    let mut noise = Noise::new(bytes.len() as u64);
    let (mut rig, mut buffer) = ([0; RIG_BYTES], [0; Stream::BUFFER]);
    let (mut states, mut pose) = (vec![ChannelState::default(); CHANNELS], vec![0; CHANNELS]);
    let mut collector = RigCollector::new(&mut rig);
    let mut rest = bytes;
    let with_rig = bytes.get(3).is_some_and(|flags| flags & HAS_RIG != 0);
    while with_rig && !collector.is_complete() {
        let Ok(taken) = collector.feed(&rest[..(1 + noise.below(90)).min(rest.len())]) else { return vec![] };
        if taken == 0 {
            return vec![];
        }
        rest = &rest[taken..];
    }
    let stream = if with_rig {
        collector.stream(&mut buffer, &mut states, &mut pose).ok()
    } else {
        Rig::new_checked(RIG).ok().and_then(|rig| Stream::new(rig, &mut buffer, &mut states, &mut pose).ok())
    };
    let Some(mut stream) = stream else { return vec![] };
    let (mut frames, mut events) = (vec![], bytes.len());
    while frames.len() < FRAMES as usize {
        match stream.step() {
            Progress::NeedMore => {
                let taken = if noise.below(2) == 0 {
                    stream.feed(&rest[..(1 + noise.below(400)).min(rest.len())])
                } else {
                    let space = stream.space();
                    let count = rest.len().min(space.len()).min(1 + noise.below(300));
                    space[..count].copy_from_slice(&rest[..count]);
                    stream.filled(count);
                    count
                };
                if taken == 0 {
                    return frames;
                }
                rest = &rest[taken..];
            }
            Progress::Frame => frames.push(hash(stream.pose().values)),
            Progress::Opened => {}
            // Each takes two bytes of the payload.
            Progress::Event(_) => events = events.checked_sub(2).expect("events that the bytes cannot hold"),
            Progress::End | Progress::Damaged(_) | Progress::TooSmall => return frames,
        }
    }
    frames
}

/// The frames of a buffer that grows, up to an error.
fn grown(bytes: &[u8]) -> Vec<u64> {
    let mut noise = Noise::new(bytes.len() as u64 + 1);
    let (mut states, mut pose) = (vec![ChannelState::default(); CHANNELS], vec![0; CHANNELS]);
    let (mut paused, mut frames, mut len) = (None::<pantin::PausedClip>, vec![], 0);
    while len < bytes.len() {
        len = (len + 1 + noise.below(500)).min(bytes.len());
        let file = &bytes[..len];
        let started = match &paused {
            Some(paused) => match paused.resume(file, &mut states, &mut pose) {
                Ok(started) => Some(started),
                Err(_) => return frames,
            },
            None => PartialClip::new(file).ok().and_then(|partial| {
                let player = partial.player(&mut states, &mut pose).ok()??;
                frames.push(hash(player.pose().values));
                Some((partial, player))
            }),
        };
        let Some((partial, mut player)) = started else { continue };
        while frames.len() < FRAMES as usize && partial.step(&mut player) {
            frames.push(hash(player.pose().values));
        }
        paused = Some(partial.pause(player));
    }
    frames
}
