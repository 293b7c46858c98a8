//! An image of the decoder alone, to be measured, not run: opening, stepping, seeking.
#![no_std]
#![no_main]

use core::hint::black_box;

use pantin::{ChannelState, Clip, Player};

#[cortex_m_rt::entry]
fn main() -> ! {
    let mut states = [ChannelState::default(); 8];
    let mut pose = [0; 8];
    loop {
        play(black_box(&[]), black_box(&mut states), black_box(&mut pose));
        black_box(&pose);
    }
}

fn play(bytes: &[u8], states: &mut [ChannelState], pose: &mut [i32]) {
    let Ok(clip) = Clip::new_checked(bytes) else { return };
    let Ok(mut player) = Player::new(clip, states, pose) else { return };
    player.step();
    player.seek(black_box(7));
}

#[panic_handler]
fn panic(_info: &core::panic::PanicInfo) -> ! {
    loop {}
}
