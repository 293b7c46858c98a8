//! An image with everything of the animator linked. To be measured, not run.
#![no_std]
#![no_main]

#[path = "../measured.rs"]
#[allow(unused_macros)]
mod measured;

use core::hint::black_box;

use fixed::types::I16F16;
use measured::lent;
use pantin::Clip;
use pantin_animator::layer::{Ramp, Weight, add, blend};
use pantin_animator::procedural::{Blink, Breath};
use pantin_animator::{Animator, Character, Feet, FootLock, LayerMemory, Limb, Limits, Look, Mask, Memory, Track, Transition};

#[cortex_m_rt::entry]
fn main() -> ! {
    loop {
        let _ = black_box(play(lent()));
        let _ = black_box(steer(lent()));
    }
}

#[inline(never)]
fn play(bytes: &'static [u8]) -> Option<()> {
    let clip = Clip::new_checked(bytes).ok()?;
    let memory = Memory { states: lent(), values: lent(), offsets: lent(), pose: lent(), groups: lent() };
    let mut animator = Animator::new(clip, memory).ok()?;
    let mut layer = Track::new(clip, lent(), lent()).ok()?;
    let mut mask = Mask::new(&clip.rig(), lent()).ok()?;
    mask.set(&clip.rig(), black_box("*arm* +"), true).ok()?;
    mask.invert();
    let mut ramp = Ramp::at(Weight::ZERO);
    ramp.go_to(Weight::ONE, 500_000);
    let mut breath = Breath::new(lent(), 4_000_000);
    let mut blink = Blink::new([clip.find_scalar(black_box("EyeBlinkLeft")), None], 1);
    let mut foot = FootLock::new(&clip, animator.groups(), black_box("foot"), Limits::default(), 200_000).ok()?;
    let mut hand = Limb::to(&clip, animator.groups(), black_box("hand"), Limits::default()).ok()?;
    let look = Look::of(&clip, animator.groups(), black_box("head"), lent(), [0, 0, 1]).ok()?;
    loop {
        let elapsed = black_box(16_667);
        animator.update(elapsed).ok()?;
        layer.update(elapsed);
        ramp.advance(elapsed);
        breath.advance(elapsed);
        blink.advance(elapsed);
        let placement = animator.placement();
        let (pose, groups, form) = animator.parts();
        blend(pose, groups, form, layer.pose(), &mask, ramp.weight()).ok()?;
        add(pose, groups, form, layer.pose(), lent(), &mask, ramp.weight()).ok()?;
        breath.apply(pose, Weight::ONE);
        blink.apply(pose);
        look.at(pose, black_box([0; 3]));
        hand.reach(pose, black_box([0; 3]), Some([0, 0, 1]));
        foot.update(pose, placement, black_box(true), 16_667);
        black_box(animator.take_increment());
        black_box(animator.pose().values);
        if black_box(false) {
            animator.switch(clip, black_box(3), I16F16::ONE, Transition::Inertialized(black_box(9))).ok()?;
        }
        while let Some(event) = animator.events().take() {
            black_box(event);
        }
    }
}

/// A state machine with blends, layers and feet.
#[inline(never)]
fn steer(bytes: &'static [u8]) -> Option<()> {
    let memory = Memory { states: lent(), values: lent(), offsets: lent(), pose: lent(), groups: lent() };
    let mut feet = Feet::new();
    let mut character = Character::new(bytes, memory).ok()?;
    character.lend_second(lent(), lent()).ok()?;
    character.lend_layer(LayerMemory { states: lent(), values: lent(), sampled: lent(), words: lent() }).ok()?;
    character.lend_feet(&mut feet).ok()?;
    let speed = character.table().parameter(black_box("speed"))?;
    let jump = character.table().input(black_box("jump"))?;
    loop {
        character.machine().set(speed, black_box(100));
        character.machine().fire(jump);
        character.machine().hold(jump, black_box(true));
        character.update(black_box(16_667)).ok()?;
        black_box(character.animator().take_increment());
        black_box(character.pose());
    }
}
