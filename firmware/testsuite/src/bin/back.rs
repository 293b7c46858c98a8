//! Plays a clip to its end with memory lent, then back to its first frame, with markers around either way as a whole; then seeks
//! by the snapshots that were kept: to the last frame, and to the last of them.
#![no_std]
#![no_main]

use core::hint::black_box;

use pantin::{ChannelState, Clip, Player, SeekCache, SnapshotPos, Undo};
use testsuite::{clip, markers};

/// What a device with 64 KiB of RAM may lend: 12 KiB of history, and 16 snapshots of up to 50 channels, or fewer of more, in 19 KB.
const RECORDS: usize = 512;
const MARKS: usize = 16;
const KEPT: usize = 50;
/// Most channels that move in the clips played.
const MOVING: usize = 200;

#[cortex_m_rt::entry]
fn main() -> ! {
    let bytes = black_box(clip::bytes());
    let mut states = [ChannelState::default(); MOVING];
    let mut pose = [0; clip::CHANNELS];
    // One by one: a tuple of arrays would stand on the stack twice.
    let mut undo = [Undo::default(); RECORDS];
    let mut marks = [SnapshotPos::default(); MARKS];
    let mut kept = [ChannelState::default(); MARKS * KEPT];
    let mut values = [0; MARKS * KEPT];
    let Ok(clip) = Clip::new_checked(bytes) else { panic!() };
    let Ok(mut player) = Player::new(clip, &mut states, &mut pose) else { panic!() };
    let mut memory = SeekCache::new(&player, &mut undo, &mut marks, &mut kept, &mut values);
    let last = player.clip().frames() - 1;
    forth(&mut player, &mut memory, last);
    let there = sum(player.pose().values);
    back(&mut player, &mut memory);
    assert!(player.frame() == 0);
    seek(&mut player, &mut memory, last);
    assert!(sum(player.pose().values) == there);
    // The last snapshot alone, without the segments behind it: kept are the frames that are multiples of a power of two.
    let room = (MARKS * KEPT).checked_div(player.clip().moving()).map_or(MARKS, |room| room.min(MARKS)) as u32;
    let spacing = (0..).map(|shift| 1 << shift).find(|spacing| (last + 1) / spacing <= room).unwrap_or(1);
    player.rewind();
    seek(&mut player, &mut memory, last / spacing * spacing);
    semihosting::process::exit(0)
}

#[inline(never)]
fn forth(player: &mut Player, memory: &mut SeekCache, last: u32) {
    markers::start();
    for _ in 0..last {
        player.step_with(memory);
    }
    markers::stop();
}

#[inline(never)]
fn back(player: &mut Player, memory: &mut SeekCache) {
    markers::start();
    while player.frame() > 0 {
        player.step_back(memory);
    }
    markers::stop();
}

#[inline(never)]
fn seek(player: &mut Player, memory: &mut SeekCache, last: u32) {
    markers::start();
    player.seek_with(last, memory);
    markers::stop();
}

fn sum(pose: &[i32]) -> u32 {
    pose.iter().fold(0, |sum: u32, &value| sum.rotate_left(5) ^ value as u32)
}
