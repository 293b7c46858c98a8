//! Over the seam of a loop no joint moves faster than elsewhere in the clip, at any display rate.

mod common;

use common::{CHARACTER, run, walk};
use fastrand::Rng;
use pantin::{Bank, Clip};
use pantin_animator::{Animator, Workspace};
use pantin_math::JointChain;

const RATES: [u32; 7] = [24, 50, 60, 90, 120, 144, 240];

/// Where all joints are in the world, in centimetres.
fn places(animator: &Animator<'_, '_>, chains: &[JointChain<'_, 16>]) -> Vec<[f64; 3]> {
    let clip = animator.track().clip();
    let cm = f64::from(clip.rig().unit_micro_cm()) / 1e6;
    let placement = animator.placement();
    let along = placement.place.map(|raw| raw as f64 * cm * f64::from(clip.length_exponent()).exp2());
    let (sin, cos) = (f64::from(placement.heading.to_bits()) / 4_294_967_296.0 * std::f64::consts::TAU).sin_cos();
    let up = clip.rig().up().axis();
    let place = |chain: &JointChain<'_, 16>| {
        let own = chain.locate(animator.pose()).unwrap().position.map(|x| x.to_num::<f64>());
        let [a, b] = [own[(up + 1) % 3], own[(up + 2) % 3]];
        [own[up], a * cos - b * sin + along[0], a * sin + b * cos + along[1]]
    };
    chains.iter().map(place).collect()
}

fn farthest(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()).fold(0.0, f64::max)
}

/// The places of whole frames over two laps.
fn frames(animator: &mut Animator<'_, '_>, chains: &[JointChain<'_, 16>]) -> Vec<Vec<[f64; 3]>> {
    let frames = 2 * animator.track().clip().frames() + 2;
    let mut places = vec![places(animator, chains)];
    for _ in 1..frames {
        animator.step().ok();
        places.push(self::places(animator, chains));
    }
    places
}

/// The greatest step of a joint in a number of frames, which need not be whole, on straight lines between frames.
fn own_step(frames: &[Vec<[f64; 3]>], step: f64) -> f64 {
    let at = |time: f64| {
        let (frame, part) = (time.floor() as usize, time.fract());
        let mixed = |(a, b): (&[f64; 3], &[f64; 3])| core::array::from_fn(|axis| a[axis] + (b[axis] - a[axis]) * part);
        frames[frame].iter().zip(&frames[frame + 1]).map(mixed).collect::<Vec<[f64; 3]>>()
    };
    let times = (0..).map(|eighth| f64::from(eighth) / 8.0).take_while(|time| time + step < (frames.len() - 1) as f64);
    times.map(|time| farthest(&at(time), &at(time + step))).fold(0.0, f64::max)
}

/// The greatest step of a joint at a number of pictures a second, from many phases.
fn played_step(animator: &mut Animator<'_, '_>, chains: &[JointChain<'_, 16>], rate: u32) -> f64 {
    let mut random = Rng::with_seed(u64::from(rate));
    let mut most = 0.0f64;
    let pictures = (8 * animator.track().clip().duration_ns() * u64::from(rate) / 1_000_000_000).max(2_000);
    let mut before = places(animator, chains);
    for _ in 0..pictures {
        animator.update(1_000_000 / rate).ok();
        let now = places(animator, chains);
        most = most.max(farthest(&before, &now));
        before = now;
        if random.u32(..64) == 0 {
            animator.update(random.u32(..40_000)).ok();
            before = places(animator, chains);
        }
    }
    most
}

/// At each display rate, the greatest step over the clip's own.
fn greatest_ratio(name: &str, clip: Clip<'_>) -> f64 {
    let names: Vec<_> = clip.rig().joints().filter(|joint| !joint.end_site).map(|joint| joint.name()).collect();
    let chains: Vec<_> = names.iter().map(|name| JointChain::<16>::to(&clip, name).unwrap()).collect();
    let mut memory = Box::new(Workspace::<256, 256>::new());
    let frames = frames(&mut Animator::new(clip, memory.lend()).unwrap(), &chains);
    let ratio = |rate: u32| {
        let own = own_step(&frames, 1e9 / f64::from(rate) / f64::from(clip.frame_time_ns()));
        let mut memory = Box::new(Workspace::<256, 256>::new());
        let played = played_step(&mut Animator::new(clip, memory.lend()).unwrap(), &chains, rate);
        println!("{name} at {rate}: {played:.3} cm, the clip's own {own:.3} cm: {:.3}", played / own);
        played / own
    };
    RATES.map(ratio).into_iter().fold(0.0, f64::max)
}

#[test]
fn no_joint_steps_farther_than_the_clips_own() {
    let bank = Bank::new_checked(CHARACTER).unwrap();
    let clips = bank.entries().map(|entry| (entry.name().to_string(), bank.open(&entry).unwrap()));
    let ours = [("walk of keys".to_string(), walk()), ("run of keys".to_string(), run())];
    let mut looped = 0;
    for (name, clip) in clips.chain(ours).filter(|(_, clip)| clip.looped()) {
        looped += 1;
        let ratio = greatest_ratio(&name, clip);
        assert!(ratio <= 1.1, "{name}: {ratio}");
    }
    assert_eq!(looped, 6);
}
