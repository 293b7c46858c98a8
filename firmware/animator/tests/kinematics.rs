//! Inverse kinematics against the figure's own kinematics.

mod common;

use common::{run, walk};
use fastrand::Rng;
use pantin::{Clip, Pose};
use pantin_animator::{Animator, FootLock, Limb, Limits, Look, Share, Workspace};
use pantin_math::JointChain;

type Room = Workspace<96, 160>;

fn at(clip: &Clip<'_>, name: &str, values: &[i32]) -> [f64; 3] {
    let chain = JointChain::<32>::to(clip, name).unwrap();
    chain.locate(Pose { values, form: clip.form_ref() }).unwrap().position.map(|x| x.to_num())
}

fn turned(clip: &Clip<'_>, name: &str, values: &[i32]) -> [[f64; 3]; 3] {
    let chain = JointChain::<32>::to(clip, name).unwrap();
    chain.locate(Pose { values, form: clip.form_ref() }).unwrap().rotation.rows.map(|row| row.map(|x| x.to_num()))
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// Raw units of a position channel in a centimetre.
fn per_cm(clip: &Clip<'_>) -> f64 {
    1e6 / f64::from(clip.rig().unit_micro_cm()) / f64::from(clip.length_exponent()).exp2()
}

#[test]
fn a_leg_reaches_its_target_and_keeps_the_foots_rotation() {
    let mut random = Rng::with_seed(5);
    for clip in [walk(), run()] {
        let mut room = Room::new();
        let mut animator = Animator::new(clip, room.lend()).unwrap();
        let mut limb = Limb::to(&clip, animator.groups(), "left-foot", Limits::default()).unwrap();
        let scale = per_cm(&clip);
        let (mut worst, mut reached) = (0.0f64, 0);
        for round in 0..2_000 {
            animator.seek(random.u32(..clip.frames()));
            let start = at(&clip, "left-foot", animator.pose().values);
            let mut offset = || f64::from(random.u32(..2001)) / 100.0 - 10.0;
            let by = [0.0, offset(), offset()];
            let goal: [f64; 3] = core::array::from_fn(|axis| start[axis] + by[axis]);
            let before = turned(&clip, "left-foot", animator.pose().values);
            let near = limb.reach(animator.pose_mut(), goal.map(|cm| (cm * scale) as i32), None);
            let end = at(&clip, "left-foot", animator.pose().values);
            let error = distance(end, goal);
            if near.within {
                reached += 1;
                worst = worst.max(error);
                let after = turned(&clip, "left-foot", animator.pose().values);
                let apart =
                    before.iter().flatten().zip(after.iter().flatten()).fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
                assert!(apart < 0.05, "{round}: the foot turns by {apart}");
            }
            assert!(
                (error - f64::from(near.error) / scale).abs() < 0.1,
                "{round}: {error} {near:?} {}",
                f64::from(near.error) / scale
            );
        }
        println!("{reached} reached, {worst}");
        assert!(reached > 500);
    }
}

#[test]
fn a_look_faces_its_target() {
    let clip = walk();
    let mut random = Rng::with_seed(6);
    let mut room = Room::new();
    let mut animator = Animator::new(clip, room.lend()).unwrap();
    let most = pantin::Angle::from_bits(1 << 29);
    // The head of this rig nods alone: the neck turns all the way.
    let shares = [Share { part: 1 << 15, most }, Share { part: 1 << 15, most }];
    let look = Look::of(&clip, animator.groups(), "head", &shares, [0, 0, 1]).unwrap();
    let scale = per_cm(&clip);
    let (mut sum, mut worst) = (0.0, 0.0f64);
    for round in 0..500 {
        animator.seek(random.u32(..clip.frames()));
        let head = at(&clip, "head", animator.pose().values);
        let mut offset = |by: u32| f64::from(random.u32(..2 * by + 1)) - f64::from(by);
        let goal = [head[0] + offset(40), head[1] + offset(30), head[2] + 150.0];
        let before = facing(&clip, animator.pose().values, goal);
        let near = look.at(animator.pose_mut(), goal.map(|cm| (cm * scale) as i32));
        let after = facing(&clip, animator.pose().values, goal);
        assert!(after < before.max(0.06), "{round}: {before} before, {after} after, {near:?}");
        sum += after;
        worst = worst.max(after);
    }
    assert!(sum / 500.0 < 0.06 && worst < 0.2, "{} and at most {worst} radians", sum / 500.0);
}

/// The angle between the head's z axis and a point, in radians.
fn facing(clip: &Clip<'_>, values: &[i32], goal: [f64; 3]) -> f64 {
    let (head, axes) = (at(clip, "head", values), turned(clip, "head", values));
    let way: [f64; 3] = core::array::from_fn(|axis| goal[axis] - head[axis]);
    let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
    ((0..3).map(|axis| axes[axis][2] * way[axis]).sum::<f64>() / length).clamp(-1.0, 1.0).acos()
}

#[test]
fn a_locked_foot_stays_and_is_let_go_without_a_jump() {
    let clip = walk();
    let mut room = Room::new();
    let mut animator = Animator::new(clip, room.lend()).unwrap();
    let mut foot =
        FootLock::new(&clip, animator.groups(), "left-foot", Limits::default(), 10 * clip.frame_time_ns() / 1000).unwrap();
    let scale = per_cm(&clip);
    // This walk has no events: a foot comes down where its ankle stops sinking.
    let mut heights = vec![];
    for frame in 0..clip.frames() {
        animator.seek(frame);
        heights.push(at(&clip, "left-foot", animator.pose().values)[1]);
    }
    let lowest = heights.iter().copied().fold(f64::MAX, f64::min);
    animator.seek(0);
    let (mut anchor, mut slide, mut own_slide, mut locked_frames) = (None::<(f64, f64)>, 0.0f64, 0.0f64, 0);
    let (mut before, mut own_before) = (None, None);
    let (mut fastest, mut own_fastest) = (0.0f64, 0.0f64);
    for step in 1..clip.frames() as usize * 3 {
        animator.step().unwrap();
        let frame = animator.track().frame() as usize;
        let placement = animator.placement();
        let own = at(&clip, "left-foot", animator.pose().values)[2] + placement.place[0] as f64 / scale;
        let down = heights[frame] < lowest + 1.0 && heights[(frame + heights.len() - 1) % heights.len()] >= lowest + 1.0;
        let near = foot.update(animator.pose_mut(), placement, down, clip.frame_time_ns() / 1000);
        // This leg bends forwards and back alone: it cannot follow the hips' turn sideways.
        assert!(f64::from(near.error) / scale < 3.0 || !near.within, "{step}: {near:?}");
        let ankle = at(&clip, "left-foot", animator.pose().values)[2] + placement.place[0] as f64 / scale;
        if foot.is_locked() {
            locked_frames += 1;
            let (at, own_at) = *anchor.get_or_insert((ankle, own));
            if near.within {
                slide = slide.max((ankle - at).abs());
            }
            own_slide = own_slide.max((own - own_at).abs());
        } else {
            anchor = None;
        }
        if let (Some(before), Some(own_before)) = (before, own_before) {
            let (before, own_before): (f64, f64) = (before, own_before);
            fastest = fastest.max((ankle - before).abs());
            own_fastest = own_fastest.max((own - own_before).abs());
        }
        (before, own_before) = (Some(ankle), Some(own));
    }
    println!("{locked_frames} frames locked, {slide} cm of {own_slide}; fastest {fastest} of {own_fastest} cm a frame");
    assert!(locked_frames > 30);
    assert!(slide <= 1.0, "{slide}");
    assert!(fastest <= 2.0 * own_fastest, "{fastest} of {own_fastest}");
}

/// A foot that is let go in the middle of its step starts at rest, as it was held, and is back in the clip's motion after the same time at any rate.
#[test]
fn a_released_foot_goes_back_by_time_from_its_own_velocity() {
    let clip = walk();
    let scale = per_cm(&clip);
    for rate in [24u32, 60, 240] {
        let mut room = Room::new();
        let mut animator = Animator::new(clip, room.lend()).unwrap();
        let mut foot = FootLock::new(&clip, animator.groups(), "left-foot", Limits::default(), 300_000).unwrap();
        let picture_us = 1_000_000 / rate;
        // Where the foot is in the world, and where the clip has it.
        let play = |animator: &mut Animator, foot: &mut FootLock, down: bool| {
            animator.update(picture_us).unwrap();
            let placement = animator.placement();
            let at = |pose: &[i32]| at(&clip, "left-foot", pose)[2] + placement.place[0] as f64 / scale;
            let own = at(animator.pose().values);
            foot.update(animator.pose_mut(), placement, down, picture_us);
            (at(animator.pose().values), own)
        };
        for _ in 0..rate / 6 {
            play(&mut animator, &mut foot, false);
        }
        let mut held = play(&mut animator, &mut foot, true);
        while (held.0 - held.1).abs() < 1.5 {
            held = play(&mut animator, &mut foot, false);
            assert!(foot.is_locked(), "{rate}");
        }
        foot.release();
        let (mut ways, mut before) = (vec![], held);
        let pictures = 300_000 / picture_us + 2;
        for _ in 0..pictures {
            let now = play(&mut animator, &mut foot, false);
            ways.push((now.0 - before.0, now.1 - before.1, now.0 - now.1));
            before = now;
        }
        let distance = (held.0 - held.1).abs();
        // At rest before: it gains speed over the release and does not jump.
        let fastest_own = ways.iter().map(|(_, own, _)| own.abs()).fold(0.0, f64::max);
        let fastest = ways.iter().map(|(way, ..)| way.abs()).fold(0.0, f64::max);
        let even = distance * f64::from(picture_us) / 300_000.0;
        println!(
            "{rate}: {distance:.2} cm; first {:.3}, fastest {fastest:.3}, the clip's {fastest_own:.3} cm a picture",
            ways[0].0
        );
        assert!(ways[0].0.abs() < 0.5 * (even + fastest_own), "{rate}: it jumps by {} cm", ways[0].0);
        assert!(fastest < fastest_own + 3.0 * even, "{rate}: {fastest} of {fastest_own} cm");
        assert!(ways.last().unwrap().2.abs() < 0.1, "{rate}: {} cm are left", ways.last().unwrap().2);
        // In the middle of the release it is on the way, at every rate.
        let middle = ways[ways.len() / 2].2.abs() / distance;
        assert!((0.2..1.0).contains(&middle), "{rate}: {middle} of the distance in the middle");
    }
}

#[test]
fn an_error_names_the_joint() {
    let clip = walk();
    let mut room = Room::new();
    let animator = Animator::new(clip, room.lend()).unwrap();
    let refused = |name: &str| Limb::to(&clip, animator.groups(), name, Limits::default()).unwrap_err().to_string();
    assert_eq!(refused("left-hoof"), "the rig has no joint `left-hoof`");
    let root = clip.rig().joint(0).unwrap().name();
    assert_eq!(refused(root), format!("joint `{root}` has too few joints above it, or bones without length"));
    // 31 bytes, and no character in parts.
    assert_eq!(refused(&"é".repeat(40)), format!("the rig has no joint `{}`", "é".repeat(15)));
}
