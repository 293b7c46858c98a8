//! Reads a joint's rotation, with markers around each call that `cargo xtask bench decode` prints: see there for the order.
#![no_std]
#![no_main]

use core::hint::black_box;

use pantin::{Angle, ChannelState, Clip, Component, EulerOrder, Player, Turn};
use pantin_math::{JointChain, JointPlace, Kinematics};
use testsuite::{clip, markers};

/// Most channels and joints of the clips.
const CHANNELS: usize = 132;
const JOINTS: usize = 48;

/// Names that the toes of a left foot have.
const TOES: [&str; 4] = ["left-toes", "LeftToe", "LeftToeBase", "lToe"];

/// Rotations of each form: small and large ones, angles of half a turn and none.
const SAMPLES: [[i32; 4]; 6] = [
    [0, 0, 0, 0],
    [1 << 30, 123_456, -654_321, 99],
    [-0x1234_5678, 0x2345_6789, 0x3456_789a, -0x0fed_cba9],
    [0x7fff_ffff, -0x4000_0000, 0x5555_5555, 0x1357_9bdf],
    [3, -5, 7, 11],
    [i32::MIN, i32::MIN, i32::MIN, i32::MIN],
];

#[cortex_m_rt::entry]
fn main() -> ! {
    let Ok(clip) = Clip::new_checked(clip::bytes()) else { panic!() };
    let mut states = [ChannelState::default(); CHANNELS];
    let mut pose = [0; CHANNELS];
    let Ok(mut player) = Player::new(clip, &mut states, &mut pose) else { panic!() };
    player.seek(clip.frames() / 2);
    of_joint(&player);
    places(&clip, &player);
    for [w, x, y, z] in SAMPLES {
        let angles = [x, y, z].map(Angle::from_bits);
        of_turn(Turn::Euler { order: EulerOrder::ZYX, angles });
        of_turn(Turn::Exponential(angles));
        of_turn(Turn::Quaternion([w, x, y, z].map(Component::from_bits)));
    }
    semihosting::process::exit(0)
}

/// The search for a joint, its rotation, and the angles in the source's order.
#[inline(never)]
fn of_joint(player: &Player) {
    let Some(name) = TOES.iter().find(|name| player.clip().find(name).is_some()) else { panic!() };
    let name = black_box(*name);
    markers::start();
    let joint = player.clip().find(name);
    markers::stop();
    let Some(joint) = black_box(joint) else { panic!() };
    markers::start();
    let turn = player.turn(&joint);
    markers::stop();
    let Ok(turn) = black_box(turn) else { panic!() };
    let order = black_box(joint.euler_order().unwrap_or(EulerOrder::XYZ));
    markers::start();
    let angles = turn.euler(order);
    markers::stop();
    black_box(angles);
}

/// The place of the toes by a chain, by kinematics, and all places; before that kinematics is set up.
#[inline(never)]
fn places(clip: &Clip<'static>, player: &Player) {
    let Some(toes) = TOES.iter().find_map(|name| clip.find(name)) else { panic!() };
    let Ok(chain) = JointChain::<16>::to_joint(clip, toes.index()) else { panic!() };
    let pose = black_box(player.pose());
    markers::start();
    let located = chain.locate(pose);
    markers::stop();
    let mut joints = [JointPlace::NEW; JOINTS];
    markers::start();
    let kinematics = Kinematics::new(clip, pose, &mut joints);
    markers::stop();
    let Ok(mut kinematics) = kinematics else { panic!() };
    let toes = black_box(toes);
    markers::start();
    let place = kinematics.place(pose, &toes).map(|place| place.position());
    markers::stop();
    black_box((located.is_ok(), place.is_ok()));
    let pose = black_box(pose);
    markers::start();
    let all = kinematics.set_pose(pose);
    markers::stop();
    let place = kinematics.joint(&toes).map(|place| kinematics.centimetres(place.position()));
    black_box((all.is_ok(), place.is_ok()));
}

/// The angles in another order, and the whole angle.
#[inline(never)]
fn of_turn(turn: Turn) {
    let (turn, order) = black_box((turn, EulerOrder::XZY));
    markers::start();
    let angles = turn.euler(order);
    markers::stop();
    black_box(angles);
    let turn = black_box(turn);
    markers::start();
    let angle = turn.angle();
    markers::stop();
    black_box(angle);
}
