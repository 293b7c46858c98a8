//! `image-step` with seeks to any frame. To be measured, not run.
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
    player.seek(black_box(7));
    black_box(player.pose().values);
}

#[panic_handler]
fn panic(_info: &core::panic::PanicInfo) -> ! {
    loop {}
}
