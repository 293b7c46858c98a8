//! An image that opens a clip and plays it frame by frame from a slice: the least that a player links. To be measured, not run.
#![no_std]
#![no_main]

use core::hint::black_box;

use pantin::{ChannelState, Clip, Player};

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
    player.step();
    black_box(player.pose().values);
}

#[panic_handler]
fn panic(_info: &core::panic::PanicInfo) -> ! {
    loop {}
}
