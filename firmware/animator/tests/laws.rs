//! Laws of transitions, root motion and events.

mod common;

use common::{events, run, walk};
use fastrand::Rng;
use fixed::types::I16F16;
use pantin::{ChannelState, Clip, Player};
use pantin_animator::{Animator, Placement, Transition, Workspace};

type Room = Workspace<96, 160>;

fn clips() -> [Clip<'static>; 2] {
    [walk(), run()]
}

fn speed(of: f64) -> I16F16 {
    I16F16::from_num(of)
}

/// A clip's own pose, the root's horizontal channels 0 as in the animator's.
fn own_pose(clip: Clip<'_>, frame: u32, like: &[i32]) -> Vec<i32> {
    let mut states = vec![ChannelState::NEW; clip.moving()];
    let mut pose = vec![0; clip.rig().channels()];
    let mut player = Player::new(clip, &mut states, &mut pose).unwrap();
    player.seek(frame);
    let mut pose = player.pose().values.to_vec();
    for axis in [pantin::Kind::Xposition, pantin::Kind::Zposition] {
        let root = clip.rig().joints().find(|joint| { joint.kinds }.any(|kind| kind.is_position())).unwrap();
        if let Some(at) = { root.kinds }.position(|kind| kind == axis) {
            pose[usize::from(root.first_channel) + at] = like[usize::from(root.first_channel) + at];
        }
    }
    pose
}

#[test]
fn a_transition_starts_on_the_old_pose_and_ends_exactly_on_the_clip() {
    let mut random = Rng::with_seed(1);
    let clips = clips();
    for round in 0..400u32 {
        let mut room = Room::new();
        let [from, to] = [random.u32(..2), random.u32(..2)].map(|at| clips[at as usize]);
        let mut animator = Animator::new(from, room.lend()).unwrap();
        animator.seek(random.u32(..from.frames()));
        let frames = random.u32(..60) as u8;
        let frame = random.u32(..to.frames());
        let before = animator.pose().values.to_vec();
        let placement = animator.placement();
        animator.switch(to, frame, speed(1.0), Transition::Inertialized(frames)).unwrap();
        assert_eq!(animator.placement().place, placement.place, "{round}");
        if frames > 0 && from.form_ref() == to.form_ref() {
            let same = animator.pose().values.iter().zip(&before).filter(|(a, b)| a == b).count();
            // The root's rotation is turned with its heading, and joints of three angles may be told in other angles.
            assert!(same + 3 * 8 >= before.len(), "{round}: {same} of {}", before.len());
        }
        let frame_us = to.frame_time_ns().div_ceil(1000);
        for _ in 0..frames {
            assert!(animator.transition_left() > 0);
            animator.update(frame_us).ok();
        }
        assert_eq!(animator.transition_left(), 0);
        animator.seek(frame);
        let pose = animator.pose().values.to_vec();
        assert_eq!(pose, own_pose(to, frame, &pose), "{round}");
    }
}

#[test]
fn switching_in_the_middle_of_a_transition_keeps_the_pose() {
    let mut random = Rng::with_seed(2);
    let mut room = Room::new();
    let mut animator = Animator::new(walk(), room.lend()).unwrap();
    for round in 0..500 {
        for _ in 0..random.u32(..9) {
            animator.update(random.u32(..40_000)).ok();
        }
        let clip = clips()[random.u32(..2) as usize];
        let (before, place) = (animator.pose().values.to_vec(), animator.placement());
        let form = animator.form();
        let rate = speed(f64::from(random.u32(..8)) - 4.0);
        animator.switch(clip, random.u32(..clip.frames()), rate, Transition::Inertialized(20)).unwrap();
        assert_eq!(animator.placement().place, place.place);
        let turned = animator.placement().heading - place.heading;
        if form == animator.form() && turned == pantin::Angle::ZERO {
            let worst = animator.pose().values.iter().zip(&before).map(|(a, b)| a.wrapping_sub(*b).unsigned_abs()).max().unwrap();
            // Half a turn: other angles of the same rotation.
            assert!(!(16..=1 << 29).contains(&worst), "{round}: {worst}");
        }
    }
}

#[test]
fn root_motion_over_any_path_is_the_direct_difference() {
    let mut random = Rng::with_seed(3);
    for clip in [walk(), run()] {
        assert!(clip.looped());
        let mut room = Room::new();
        let mut animator = Animator::new(clip, room.lend()).unwrap();
        let frame_us = clip.frame_time_ns().div_ceil(1000);
        let (mut sum, mut heading) = ([0i64; 2], pantin::Angle::ZERO);
        let mut add = |animator: &mut Animator| {
            let moved = animator.take_increment();
            sum = [sum[0] + moved.place[0], sum[1] + moved.place[1]];
            heading = heading + moved.heading;
            (sum, heading)
        };
        let mut laps = 0i64;
        let mut seen = std::collections::HashMap::new();
        for round in 0..1_000_000 {
            match random.u32(..16) {
                0 => animator.seek(random.u32(..clip.frames())),
                1 => {
                    animator.set_speed(speed(f64::from(random.u32(..9)) - 4.0));
                    continue;
                }
                _ => {
                    let before = animator.track().frame();
                    let rate = animator.track().speed();
                    animator.update(frame_us / 3 * random.u32(..12)).ok();
                    let after = animator.track().frame();
                    if rate > 0 && after < before {
                        laps += 1;
                    }
                    if rate < 0 && after > before {
                        laps -= 1;
                    }
                    let (sum, heading) = add(&mut animator);
                    let direct = animator.placement();
                    assert_eq!((direct.place, direct.heading), (sum, heading), "{round}");
                    if animator.track().part() == 0 && laps.abs() < 50 {
                        let known = *seen.entry((laps, after)).or_insert(direct);
                        assert_eq!(known, direct, "{round}: lap {laps}, frame {after}");
                    }
                    continue;
                }
            }
            add(&mut animator);
        }
        let direct: Placement = animator.placement();
        assert_eq!(direct.place, sum);
    }
}

