//! An image of the decoder alone, to be measured, not run: opening, stepping, seeking, going back, and playing bytes as they come.
#![no_std]
#![no_main]

use core::hint::black_box;

use pantin::{ChannelState, Clip, Mark, Memory, Player, Rig, Step, Stream, Undo};

#[cortex_m_rt::entry]
fn main() -> ! {
    let mut states = [ChannelState::default(); 8];
    let mut pose = [0; 8];
    loop {
        play(black_box(&[]), black_box(&mut states), black_box(&mut pose));
        stream(black_box(&[]), black_box(&mut states), black_box(&mut pose));
        black_box(&pose);
    }
}

#[inline(never)]
fn play(bytes: &[u8], states: &mut [ChannelState], pose: &mut [i32]) {
    let Ok(clip) = Clip::new_checked(bytes) else { return };
    let Ok(mut player) = Player::new(clip, states, pose) else { return };
    player.step();
    player.seek(black_box(7));
    let (mut undo, mut marks) = ([Undo::default(); 4], [Mark::default(); 2]);
    let (mut kept, mut values) = ([ChannelState::default(); 4], [0; 4]);
    let mut memory = Memory::new(&player, &mut undo, &mut marks, &mut kept, &mut values);
    player.step_with(&mut memory);
    player.step_back(&mut memory);
}

#[inline(never)]
fn stream(bytes: &[u8], states: &mut [ChannelState], pose: &mut [i32]) {
    let Ok(rig) = Rig::new_checked(bytes) else { return };
    let mut buffer = [0; Stream::BUFFER];
    let Ok(mut stream) = Stream::new(rig, &mut buffer, states, pose) else { return };
    while stream.step() != Step::End {
        stream.feed(bytes);
    }
}

#[panic_handler]
fn panic(_info: &core::panic::PanicInfo) -> ! {
    loop {}
}
