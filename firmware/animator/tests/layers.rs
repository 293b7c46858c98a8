//! Laws of masks, layers, phases and state machines.

mod common;

use common::walk;
use fastrand::Rng;
use fixed::types::I16F16;
use pantin::{ChannelState, Pose};
use pantin_animator::layer::{Weight, add, blend};
use pantin_animator::machine::{Machine, Table, TableError};
use pantin_animator::procedural::{Blink, Breath, BreathChannel};
use pantin_animator::{Animator, Error, Group, Mask, Track, Workspace};

#[test]
fn a_mask_and_its_complement_are_the_whole() {
    let clip = walk();
    let mut random = Rng::with_seed(7);
    let mut groups = [Group::NONE; 64];
    let used = Group::of_clip(&clip, &mut groups).unwrap();
    let groups = &groups[..used];
    let (mut states, mut values) = ([ChannelState::NEW; 64], [0; 64]);
    let mut track = Track::new(clip, &mut states, &mut values).unwrap();
    let (mut words, mut other_words, mut all_words) = ([0; 4], [0; 4], [0; 4]);
    let mut all = Mask::new(&clip.rig(), &mut all_words).unwrap();
    all.invert();
    for _ in 0..500 {
        track.seek(random.u32(..clip.frames()));
        let mut base = vec![0; clip.rig().channels()];
        track.sample(&mut base);
        track.seek(random.u32(..clip.frames()));
        let layer = track.pose();
        let (mut mask, mut rest) =
            (Mask::new(&clip.rig(), &mut words).unwrap(), Mask::new(&clip.rig(), &mut other_words).unwrap());
        for joint in 0..clip.rig().joint_count() {
            let on = random.u32(..2) == 1;
            mask.put(joint, on);
            rest.put(joint, on);
        }
        rest.invert();
        let weight = Weight::from_bits([0, 1 << 15, random.u32(..1 << 15) as u16][random.u32(..3) as usize]);
        let (mut halves, mut whole) = (base.clone(), base.clone());
        blend(&mut halves, groups, clip.form_ref(), layer, &mask, weight).unwrap();
        blend(&mut halves, groups, clip.form_ref(), layer, &rest, weight).unwrap();
        blend(&mut whole, groups, clip.form_ref(), layer, &all, weight).unwrap();
        assert_eq!(halves, whole);
        // Runs of channels give what groups do.
        let mut room = [0; 4 + 64];
        let mut prepared = Mask::new(&clip.rig(), &mut room).unwrap();
        (0..clip.rig().joint_count()).for_each(|joint| prepared.put(joint, mask.contains(joint)));
        prepared.prepare(groups);
        let (mut by_groups, mut by_runs) = (base.clone(), base.clone());
        blend(&mut by_groups, groups, clip.form_ref(), layer, &mask, weight).unwrap();
        blend(&mut by_runs, groups, clip.form_ref(), layer, &prepared, weight).unwrap();
        assert_eq!(by_runs, by_groups);
        if weight == Weight::ONE {
            assert_eq!(whole, layer.values);
        }
        if weight == Weight::ZERO {
            assert_eq!(whole, base);
        }
        // Additive of zero is nothing, and a difference of weight 1 is exact.
        let mut sum = base.clone();
        add(&mut sum, groups, clip.form_ref(), layer, layer.values, &all, weight).unwrap();
        assert_eq!(sum, base);
        add(&mut sum, groups, clip.form_ref(), layer, &base, &all, Weight::ONE).unwrap();
        assert_eq!(sum, layer.values);
    }
}

#[test]
fn masks_take_patterns() {
    let rig = walk().rig();
    let mut words = [0; 4];
    let mut mask = Mask::new(&rig, &mut words).unwrap();
    let refused = mask.set(&rig, "tail* +", true).unwrap_err();
    assert!(matches!(refused, Error::NothingMatches(pattern) if pattern.as_str() == "tail* +"), "{refused}");
    mask.set(&rig, "chest +", true).unwrap();
    let has = |mask: &Mask<'_>, name: &str| mask.contains(rig.find(name).unwrap().index());
    assert!(
        has(&mask, "chest") && has(&mask, "head") && has(&mask, "left-hand") && !has(&mask, "hips") && !has(&mask, "left-foot")
    );
    mask.set(&rig, "*-hand", false).unwrap();
    assert!(!has(&mask, "left-hand") && !has(&mask, "right-hand") && has(&mask, "left-forearm"));
    assert!(matches!(Mask::new(&rig, &mut []), Err(Error::TooSmall { needed: 1, given: 0, .. })));
}

