//! Damaged clips behind correct CRCs, and what the Rust decoder makes of each: for comparison with other decoders.

use std::fmt::Write as _;

use pantin::{Bank, ChannelState, Clip, Player, Progress, Stream};

use crate::clips::RIG;
use crate::fix;
use crate::noise::Noise;

/// Values of poses that one mutant is compared by: a few milliseconds in a slow decoder.
pub const VALUES: usize = 4000;
/// Values of poses that each clip of a bank's mutant is compared by.
pub const BANK_VALUES: usize = 200;
/// Frames that one mutant is compared by at most, where poses are short.
pub const FRAMES: usize = 400;
/// Events that one mutant is compared by at most.
pub const EVENTS: usize = 16;

/// The line of a decoder that refuses a mutant.
pub const REFUSED: &str = "refused";

/// A clip damaged in one to three places, or cut short within its first 64 bytes of motion, with its CRCs and lengths mended.
pub fn mutant(noise: &mut Noise, clips: &[Vec<u8>]) -> Vec<u8> {
    let [input, other] = [0; 2].map(|_| &clips[noise.below(clips.len())]);
    let mut bytes = noise.damage(input, other, &[]);
    if noise.below(8) == 0 {
        // Fields that end with the payload are rare elsewhere.
        let motion = Clip::with_rig(input, RIG).map_or(input.len(), |clip| clip.motion_len() + clip.index_len());
        bytes = input[..(input.len() - motion.min(input.len()) + noise.below(64)).min(input.len())].to_vec();
    }
    fix::clip(&mut bytes);
    bytes
}

/// A key clip damaged in one to three places, with its CRCs and lengths mended.
pub fn key_mutant(noise: &mut Noise, clips: &[Vec<u8>]) -> Vec<u8> {
    let [input, other] = [0; 2].map(|_| &clips[noise.below(clips.len())]);
    let mut bytes = noise.damage(input, other, &[]);
    fix::key_clip(&mut bytes);
    bytes
}

/// A bank damaged in one to three places, with its CRCs mended: of one in two mutants those of its clips too.
pub fn bank_mutant(noise: &mut Noise, banks: &[Vec<u8>]) -> Vec<u8> {
    let [input, other] = [0; 2].map(|_| &banks[noise.below(banks.len())]);
    let mut bytes = noise.damage(input, other, &[]);
    fix::bank(&mut bytes);
    if noise.below(2) == 0 {
        fix::clips_of_bank(&mut bytes);
    }
    bytes
}

/// What `Bank` reads: the number of joints, then for each clip its length and what `Clip` and `Player` read.
pub fn read_bank(bytes: &[u8]) -> String {
    let Ok(bank) = Bank::new_checked(bytes) else { return REFUSED.to_owned() };
    let mut line = format!("{} joints", bank.rig().joint_count());
    for entry in bank.entries() {
        let read = bank.open(&entry).map_or(REFUSED.to_owned(), |clip| read_clip(clip, BANK_VALUES));
        let _ = write!(line, "; {} bytes: {read}", entry.bytes().len());
    }
    line
}

/// What `Clip` and `Player` read: one line, whose fields every decoder can print.
pub fn read(bytes: &[u8]) -> String {
    Clip::with_rig(bytes, RIG).map_or(REFUSED.to_owned(), |clip| read_clip(clip, VALUES))
}

fn read_clip(clip: Clip<'_>, values: usize) -> String {
    let (channels, moving) = (clip.rig().channels(), clip.moving());
    let mut line = format!(
        "{} frames of {} ns, exponent {}, looped {}, {} joints, {} channels, {} moving, {} events",
        clip.frames(),
        clip.frame_time_ns(),
        clip.length_exponent(),
        clip.looped(),
        clip.rig().joint_count(),
        channels,
        moving,
        clip.event_count()
    );
    for event in clip.events().take(EVENTS) {
        let _ = write!(line, " {}:{}", event.frame, event.id);
    }
    let (mut states, mut pose) = (vec![ChannelState::default(); moving], vec![0; channels]);
    let Ok(mut player) = Player::new(clip, &mut states, &mut pose) else { return "no memory".to_owned() };
    line += ", poses";
    for frame in 0..compared_frames(clip.frames() as usize, channels, values) {
        if frame > 0 {
            player.step();
        }
        let _ = write!(line, " {:08x}", hash(player.pose().values));
    }
    line
}

/// Whether a `Stream` refuses the same bytes, within the frames compared.
pub fn stream_refuses(bytes: &[u8], rig: &[u8]) -> bool {
    let Ok(rig) = pantin::Rig::new_checked(rig) else { return true };
    let channels = rig.channels();
    let (mut states, mut pose, mut buffer) = (vec![ChannelState::default(); channels], vec![0; channels], [0; Stream::BUFFER]);
    let Ok(mut stream) = Stream::new(rig, &mut buffer, &mut states, &mut pose) else { return true };
    let mut rest = bytes;
    loop {
        match stream.step() {
            Progress::NeedMore => {
                let taken = stream.feed(rest);
                if taken == 0 {
                    return true;
                }
                rest = &rest[taken..];
            }
            Progress::Frame | Progress::End => return false,
            Progress::Opened | Progress::Event(_) => {}
            Progress::Damaged(_) | Progress::TooSmall => return true,
        }
    }
}

/// Frames that a mutant is compared by.
fn compared_frames(frames: usize, channels: usize, values: usize) -> usize {
    frames.min(1 + values / channels.max(1)).min(FRAMES)
}

/// FNV-1a over whole values.
fn hash(values: &[i32]) -> u32 {
    values.iter().fold(0x811c_9dc5, |hash, &value| (hash ^ value as u32).wrapping_mul(0x0100_0193))
}
