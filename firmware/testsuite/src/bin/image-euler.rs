//! An image that opens a clip, plays it, finds a joint and reads its Euler angles. To be measured, not run.
#![no_std]
#![no_main]

#[path = "../measured.rs"]
#[macro_use]
mod measured;

use core::hint::black_box;

use measured::lent;
use pantin::EulerOrder;

#[cortex_m_rt::entry]
fn main() -> ! {
    loop {
        play(lent(), lent(), lent());
    }
}

play! { player:
    player.step();
    let Some(joint) = player.clip().find(black_box("LeftKnee")) else { return };
    let Ok(turn) = player.turn(&joint) else { return };
    black_box(turn.euler(black_box(EulerOrder::XYZ)));
}