#[test]
fn a_layer_of_another_form_is_refused() {
    let clip = walk();
    let mut groups = [Group::NONE; 64];
    let used = Group::of_clip(&clip, &mut groups).unwrap();
    let mut words = [u32::MAX; 4];
    let mask = Mask::new(&clip.rig(), &mut words).unwrap();
    let form = clip.form();
    let other = pantin::Form::new(form.rig_id(), form.length_exponent() + 1, form.exponentials());
    let values = [0; 64];
    let layer = Pose { values: &values, form: (&other).into() };
    let mut pose = [0; 64];
    let error = blend(&mut pose, &groups[..used], clip.form_ref(), layer, &mask, Weight::ONE).unwrap_err();
    assert_eq!(error, pantin::WrongForm::LengthExponent);
}

#[test]
fn a_breath_comes_back_and_a_blink_opens() {
    let channels = [BreathChannel { channel: 1, amplitude: 1000 }];
    let mut breath = Breath::new(&channels, 4_000_000);
    let (mut least, mut most) = (0, 0);
    for _ in 0..400 {
        let mut pose = [0, 0];
        breath.apply(&mut pose, Weight::ONE);
        (least, most) = (least.min(pose[1]), most.max(pose[1]));
        breath.advance(10_000);
    }
    assert!((-1000..-990).contains(&least) && (990..=1000).contains(&most), "{least} {most}");
    let mut pose = [0, 0];
    breath.apply(&mut pose, Weight::ONE);
    assert_eq!(pose, [0, 0]);
    let mut blink = Blink::new([None, None], 3);
    let (mut open, mut closed) = (0, 0);
    for _ in 0..10_000 {
        blink.advance(10_000);
        let weight = blink.closed();
        open += u32::from(weight == Weight::ZERO);
        closed += u32::from(weight == Weight::ONE);
    }
    assert!(open > 9_000 && closed > 10 && closed < 60, "{open} {closed}");
}

/// A table: states, then transitions from any state and those of each state, parameters, names.
struct Made {
    states: Vec<[u8; 6]>,
    any: Vec<[u8; 8]>,
    own: Vec<Vec<[u8; 8]>>,
    parameters: Vec<[i16; 3]>,
    names: Vec<&'static str>,
    inputs: u8,
}

impl Made {
    fn bytes(&self) -> Vec<u8> {
        let transitions: Vec<_> = self.any.iter().chain(self.own.iter().flatten()).collect();
        let counts = [self.states.len(), transitions.len(), self.parameters.len()].map(|count| count as u8);
        let mut bytes = vec![1, counts[0], counts[1], counts[2], self.inputs, 0, self.any.len() as u8, 0];
        let mut first = self.any.len();
        for (state, own) in self.states.iter().zip(&self.own) {
            bytes.extend(state);
            bytes.extend([first as u8, own.len() as u8]);
            first += own.len();
        }
        bytes.extend(transitions.into_iter().flatten());
        bytes.extend(self.parameters.iter().flatten().flat_map(|value| value.to_le_bytes()));
        for name in &self.names {
            bytes.push(name.len() as u8);
            bytes.extend(name.as_bytes());
        }
        bytes.extend(pantin::codec::crc::of(&bytes).to_le_bytes());
        bytes
    }
}

const SPEED_1: [u8; 2] = 256i16.to_le_bytes();

/// Walk and run by the parameter `pace`; an input `go` starts the run, and without it the walk comes back.
fn walk_and_run() -> Made {
    let state = |clip: u8, other: u8| [clip, other, 0, 0, SPEED_1[0], SPEED_1[1]];
    Made {
        states: vec![state(0, 255), state(1, 255)],
        any: vec![],
        own: vec![vec![[1, 0, 0, 0, 1, 1, 12, 0]], vec![[2, 0, 0, 0, 0, 1, 20, 255], [4, 0, 50, 0, 0, 1, 8, 0]]],
        parameters: vec![[0, 100, 0]],
        names: vec!["walk", "run", "pace", "go"],
        inputs: 1,
    }
}

