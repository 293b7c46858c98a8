//! Joints of any channels: how their rotation is represented, what it is by FORMAT.md 11 in double precision, and how a clip codes them.

use pantin::codec::crc;
use pantin::codec::layout::*;
use pantin::{Angle, Axis, Clip, Component, EulerOrder, Form, Kind, Pose, Rig, Turn};

use super::common::varint;
use super::poses::{Noise, difference, expected, of_quaternion, of_turn};
use Kind::*;

/// Largest difference of an element of a matrix: a product of up to six rotations, each within 4e-7.
const TOLERANCE: f64 = 2.5e-6;
/// Poses of each form.
const POSES: usize = if cfg!(miri) { 1 } else { 20 };

/// A rig of joints with these channels; all hang on the first one.
fn rig(joints: &[&[Kind]]) -> Vec<u8> {
    // A unit of 1 cm, offsets in whole units, y up, no scalars.
    let mut bytes = [&varint(1_000_000), &[0, 1][..], &varint(joints.len()), &[0]].concat();
    for (index, kinds) in joints.iter().enumerate() {
        let code = |kind: &Kind| Kind::ALL.iter().position(|known| known == kind).unwrap() as u8;
        let halves = kinds.chunks(2).map(|pair| code(&pair[0]) | pair.get(1).map_or(0, |kind| code(kind) << 4));
        let name = format!("j{index}");
        bytes.extend([kinds.len() as u8, u8::from(index > 0)]);
        bytes.extend(halves);
        bytes.extend([0, 0, 0]);
        bytes.extend(varint(name.len()));
        bytes.extend(name.bytes());
    }
    let crc = crc::update(crc::INITIAL, &bytes);
    bytes.extend(crc.to_le_bytes());
    bytes
}

/// Rotations about one to four axes in any order, alone and with a quaternion, a map and positions.
fn joints() -> Vec<Vec<Kind>> {
    let rotations = [Xrotation, Yrotation, Zrotation];
    let mut chains = vec![vec![]];
    for len in 0..4 {
        let longer = |chain: &Vec<Kind>| rotations.map(|kind| [&chain[..], &[kind]].concat());
        let next: Vec<Vec<Kind>> = chains.iter().filter(|chain| chain.len() == len).flat_map(longer).collect();
        // Of the chains of four axes a few.
        chains.extend(next.into_iter().step_by(if len == 3 { 7 } else { 1 }));
    }
    let (quaternion, map) =
        (vec![Wquaternion, Xquaternion, Yquaternion, Zquaternion], vec![Xexponential, Yexponential, Zexponential]);
    let more = [
        vec![],
        quaternion.clone(),
        map.clone(),
        [&map[..], &quaternion].concat(),
        // Components may come in any order, and some may be missing.
        vec![Zexponential, Zposition, Xexponential],
        vec![Zquaternion, Wquaternion, Xposition],
        vec![Yquaternion, Yexponential],
    ];
    chains.iter().flat_map(|chain| more.iter().map(move |more| [&chain[..], more].concat())).collect()
}

fn axes(kinds: &[Kind]) -> Vec<usize> {
    kinds.iter().filter(|kind| kind.is_rotation()).filter_map(|kind| kind.axis()).collect()
}

/// The order that begins with these axes: after one axis the next in the cycle x, y, z.
fn order(axes: &[usize]) -> Option<EulerOrder> {
    let [x, y, z] = [Axis::X, Axis::Y, Axis::Z];
    Some(match axes {
        [] | [0] | [0, 1] | [0, 1, 2] => EulerOrder::of(x, y)?,
        [1] | [1, 2] | [1, 2, 0] => EulerOrder::of(y, z)?,
        [2] | [2, 0] | [2, 0, 1] => EulerOrder::of(z, x)?,
        [0, 2] | [0, 2, 1] => EulerOrder::of(x, z)?,
        [1, 0] | [1, 0, 2] => EulerOrder::of(y, x)?,
        [2, 1] | [2, 1, 0] => EulerOrder::of(z, y)?,
        _ => return None,
    })
}

