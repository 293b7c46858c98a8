//! An image of the decoder alone, to be measured, not run: opening, stepping, seeking, going back, and playing bytes as they come,
//! all in memory that stands elsewhere.
#![no_std]
#![no_main]

#[path = "../measured.rs"]
#[macro_use]
mod measured;

use core::hint::black_box;

use measured::lent;
use pantin::{ChannelState, Progress, Rig, SeekCache, SnapshotPos, Stream, Undo};

#[cortex_m_rt::entry]
fn main() -> ! {
    loop {
        play(lent(), lent(), lent());
        stream(lent(), lent(), lent(), lent());
    }
}

play! { player:
    let (undo, marks): (&mut [Undo], &mut [SnapshotPos]) = (lent(), lent());
    let mut memory = SeekCache::new(&player, undo, marks, lent(), lent());
    player.step();
    player.seek(black_box(7));
    player.step_with(&mut memory);
    player.step_back(&mut memory);
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