#[test]
fn a_machine_goes_from_state_to_state() {
    let bytes = common::bank(&[&walk_and_run().bytes()]);
    let bank = pantin::Bank::new_checked(&bytes).unwrap();
    let table = Table::of_bank(&bytes).unwrap();
    assert_eq!((table.states(), table.state_name(0), table.state_name(1)), (2, "walk", "run"));
    let (go, pace) = (table.input("go").unwrap(), table.parameter("pace").unwrap());
    assert_eq!((go, pace, table.input("stop"), table.parameter("go")), (0, 0, None, None));
    let mut machine = Machine::new(table);
    assert!(size_of::<Machine<'_>>() <= 112);
    let mut memory = Workspace::<64, 64>::new();
    let mut animator = Animator::new(machine.first_clip(&bank).unwrap(), memory.lend()).unwrap();
    fn update_with<'b>(bank: &pantin::Bank<'b>, machine: &mut Machine<'b>, animator: &mut Animator<'b, '_>) -> Option<u8> {
        animator.events().clear();
        machine.update(16_667, bank, animator, None).unwrap().entered
    }
    for _ in 0..10 {
        assert_eq!(update_with(&bank, &mut machine, &mut animator), None);
    }
    machine.fire(go);
    machine.hold(go, true);
    assert_eq!(update_with(&bank, &mut machine, &mut animator), Some(1));
    assert_eq!(animator.transition_left(), 12);
    for _ in 0..10 {
        assert_eq!(update_with(&bank, &mut machine, &mut animator), None);
    }
    machine.set(pace, 1000);
    assert_eq!(machine.get(pace), 100);
    assert_eq!(update_with(&bank, &mut machine, &mut animator), Some(0));
    machine.set(pace, 0);
    assert_eq!(update_with(&bank, &mut machine, &mut animator), Some(1));
    machine.hold(go, false);
    assert_eq!(update_with(&bank, &mut machine, &mut animator), Some(0));
}

#[test]
fn a_table_is_checked() {
    let error = |change: fn(&mut Made)| {
        let mut made = walk_and_run();
        change(&mut made);
        Table::new(&made.bytes(), 2).err()
    };
    assert_eq!(error(|_| {}), None);
    assert_eq!(error(|made| made.states[1][0] = 2), Some(TableError::NoSuchClip { state: 1 }));
    assert_eq!(error(|made| made.states[1][1] = 7), Some(TableError::NoSuchClip { state: 1 }));
    assert_eq!(error(|made| made.own[0][0][4] = 2), Some(TableError::NoSuchState(2)));
    assert_eq!(error(|made| made.own[0][0][1] = 1), Some(TableError::NoSuchInput(1)));
    assert_eq!(error(|made| made.own[1][1][1] = 3), Some(TableError::NoSuchInput(3)));
    assert_eq!(error(|made| made.own[0][0][0] = 9), Some(TableError::BadValue));
    assert_eq!(error(|made| made.own[0][0][5] = 9), Some(TableError::BadValue));
    assert_eq!(error(|made| made.states[0][5] = 9), Some(TableError::BadValue));
    assert_eq!(error(|made| made.parameters[0] = [5, 5, 5]), Some(TableError::BadValue));
    assert_eq!(error(|made| made.own[1][1] = made.own[1][0]), Some(TableError::Ambiguous { state: 1 }));
    assert_eq!(error(|made| made.own[0].clear()), Some(TableError::Unreachable(1)));
    assert_eq!(error(|made| made.names.truncate(3)), Some(TableError::Truncated));
    assert_eq!(error(|made| made.inputs = 33), Some(TableError::BadCount));
    let bytes = walk_and_run().bytes();
    assert_eq!(Table::new(&bytes[..bytes.len() - 1], 2).err(), Some(TableError::BadCrc));
    assert_eq!(Table::new(&[], 2).err(), Some(TableError::Truncated));
    // A bank without a table, one that is cut short, and one with two.
    assert_eq!(Table::of_bank(common::BANK).err(), Some(Error::Machine(TableError::Missing)));
    let whole = common::bank(&[&bytes]);
    assert!(Table::of_bank(&whole[..whole.len() - 1]).is_err());
    let twice = common::bank(&[&bytes, &bytes]);
    assert_eq!(Table::of_bank(&twice).err(), Some(Error::Machine(TableError::Several)));
}

#[test]
fn speed_is_cut_off_and_zero_holds_the_pose() {
    let clip = walk();
    let mut memory = Workspace::<64, 64>::new();
    let mut animator = Animator::new(clip, memory.lend()).unwrap();
    animator.set_speed(I16F16::from_num(100));
    assert_eq!(animator.track().speed(), 4);
    animator.set_speed(I16F16::ZERO);
    let before = animator.pose().values.to_vec();
    animator.update(1_000_000).unwrap();
    assert_eq!((animator.pose().values, animator.track().frame()), (&before[..], 0));
}
