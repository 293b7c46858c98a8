//! Plays a clip with an animator, with markers around what `cargo xtask bench animator` prints: see there for the order.
#![no_std]
#![no_main]

use core::hint::black_box;

use pantin::{ChannelState, Clip, Player};
use pantin_animator::layer::{Weight, add, blend};
use pantin_animator::procedural::{Breath, BreathChannel};
use pantin_animator::{Animator, Limb, Limits, Look, Mask, Share, Track, Transition, Workspace};
use testsuite::{clip, markers};

/// Most channels of the clips; an animator and a layer take 10 of the 16 KiB of RAM.
const CHANNELS: usize = 132;

/// Frames of the transition.
const FRAMES: u8 = 30;

#[cortex_m_rt::entry]
fn main() -> ! {
    let Ok(clip) = Clip::new_checked(clip::bytes()) else { panic!() };
    plain(clip);
    animated(clip);
    layered(clip);
    reached(clip);
    semihosting::process::exit(0)
}

/// Half the clip.
fn start(clip: &Clip) -> u32 {
    clip.frames() / 2
}

/// The frames during which the transition lasts, played by a decoder alone.
#[inline(never)]
fn plain(clip: Clip<'static>) {
    let (mut states, mut pose) = ([ChannelState::NEW; CHANNELS], [0; CHANNELS]);
    let Ok(mut player) = Player::new(clip, &mut states, &mut pose) else { panic!() };
    player.seek(start(&clip));
    for _ in 0..FRAMES {
        step(&mut player);
    }
    black_box(player.pose().values);
}

#[inline(never)]
fn step(player: &mut Player) {
    markers::start();
    player.step();
    markers::stop();
}

/// The same frames with an animator: without a transition, then the switch, then with one, then a switch to nothing.
#[inline(never)]
fn animated(clip: Clip<'static>) {
    let mut memory = Workspace::<CHANNELS, CHANNELS>::new();
    let Ok(mut animator) = Animator::new(clip, memory.lend()) else { panic!() };
    let frame_us = clip.frame_time_ns().div_ceil(1000);
    animator.seek(start(&clip));
    for _ in 0..FRAMES {
        update(&mut animator);
    }
    // To frame 0, then into the middle: from elsewhere, for nothing is left of a switch to the same frame, and not back to where it came from, which
    // would leave the figure without a heading of its own.
    for (before, frame) in [(start(&clip), 0), (start(&clip) / 2, start(&clip))] {
        animator.seek(before);
        markers::start();
        let switched = animator.switch(clip, frame, fixed::types::I16F16::ONE, Transition::Inertialized(FRAMES));
        markers::stop();
        assert!(switched.is_ok());
    }
    for _ in 0..FRAMES {
        update(&mut animator);
    }
    assert!(animator.transition_left() == 0);
    // A breath on six joints.
    let channels = core::array::from_fn::<_, 6, _>(|joint| BreathChannel { channel: 6 + 3 * joint as u16, amplitude: 1 << 24 });
    let mut breath = Breath::new(&channels, 4_000_000);
    markers::start();
    breath.advance(frame_us);
    breath.apply(animator.pose_mut(), Weight::ONE);
    markers::stop();
    black_box(animator.pose().values);
}

#[inline(never)]
fn update(animator: &mut Animator) {
    markers::start();
    let _ = animator.step();
    markers::stop();
}

/// Two full layers: two players, each over one half of the figure, by a mask and its complement.
#[inline(never)]
fn layered(clip: Clip<'static>) {
    let (mut states, mut values) = ([ChannelState::NEW; CHANNELS], [0; CHANNELS]);
    let (mut other_states, mut other_values) = ([ChannelState::NEW; CHANNELS], [0; CHANNELS]);
    let (mut pose, mut words) = ([0; CHANNELS], [0; 8 + CHANNELS]);
    let mut groups = [pantin_animator::Group::NONE; CHANNELS];
    let Ok(used) = pantin_animator::Group::of_clip(&clip, &mut groups) else { panic!() };
    let groups = groups.get(..used).unwrap_or_default();
    let (Ok(mut base), Ok(mut layer)) =
        (Track::new(clip, &mut states, &mut values), Track::new(clip, &mut other_states, &mut other_values))
    else {
        panic!()
    };
    let Ok(mut mask) = Mask::new(&clip.rig(), &mut words) else { panic!() };
    for joint in (0..clip.rig().joint_count()).step_by(2) {
        mask.put(joint, true);
    }
    mask.prepare(groups);
    let weight = black_box(Weight::from_bits(1 << 14));
    base.seek(start(&clip));
    layer.seek(start(&clip) + 5);
    for _ in 0..FRAMES {
        markers::start();
        base.step_frame();
        base.sample(&mut pose);
        layer.step_frame();
        let mixed = blend(&mut pose, groups, clip.form_ref(), layer.pose(), &mask, weight);
        markers::stop();
        assert!(mixed.is_ok());
    }
    markers::start();
    let added = add(&mut pose, groups, clip.form_ref(), layer.pose(), base.pose().values, &mask, weight);
    markers::stop();
    assert!(added.is_ok());
    black_box(&pose);
}

/// Names that a left foot and a head have.
const FEET: [&str; 3] = ["left-foot", "LeftFoot", "LeftAnkle"];
const HEADS: [&str; 2] = ["head", "Head"];

/// A leg that reaches for a point 3 cm away, then a look of the last three joints to the head.
#[inline(never)]
fn reached(clip: Clip<'static>) {
    let (mut states, mut values) = ([ChannelState::NEW; CHANNELS], [0; CHANNELS]);
    let mut groups = [pantin_animator::Group::NONE; CHANNELS];
    let Ok(used) = pantin_animator::Group::of_clip(&clip, &mut groups) else { panic!() };
    let groups = groups.get(..used).unwrap_or_default();
    let Ok(mut player) = Player::new(clip, &mut states, &mut values) else { panic!() };
    player.seek(start(&clip));
    let mut pose = [0; CHANNELS];
    for (own, value) in pose.iter_mut().zip(player.pose().values) {
        *own = *value;
    }
    let limb = |name: &&str| Limb::to(&clip, groups, name, Limits::default()).ok();
    let Some(mut limb) = FEET.iter().find_map(limb) else { panic!() };
    let [x, y, z] = limb.end(&pose);
    let up = limb.length() / 30;
    let target = black_box([x, y + up, z + up]);
    markers::start();
    let reach = limb.reach(&mut pose, target, None);
    markers::stop();
    assert!(reach.within);
    let share = Share { part: 1 << 14, most: pantin::Angle::from_bits(1 << 29) };
    let look = |name: &&str| Look::of(&clip, groups, name, &[share, share, Share { part: 1 << 15, ..share }], [0, 0, 1]).ok();
    let Some(look) = HEADS.iter().find_map(look) else { panic!() };
    let target = black_box([x + 10 * up, y + 60 * up, z + 60 * up]);
    markers::start();
    let reach = look.at(&mut pose, target);
    markers::stop();
    black_box((reach, &pose));
}
