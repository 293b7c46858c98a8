//! An image that opens a clip and plays it frame by frame from a slice: the least that a player links. To be measured, not run.
#![no_std]
#![no_main]

#[path = "../measured.rs"]
#[macro_use]
mod measured;

use measured::lent;

#[cortex_m_rt::entry]
fn main() -> ! {
    loop {
        play(lent(), lent(), lent());
    }
}

play! { player:
    player.step();
}