#[test]
fn every_event_fires_once_a_pass_in_order() {
    let mut random = Rng::with_seed(4);
    let clip = events();
    let frames = i64::from(clip.frames());
    let markers: Vec<u32> = clip.events().map(|event| event.frame).collect();
    assert!(!markers.is_empty());
    let mut room = Room::new();
    let mut animator = Animator::new(clip, room.lend()).unwrap();
    animator.events().clear();
    // Instants in 2^-16 frames since the start.
    let mut last_time: i64 = 0;
    let mut lap = 0i64;
    for round in 0..20_000 {
        if random.u32(..12) == 0 {
            animator.set_speed(speed(f64::from(random.u32(..5)) - 2.0));
        }
        let before = animator.track().frame();
        let rate = animator.track().speed();
        animator.update(random.u32(..100_000)).unwrap();
        let after = animator.track().frame();
        let time = |frame: u32, part: fixed::types::U0F16, lap: i64| {
            ((lap * frames + i64::from(frame)) << 16) + i64::from(part.to_bits())
        };
        if rate > 0 && after < before {
            lap += 1;
        }
        if rate < 0 && after > before {
            lap -= 1;
        }
        let now = time(after, animator.track().part(), lap);
        let mut expected = vec![];
        for lap in lap - 2..=lap + 2 {
            for &marker in &markers {
                let at = time(marker, fixed::types::U0F16::ZERO, lap);
                if last_time < at && at <= now || now <= at && at < last_time {
                    expected.push((at, marker));
                }
            }
        }
        expected.sort();
        if now < last_time {
            expected.reverse();
        }
        let got: Vec<u32> = core::iter::from_fn(|| animator.events().take()).map(|fired| fired.frame).collect();
        assert_eq!(got, expected.iter().map(|&(_, frame)| frame).collect::<Vec<_>>(), "{round}: {last_time} to {now}");
        last_time = now;
    }
}

#[test]
fn events_that_find_the_queue_full_are_counted() {
    let clip = events();
    let mut room = Room::new();
    let mut animator = Animator::new(clip, room.lend()).unwrap();
    animator.events().clear();
    let passed = 20 * clip.events().count() as u32;
    let lost = animator.update((clip.duration_ns() * 20).div_ceil(1000) as u32).unwrap_err();
    assert_eq!((lost.0, animator.events().lost()), (passed - 16, passed - 16));
    assert_eq!(animator.events().iter().count(), 16);
}

#[test]
fn time_does_not_drift() {
    let clip = walk();
    let mut room = Room::new();
    let mut animator = Animator::new(clip, room.lend()).unwrap();
    animator.set_speed(speed(0.37));
    for _ in 0..100_000 {
        animator.update(6_944).ok();
    }
    let due = u128::from(6_944_u64 * 100_000) * 1000 * u128::from(speed(0.37).to_bits() as u32)
        / 65_536
        / u128::from(clip.frame_time_ns());
    assert_eq!(u128::from(animator.track().frame()), due % u128::from(clip.frames()));
}

#[test]
fn a_turned_figure_travels_without_end() {
    let clip = walk();
    let mut room = Room::new();
    let mut animator = Animator::new(clip, room.lend()).unwrap();
    let lap = |animator: &mut Animator<'_, '_>| {
        let before = animator.placement().place;
        (0..clip.frames()).for_each(|_| animator.step().unwrap_or_default());
        let [x, y] = animator.placement().place;
        [x - before[0], y - before[1]]
    };
    let degrees = |of: i64| pantin::Angle::from_bits((of * (1 << 32) / 360) as u32 as i32);
    animator.set_placement(Placement { place: [0; 2], heading: degrees(40) });
    // Far beyond the range of a channel.
    let [first_x, first_y] = lap(&mut animator);
    let way = first_x.abs().max(first_y.abs());
    let laps = (8i64 << 31) / way;
    for round in 0..laps {
        let [x, y] = lap(&mut animator);
        assert!((x - first_x).abs() <= 2 && (y - first_y).abs() <= 2, "lap {round}: {x} {y}, the first {first_x} {first_y}");
    }
    let [x, y] = animator.placement().place;
    assert!(x.abs().max(y.abs()) > 4i64 << 31);
    // And the same way back.
    animator.set_speed(speed(-1.0));
    let frame_us = clip.frame_time_ns().div_ceil(1000);
    for _ in 0..laps {
        (0..clip.frames()).for_each(|_| animator.update(frame_us).unwrap_or_default());
    }
    let back = animator.placement().place;
    assert!((back[0] - first_x).abs().max((back[1] - first_y).abs()) <= 2 * way, "{back:?}");
}
