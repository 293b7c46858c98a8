//! An image of the decoder alone, to be measured, not run: opening, stepping, seeking, going back, and playing bytes as they come,
//! all in memory that stands elsewhere.
#![no_std]
#![no_main]

use core::hint::black_box;

use pantin::{ChannelState, Clip, Player, Progress, Rig, SeekCache, SnapshotPos, Stream, Undo};

#[cortex_m_rt::entry]
fn main() -> ! {
    loop {
        play(black_box(&[]), black_box(&mut []), black_box(&mut []));
        stream(black_box(&[]), black_box(&mut []), black_box(&mut []), black_box(&mut []));
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
    player.step_back(&mut memory);
    black_box(player.pose().values);
}

#[inline(never)]
fn stream(bytes: &[u8], buffer: &mut [u8], states: &mut [ChannelState], pose: &mut [i32]) {
    let Ok(rig) = Rig::new_checked(bytes) else { return };
    let Ok(mut stream) = Stream::new(rig, buffer, states, pose) else { return };
    while stream.step() != Progress::End {
        black_box(stream.feed(bytes));
    }
    black_box(stream.pose().values);
}

#[panic_handler]
fn panic(_info: &core::panic::PanicInfo) -> ! {
    loop {}
}
