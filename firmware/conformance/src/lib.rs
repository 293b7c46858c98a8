//! Plays a clip, step by step and by seeking, and a state machine by a session, and tells the CRC of every pose: what all machines must agree on.
#![cfg_attr(not(test), no_std)]

use pantin::codec::crc;
use pantin::{ChannelState, Clip, Player, TooSmall};
use pantin_animator::session::{Replay, Session};
use pantin_animator::{Character, LayerMemory, Memory};

/// How a pose was come by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Play {
    /// By one step from the frame before.
    Progress,
    /// By a seek from whatever frame was sought before.
    Seek,
}

/// Seeks of a clip at most.
const SEEKS: u32 = 12;

/// The frames that [`play`] seeks, in its order: forward and back, the last frame and frame 0 among them.
pub fn sought(frames: u32) -> impl Iterator<Item = u32> {
    let last = frames.saturating_sub(1);
    let stride = (frames / 3).max(1) | 1;
    [last, 0].into_iter().chain((1..SEEKS - 1).map(move |n| (n * stride) % frames.max(1)))
}

/// CRC-16/IBM-3740 of a pose's values as little-endian 32-bit integers.
pub fn crc_of(pose: &[i32]) -> u16 {
    pose.iter().fold(crc::INITIAL, |crc, value| crc::update(crc, &value.to_le_bytes()))
}

/// Steps through the whole clip, then seeks, and tells each pose's CRC.
pub fn play(
    clip: Clip<'_>,
    states: &mut [ChannelState],
    pose: &mut [i32],
    tell: &mut dyn FnMut(Play, u16),
) -> Result<(), TooSmall> {
    let frames = clip.frames();
    let mut player = Player::new(clip, states, pose)?;
    tell(Play::Progress, crc_of(player.pose().values));
    for _ in 1..frames {
        player.step();
        tell(Play::Progress, crc_of(player.pose().values));
    }
    for frame in sought(frames) {
        player.seek(frame);
        tell(Play::Seek, crc_of(player.pose().values));
    }
    Ok(())
}

/// Name of the session in the list of vectors, and its pictures in a second.
pub const STEERED: &str = "steered";
/// Pictures of the session in a second.
pub const RATE: u16 = 30;

/// Plays a session of a bank's state machine, and tells for each picture the CRC of the pose and of the figure's place and heading. False if
/// something of it cannot be played.
pub fn steer<'a, 'm>(
    bank: &'a [u8],
    session: &'a str,
    memory: Memory<'m>,
    layer: LayerMemory<'m>,
    tell: &mut dyn FnMut(Play, u16),
) -> bool {
    let Ok(mut character) = Character::new(bank, memory) else { return false };
    if character.table().layers() > 0 && character.lend_layer(layer).is_err() {
        return false;
    }
    let Ok(session) = Session::new_checked(session, character.table()) else { return false };
    let mut replay = Replay::new(session, RATE);
    loop {
        match replay.next(&mut character) {
            Ok(true) => tell(Play::Progress, crc_of_character(&character)),
            Ok(false) => return true,
            Err(_) => return false,
        }
    }
}

/// The CRC of a pose, and of the place and the heading behind it, little-endian.
pub fn crc_of_character(character: &Character<'_, '_>) -> u16 {
    let (pose, placement) = character.pose();
    let crc = placement.place.iter().fold(crc_of(pose.values), |crc, x| crc::update(crc, &x.to_le_bytes()));
    crc::update(crc, &placement.heading.to_bits().to_le_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seeks_both_ways_and_to_both_ends() {
        let frames: Vec<u32> = sought(160).collect();
        assert_eq!(frames.len(), SEEKS as usize);
        assert!(frames.contains(&159) && frames.contains(&0));
        assert!(frames.windows(2).any(|pair| pair[0] < pair[1]) && frames.windows(2).any(|pair| pair[0] > pair[1]));
        assert!(sought(1).all(|frame| frame == 0));
    }

    #[test]
    fn values_count_as_little_endian_bytes() {
        assert_eq!(crc_of(&[0x3433_3231, 0x3837_3635]), crc::of(b"12345678"));
    }
}
