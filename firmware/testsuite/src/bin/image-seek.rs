//! `image-step` with seeks to any frame. To be measured, not run.
#![no_std]
#![no_main]

#[path = "../measured.rs"]
#[macro_use]
mod measured;

use core::hint::black_box;

use measured::lent;

#[cortex_m_rt::entry]
fn main() -> ! {
    loop {
        play(lent(), lent(), lent());
    }
}

play! { player:
    player.step();
    player.seek(black_box(7));
}