/// The rotation in the form that holds the values as they are; `None` where only their product is one.
fn as_it_is(kinds: &[Kind], values: &[i32], exponential: bool) -> Option<Turn> {
    let of = |is: fn(&Kind) -> bool| kinds.iter().zip(values).filter(move |(kind, _)| is(kind));
    let rotations: Vec<i32> = of(|kind| kind.is_rotation()).map(|(_, &value)| value).collect();
    let (maps, quaternions) = (of(|kind| kind.is_exponential()).count(), of(|kind| kind.is_quaternion()).count());
    let three = |mut own: [i32; 3], values: &[i32]| {
        own[..values.len()].copy_from_slice(values);
        own.map(Angle::from_bits)
    };
    match (rotations.len(), maps, quaternions) {
        (3, 0, 0) if exponential => Some(Turn::Exponential(three([0; 3], &rotations))),
        (0, 1.., 0) => {
            let mut map = [0; 3];
            of(|kind| kind.is_exponential()).for_each(|(kind, &value)| map[kind.axis().unwrap()] = value);
            Some(Turn::Exponential(map.map(Angle::from_bits)))
        }
        (0, 0, 1..) => {
            let mut quaternion = [0; 4];
            of(|kind| kind.is_quaternion()).for_each(|(kind, &value)| quaternion[kind.axis().map_or(0, |axis| axis + 1)] = value);
            Some(Turn::Quaternion(quaternion.map(Component::from_bits)))
        }
        (0..=3, 0, 0) => Some(Turn::Euler { order: order(&axes(kinds))?, angles: three([0; 3], &rotations) }),
        _ => None,
    }
}

#[test]
fn joints_of_any_channels_turn_as_the_format_says() {
    let joints = joints();
    let mut seen = [0; 2];
    // A rig holds at most 1023 channels.
    for joints in joints.chunks(MAX_CHANNELS / 12) {
        let bytes = rig(&joints.iter().map(Vec::as_slice).collect::<Vec<_>>());
        let rig = Rig::new_checked(&bytes).unwrap();
        let mut noise = Noise(joints.len() as u64);
        for form in [Form::new(rig.id(), 0, []), Form::new(rig.id(), 0, [255; Form::EXPONENTIAL_BYTES])] {
            for _ in 0..POSES {
                let values: Vec<i32> = (0..rig.channels()).map(|_| noise.next()).collect();
                let pose = Pose { values: &values, form: (&form).into() };
                for (index, kinds) in joints.iter().enumerate() {
                    let found = rig.joint_ref(index).unwrap();
                    let own = &values[found.first_channel()..][..kinds.len()];
                    let choice = axes(kinds).len() == 3;
                    let exponential = choice && form.exponentials().next() == Some(255);
                    assert_eq!(form.is_exponential(&rig, index), exponential, "{kinds:?}");
                    let turn = pose.turn(&found).unwrap();
                    match as_it_is(kinds, own, exponential) {
                        Some(wanted) => assert_eq!(turn, wanted, "{kinds:?}"),
                        None => assert!(matches!(turn, Turn::Quaternion(_)), "{kinds:?}: {turn:?}"),
                    }
                    seen[usize::from(matches!(turn, Turn::Quaternion(_)))] += 1;
                    let wanted = expected(kinds, own, exponential);
                    let greatest = difference(&of_turn(turn), &wanted);
                    assert!(greatest < TOLERANCE, "{kinds:?}: {greatest}: {turn:?}");
                    let unit = turn.quaternion().map(|component| f64::from(component.to_bits()));
                    assert!(difference(&of_quaternion(unit), &wanted) < TOLERANCE, "{kinds:?}: {turn:?}");
                    let position = pose.position(&found).unwrap();
                    for (axis, kind) in [Xposition, Yposition, Zposition].into_iter().enumerate() {
                        assert_eq!(position[axis], kinds.iter().position(|own| *own == kind).map(|at| own[at]), "{kinds:?}");
                    }
                }
            }
        }
        for (index, kinds) in joints.iter().enumerate() {
            let alone = !kinds.iter().any(|kind| kind.is_quaternion() || kind.is_exponential());
            let wanted = order(&axes(kinds)).filter(|_| alone && !axes(kinds).is_empty());
            assert_eq!(rig.joint_ref(index).unwrap().euler_order(), wanted, "{kinds:?}");
        }
    }
    assert!(seen.iter().all(|&seen| seen > 10), "{seen:?}");
}

