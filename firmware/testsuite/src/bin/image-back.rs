//! `image-seek` with steps back, snapshots in memory that is lent, and those of a clip's index. To be measured, not run.
#![no_std]
#![no_main]

use core::hint::black_box;

use pantin::{ChannelState, Clip, Player, SeekCache, SnapshotPos, Undo};

#[cortex_m_rt::entry]
fn main() -> ! {
    loop {
        play(black_box(&[]), black_box(&mut []), black_box(&mut []));
    }
}

#[inline(never)]
fn play(bytes: &[u8], states: &mut [ChannelState], pose: &mut [i32]) {
    let Ok(clip) = Clip::new_checked(bytes) else { return };
    let Ok(mut player) = Player::new(clip, states, pose) else { return };
    let (undo, marks): (&mut [Undo], &mut [SnapshotPos]) = (black_box(&mut []), black_box(&mut []));
    let mut memory = SeekCache::new(&player, undo, marks, black_box(&mut []), black_box(&mut []));
    player.step();
    player.seek(black_box(7));
    player.step_with(&mut memory);
    player.seek_with(black_box(7), &mut memory);
    player.step_back(&mut memory);
    black_box(player.pose().values);
}

#[panic_handler]
fn panic(_info: &core::panic::PanicInfo) -> ! {
    loop {}
}
