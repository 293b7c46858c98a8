//! Sets up a character, with markers around what `cargo xtask bench animator` prints: see there for the order.
#![no_std]
#![no_main]

use core::hint::black_box;

use pantin_animator::{Animator, Character, LayerWorkspace, Workspace};
use testsuite::{clip, markers};

/// Most channels of the rig: as boards play our character.
const CHANNELS: usize = 64;

#[cortex_m_rt::entry]
fn main() -> ! {
    let mut memory = Workspace::<CHANNELS, CHANNELS>::new();
    let mut layer = LayerWorkspace::<CHANNELS, CHANNELS>::new();
    markers::start();
    let character = Character::new(clip::bytes(), memory.lend());
    markers::stop();
    let Ok(mut character) = character else { panic!() };
    markers::start();
    let lent = character.lend_layer(layer.lend());
    markers::stop();
    assert!(lent.is_ok());
    // The first lap of the loop, in which its seam is learnt, and the next one.
    for _ in 0..2 {
        lap(character.animator());
    }
    black_box(character.pose());
    semihosting::process::exit(0)
}

/// Goes to the last frame of the clip, then to frame 0.
#[inline(never)]
fn lap(animator: &mut Animator) {
    let clip = *animator.track().clip();
    assert!(clip.looped());
    while animator.track().frame() + 1 < clip.frames() {
        let _ = animator.step();
    }
    markers::start();
    let _ = animator.step();
    markers::stop();
    assert!(animator.track().frame() == 0);
}