#[test]
fn any_joint_of_the_longest_rig_has_a_bit_of_its_own() {
    let most = MAX_CHANNELS / 3;
    // Whole words of 32 bits.
    assert_eq!((most, Form::EXPONENTIAL_BYTES), (341, 44));
    let bytes = rig(&vec![&[Zrotation, Xrotation, Yrotation][..]; most]);
    let rig = Rig::new_checked(&bytes).unwrap();
    let values = vec![1 << 28; rig.channels()];
    for chosen in [0, 1, 7, 8, 31, 32, 255, 256, most - 1].into_iter().step_by(if cfg!(miri) { 8 } else { 1 }) {
        let mut bits = [0; Form::EXPONENTIAL_BYTES];
        bits[chosen / 8] = 1 << (chosen % 8);
        let form = Form::new(rig.id(), 0, bits);
        assert!(form.exponentials().eq(bits));
        let pose = Pose { values: &values, form: (&form).into() };
        for joint in [0, 1, 2, 8, 16, 31, 32, 255, 256, most - 1].into_iter().chain([chosen]) {
            let turn = pose.turn(&rig.joint_ref(joint).unwrap()).unwrap();
            assert_eq!(matches!(turn, Turn::Exponential(_)), joint == chosen, "{joint} of {chosen}");
            assert_eq!(form.is_exponential(&rig, joint), joint == chosen, "{joint} of {chosen}");
        }
        assert!(!form.is_exponential(&rig, most), "no such joint");
    }
}

#[test]
fn a_clip_lists_the_kinds_that_it_codes() {
    let joints: Vec<Vec<Kind>> = joints().into_iter().step_by(5).collect();
    let rig = rig(&joints.iter().map(Vec::as_slice).collect::<Vec<_>>());
    let choices = joints.iter().filter(|kinds| axes(kinds).len() == 3).count();
    assert!(choices > 8, "{choices}");
    for coded in [0x00, 0x2d, 0xff] {
        // 120 frames a second, one frame, no exponent, a bit a choice; nothing moves.
        let payload = [&[1, 1, 0], &vec![coded; choices.div_ceil(8)][..]].concat();
        let flags = HAS_RIG | HAS_EXPONENTIALS;
        let crc = crc::update(crc::of_prefix(flags, payload.len() as u32 + 2), &payload);
        let front = [MAGIC[0], MAGIC[1], VERSION, flags];
        let file = [&front[..], &varint(rig.len()), &rig, &varint(payload.len() + 2), &payload, &crc.to_le_bytes()].concat();
        let clip = Clip::new_checked(&file).unwrap();
        let mut choice = 0;
        for (index, kinds) in joints.iter().enumerate() {
            let has_choice = axes(kinds).len() == 3;
            let exponential = has_choice && coded >> (choice % 8) & 1 != 0;
            choice += usize::from(has_choice);
            let mut components = [Xexponential, Yexponential, Zexponential].into_iter();
            let as_coded = |kind: &Kind| if exponential && kind.is_rotation() { components.next().unwrap() } else { *kind };
            let wanted: Vec<Kind> = kinds.iter().map(as_coded).collect();
            let mut found = clip.kinds(index);
            for (at, &kind) in wanted.iter().enumerate() {
                assert_eq!(found.size_hint(), (wanted.len() - at, Some(wanted.len() - at)));
                assert_eq!(found.next(), Some(kind), "{kinds:?}: {at}");
            }
            assert_eq!((found.len(), found.next()), (0, None));
            assert_eq!(clip.is_exponential(index), exponential);
        }
    }
}
