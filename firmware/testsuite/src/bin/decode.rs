//! Plays a clip with markers around opening, each step, and a seek from the first frame to the last.
#![no_std]
#![no_main]

use core::hint::black_box;

use pantin::{ChannelState, Clip, Player};
use testsuite::{clip, markers};

#[cortex_m_rt::entry]
fn main() -> ! {
    let bytes = clip::bytes();
    let mut states = [ChannelState::default(); clip::CHANNELS];
    let mut pose = [0; clip::CHANNELS];
    let Some(mut player) = open(bytes, &mut states, &mut pose) else { panic!() };
    let last = player.clip().frames() - 1;
    for _ in 0..last {
        step(&mut player);
    }
    let stepped = sum(player.pose().values);
    player.rewind();
    seek(&mut player, last);
    assert!(sum(player.pose().values) == stepped);
    semihosting::process::exit(0)
}

#[inline(never)]
fn open<'m>(bytes: &'static [u8], states: &'m mut [ChannelState], pose: &'m mut [i32]) -> Option<Player<'static, 'm>> {
    let bytes = black_box(bytes);
    markers::start();
    let player = Clip::new_checked(bytes).ok().and_then(|clip| Player::new(clip, states, pose).ok());
    markers::stop();
    player
}

#[inline(never)]
fn step(player: &mut Player) {
    markers::start();
    player.step();
    markers::stop();
}

#[inline(never)]
fn seek(player: &mut Player, frame: u32) {
    markers::start();
    player.seek(frame);
    markers::stop();
}

fn sum(pose: &[i32]) -> u32 {
    pose.iter().fold(0, |sum: u32, &value| sum.rotate_left(5) ^ value as u32)
}
