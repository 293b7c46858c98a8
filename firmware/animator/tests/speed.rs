//! No joint moves too fast through a transition: 10,000 random switches.

mod common;

use common::{run, walk};
use fastrand::Rng;
use fixed::types::I16F16;
use pantin::Clip;
use pantin_animator::{Animator, Transition, Workspace};
use pantin_math::JointChain;

const JOINTS: [&str; 6] = ["left-hand", "right-hand", "left-foot", "right-foot", "head", "left-shin"];

type Places = [[f64; 3]; JOINTS.len()];

/// Where joints are in the world, in centimetres. The figure of these clips walks along z and does not turn.
fn places(animator: &Animator<'_, '_>, chains: &[JointChain<'_, 16>]) -> Places {
    let clip = animator.track().clip();
    let scale = f64::from(clip.rig().unit_micro_cm()) / 1e6 * f64::from(clip.length_exponent()).exp2();
    let placement = animator.placement();
    let turn = f64::from(placement.heading.to_bits()) / 4_294_967_296.0 * std::f64::consts::TAU;
    let (sin, cos) = turn.sin_cos();
    core::array::from_fn(|joint| {
        let [x, y, z] = chains[joint].locate(animator.pose()).unwrap().position.map(|x| x.to_num::<f64>());
        let [place_z, place_x] = placement.place.map(|raw| raw as f64 * scale);
        [x * cos + z * sin + place_x, y, z * cos - x * sin + place_z]
    })
}

fn farthest(a: &Places, b: &Places) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()).fold(0.0, f64::max)
}

/// The greatest way of a joint in a frame of a clip.
fn own_speed(clip: Clip<'static>, chains: &[JointChain<'_, 16>]) -> f64 {
    let mut memory = Workspace::<64, 64>::new();
    let mut animator = Animator::new(clip, memory.lend()).unwrap();
    let mut before = places(&animator, chains);
    let mut most = 0.0f64;
    for _ in 0..clip.frames() {
        animator.step().unwrap();
        let now = places(&animator, chains);
        most = most.max(farthest(&before, &now));
        before = now;
    }
    most
}

#[test]
fn no_joint_is_faster_than_twice_the_clips_and_the_way() {
    let clips = [walk(), run()];
    let chains: Vec<_> = JOINTS.iter().map(|name| JointChain::<16>::to(&walk(), name).unwrap()).collect();
    // In centimetres a second.
    let rate = |clip: &Clip<'_>| 1e9 / f64::from(clip.frame_time_ns());
    let own = clips.map(|clip| own_speed(clip, &chains) * rate(&clip));
    let mut random = Rng::with_seed(8);
    let (mut worst, mut over) = (0.0f64, 0);
    for _ in 0..10_000 {
        let [from, to] = [0; 2].map(|_| random.u32(..2) as usize);
        let mut memory = Workspace::<64, 64>::new();
        let mut animator = Animator::new(clips[from], memory.lend()).unwrap();
        animator.seek(random.u32(..clips[from].frames()));
        let start = random.u32(..clips[to].frames());
        let frames = 4 + random.u32(..16) as u8;
        let mut before = places(&animator, &chains);
        animator.switch(clips[to], start, I16F16::ONE, Transition::Inertialized(frames)).unwrap();
        // How far the poses are apart at the switch, with the figure at its place.
        let way = {
            let mut memory = Workspace::<64, 64>::new();
            let mut other = Animator::new(clips[to], memory.lend()).unwrap();
            other.seek(start);
            other.set_placement(animator.placement());
            farthest(&before, &places(&other, &chains))
        };
        let seconds = f64::from(frames) / rate(&clips[to]);
        let bound = own[from].max(own[to]) + way / seconds;
        for _ in 0..frames {
            animator.step().unwrap();
            let now = places(&animator, &chains);
            let ratio = farthest(&before, &now) * rate(&clips[to]) / bound;
            worst = worst.max(ratio);
            over += u32::from(ratio > 2.0);
            before = now;
        }
    }
    println!("greatest speed over its bound: {worst:.3}; {over} frames above 2");
    assert!(worst <= 2.0, "{worst}");
}
