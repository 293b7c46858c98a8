//! Plays our character's state machine by the recorded session on lm3s6965evb's display, in step with the host: `sync` of `tests/harness/sync.rs`.
#![no_std]
#![no_main]
// The display and the serial port are registers at fixed addresses.
#![allow(unsafe_code)]

#[path = "../oled.rs"]
mod oled;

use pantin::{ChannelState, Player};
use pantin_animator::session::{Replay, Session};
use pantin_animator::{Character, LayerMemory, Workspace, first_clip, visit_poses};
use pantin_figure::surface::{Framebuffer, Gray4Rows};
use pantin_figure::{Canvas, Detail, DrawStyle, FigureRenderer, JointInfo, Stand, View};
use testsuite as _;

static BANK: &[u8] = include_bytes!("../../../../motions/character.ptb");
const SESSION: &str = include_str!("../../../../motions/steer.txt");
/// Pictures in a second.
const RATE: u16 = 30;
/// Channels of the character, and its joints with End Sites.
const CHANNELS: usize = 64;
const JOINTS: usize = 36;

type Oled = Gray4Rows<128, 64, 1024>;

#[cortex_m_rt::entry]
fn main() -> ! {
    oled::start();
    semihosting::process::exit(if play().is_some() { 0 } else { 1 })
}

/// Plays the session; `None` if something cannot be played.
fn play() -> Option<()> {
    let mut memory = Workspace::<CHANNELS, CHANNELS>::new();
    let (mut states, mut values, mut sampled) = ([ChannelState::NEW; CHANNELS], [0; CHANNELS], [0; CHANNELS]);
    let mut words = [0; 2];
    let mut renderer = FigureRenderer::<JOINTS>::empty();
    aim(&mut renderer, &mut states, &mut values, &mut sampled)?;
    let mut character = Character::new(BANK, memory.lend()).ok()?;
    let layer = LayerMemory { states: &mut states, values: &mut values, sampled: &mut sampled, words: &mut words };
    character.lend_layer(layer).ok()?;
    let session = Session::new_checked(SESSION, character.table()).ok()?;
    let mut replay = Replay::new(session, RATE);
    let mut frame = Framebuffer::<Oled>::new();
    let mut number = 0u32;
    while replay.next(&mut character).ok()? {
        let (pose, placement) = character.pose();
        renderer.set_pose_at(pose, Stand { place: placement.place, heading: placement.heading }).ok()?;
        frame.clear();
        renderer.draw_on(&mut frame, DrawStyle::default());
        oled::show(&mut frame);
        if oled::wait_for_host(number) {
            return Some(());
        }
        number += 1;
    }
    Some(())
}

/// Sets the camera up for the clips of all states.
#[inline(never)]
fn aim(
    renderer: &mut FigureRenderer<JOINTS>,
    states: &mut [ChannelState],
    values: &mut [i32],
    sampled: &mut [i32],
) -> Option<()> {
    let first = first_clip(BANK).ok()?;
    let player = Player::new(first, states, values).ok()?;
    renderer.skeleton_mut().set_up(&first.rig(), Detail::Body, player.pose(), &mut [JointInfo::default(); JOINTS]).ok()?;
    let mut visited = Some(());
    renderer.look_at(Canvas { width: 128, height: 64 }, View::default(), |visit| {
        visited = visited.and(visit_poses(BANK, states, values, sampled, &mut |_, values| visit(values)).ok());
    });
    visited
}
