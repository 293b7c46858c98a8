//! `image-seek` with steps back, snapshots in memory that is lent, and those of a clip's index. To be measured, not run.
#![no_std]
#![no_main]

#[path = "../measured.rs"]
#[macro_use]
mod measured;

use core::hint::black_box;

use measured::lent;
use pantin::{SeekCache, SnapshotPos, Undo};

#[cortex_m_rt::entry]
fn main() -> ! {
    loop {
        play(lent(), lent(), lent());
    }
}

play! { player:
    let (undo, marks): (&mut [Undo], &mut [SnapshotPos]) = (lent(), lent());
    let mut memory = SeekCache::new(&player, undo, marks, lent(), lent());
    player.step();
    player.seek(black_box(7));
    player.step_with(&mut memory);
    player.seek_with(black_box(7), &mut memory);
    player.step_back(&mut memory);
}
