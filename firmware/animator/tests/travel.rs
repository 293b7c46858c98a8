//! The way of a character: increments add up to it, and it does not depend on the display rate.

mod common;

use common::CHARACTER;
use fastrand::Rng;
use fixed::types::I16F16;
use pantin::Angle;
use pantin_animator::session::{Replay, Session};
use pantin_animator::{Character, LayerWorkspace, Placement, Workspace};

const SESSION: &str = include_str!("../../../motions/steer.txt");

#[test]
fn increments_add_up_through_changes_of_state() {
    let mut memory = Workspace::<64, 64>::new();
    let mut character = Character::new(CHARACTER, memory.lend()).unwrap();
    let mut random = Rng::with_seed(11);
    let inputs = ["go", "fast", "jump", "bow", "sit", "stand", "left", "right", "trip", "dance", "wave"];
    let inputs: Vec<u8> = inputs.iter().filter_map(|name| character.table().input(name)).collect();
    let (mut sum, mut heading) = (character.pose().1.place, character.pose().1.heading);
    let (mut entered, mut states) = (0, std::collections::HashSet::new());
    for round in 0..1_000_000 {
        match random.u32(..24) {
            0 => character.machine().fire(inputs[random.usize(..inputs.len())]),
            1 => character.machine().hold(inputs[random.usize(..2)], random.bool()),
            2 => {
                let frames = character.animator().track().clip().frames();
                character.animator().seek(random.u32(..frames));
            }
            3 => character.animator().set_speed(I16F16::from_num(random.u32(1..5)) / 2),
            4 => {
                let to = Placement {
                    place: [0, 1].map(|_| random.i64(-1_000_000..1_000_000)),
                    heading: Angle::from_bits(random.i32(..)),
                };
                let before = character.pose().1;
                character.animator().set_placement(to);
                // Not a part of the way.
                let now = character.pose().1;
                sum = [0, 1].map(|axis| sum[axis] + now.place[axis] - before.place[axis]);
                heading = heading + (now.heading - before.heading);
            }
            _ => {
                // Up to 2 s: several changes of state.
                let most = if random.u32(..8) == 0 { 2_000_000 } else { 50_000 };
                entered += u32::from(character.update(random.u32(..most)).unwrap().entered.is_some());
                states.insert(character.state());
            }
        }
        if random.u32(..4) > 0 {
            let step = character.animator().take_increment();
            sum = [sum[0] + step.place[0], sum[1] + step.place[1]];
            heading = heading + step.heading;
            let now = character.pose().1;
            assert_eq!((sum, heading), (now.place, now.heading), "{round}");
        }
    }
    println!("{entered} changes of state, {} states", states.len());
    assert!(entered > 10_000 && states.len() > 10);
}

/// The length of the way in a session, in raw units, and where it ends.
fn way(session: &Session<'static>, rate: u16) -> (f64, [f64; 2]) {
    let (mut memory, mut layer) = (Workspace::<64, 64>::new(), LayerWorkspace::<64, 64>::new());
    let mut character = Character::new(CHARACTER, memory.lend()).unwrap();
    character.lend_layer(layer.lend()).unwrap();
    let mut replay = Replay::new(*session, rate);
    let (mut length, mut last) = (0.0, [0.0; 2]);
    let mut pictures = 0u32;
    while replay.next(&mut character).unwrap() {
        let place = character.pose().1.place.map(|raw| raw as f64);
        // At the instants that all rates share.
        if pictures.is_multiple_of(u32::from(rate) / 2) {
            length += (place[0] - last[0]).hypot(place[1] - last[1]);
            last = place;
        }
        pictures += 1;
    }
    (length, last)
}

#[test]
fn the_way_is_the_same_at_any_display_rate() {
    let mut memory = Workspace::<64, 64>::new();
    let table = *Character::new(CHARACTER, memory.lend()).unwrap().table();
    // The recorded session, and one whose states end by themselves in turn.
    let inputs: String = (0..20).map(|round| format!("{}.5 press {}\n", 3 * round, ["bow", "jump", "left"][round % 3])).collect();
    let ends = format!("0.5 hold go\n{}\n61 end", inputs.split_once('\n').unwrap().1);
    for text in [SESSION.to_string(), ends] {
        let session = Session::new_checked(text.leak(), &table).unwrap();
        let (most, most_end) = way(&session, 240);
        for rate in [24, 30, 50, 60, 120, 144] {
            let (length, end) = way(&session, rate);
            let apart = (end[0] - most_end[0]).hypot(end[1] - most_end[1]);
            println!("{rate}: {:.4} % of the way, {:.4} % apart", 100.0 * (length / most - 1.0), 100.0 * apart / most);
            assert!((length / most - 1.0).abs() < 0.001 && apart < 0.001 * most, "{rate}: {length} of {most}, {apart} apart");
        }
    }
}

#[test]
fn a_placement_is_stated_in_centimetres_and_seen_from_above() {
    let clip = common::walk();
    let cm_a_unit = f64::from(clip.rig().unit_micro_cm()) / 1e6 * f64::from(clip.length_exponent()).exp2();
    for place in [[0, 0], [1 << 40, -(1 << 40)], [123_456_789, -1], [1 << 50, 7]] {
        let placement = Placement { place, heading: Angle::from_bits(1 << 28) };
        let ground = placement.on_ground(&clip);
        assert_eq!((ground.place_cm, ground.heading), (placement.place_cm(&clip), placement.heading));
        for (own, cm) in place.iter().zip(ground.place_cm) {
            let expected = *own as f64 * cm_a_unit;
            assert!(
                (cm.to_num::<f64>() - expected).abs() <= 2.0 / 65_536.0 + expected.abs() * 1e-12,
                "{own}: {cm} cm, not {expected}"
            );
        }
    }
}
