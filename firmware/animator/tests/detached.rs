//! Animators and characters that are taken out of their memory and put back go on as if nothing had happened.

use fixed::types::I16F16;
use pantin::ChannelState;
use pantin_animator::{Animator, Character, LayerWorkspace, Transition, Workspace};

mod common;

use common::CHARACTER;

fn play(animator: &mut Animator, picture: u32) {
    if picture == 20 {
        animator.switch(common::run(), 3, I16F16::ONE, Transition::Inertialized(20)).unwrap();
    }
    animator.update(13_000).unwrap();
}

#[test]
fn an_animator_goes_on_in_the_middle_of_a_transition() {
    let (mut one, mut other) = (Workspace::<64, 64>::new(), Workspace::<64, 64>::new());
    let mut whole = Animator::new(common::walk(), one.lend()).unwrap();
    let mut detached = Animator::new(common::walk(), other.lend()).unwrap().detach();
    for picture in 0..60 {
        let mut animator = detached.attach(other.lend()).unwrap();
        play(&mut whole, picture);
        play(&mut animator, picture);
        assert_eq!(whole.pose().values, animator.pose().values, "{picture}");
        assert_eq!((whole.placement(), whole.take_increment()), (animator.placement(), animator.take_increment()), "{picture}");
        detached = animator.detach();
    }
    assert!(detached.attach(Workspace::<8, 8>::new().lend()).is_none());
}

fn steer(character: &mut Character, picture: u32) {
    let input = |name: &str| character.table().input(name).unwrap();
    let (wave, go) = (input("wave"), input("go"));
    match picture {
        10 => character.machine().fire(wave),
        30 => character.machine().hold(go, true),
        _ => {}
    }
    character.update(16_667).unwrap();
}

#[test]
fn a_character_goes_on_with_its_layer_and_its_second_track() {
    let room = || (Workspace::<64, 64>::new(), ([ChannelState::NEW; 64], [0; 64]), LayerWorkspace::<64, 64>::new());
    let (mut one, mut other) = (room(), room());
    let (memory, second, layers) = &mut one;
    let mut whole = Character::new(CHARACTER, memory.lend()).unwrap();
    whole.lend_second(&mut second.0, &mut second.1).unwrap();
    whole.lend_layer(layers.lend()).unwrap();
    let (memory, second, layers) = &mut other;
    let mut apart = Character::new(CHARACTER, memory.lend()).unwrap();
    apart.lend_second(&mut second.0, &mut second.1).unwrap();
    apart.lend_layer(layers.lend()).unwrap();
    let mut detached = apart.detach();
    for picture in 0..120 {
        let second = Some((&mut other.1.0[..], &mut other.1.1[..]));
        let mut character = detached.attach(other.0.lend(), second, [other.2.lend()]).unwrap();
        steer(&mut whole, picture);
        steer(&mut character, picture);
        assert_eq!(whole.pose().0.values, character.pose().0.values, "{picture}");
        assert_eq!((whole.pose().1, whole.state()), (character.pose().1, character.state()), "{picture}");
        detached = character.detach();
    }
}
