//! Rigs: what is in one, and that each rule of FORMAT.md 2 is checked.

use super::common::varint;
use pantin::codec::crc;
use pantin::codec::layout::{END_SITE, HELPER, MAX_CHANNELS, MAX_JOINTS};
use pantin::{Kind, OpenError, Rig, Up};

/// A unit of 1 cm, offsets in whole units, y up.
const FRONT: [u8; 5] = [0xc0, 0x84, 0x3d, 0, 1];
/// Kinds of a joint, by their codes.
const X_ROTATION: u8 = 3;
const SCALAR: u8 = 13;
const UNKNOWN: u8 = 14;

fn with_crc(body: &[u8]) -> Vec<u8> {
    [body, &crc::of(body).to_le_bytes()].concat()
}

/// A rig that states these numbers of joints and scalars, which follow.
fn stating(front: &[u8], joints: usize, scalars: usize, rest: &[u8]) -> Vec<u8> {
    with_crc(&[front, &varint(joints), &varint(scalars), rest].concat())
}

fn rig(joints: &[Vec<u8>], scalars: &[Vec<u8>]) -> Vec<u8> {
    stating(&FRONT, joints.len(), scalars.len(), &[joints.concat(), scalars.concat()].concat())
}

/// A joint without an offset, named "a"; `parent` counts from 1, 0 is none.
fn joint(head: u8, parent: usize, kinds: &[u8]) -> Vec<u8> {
    named(head, parent, kinds, "a")
}

fn named(head: u8, parent: usize, kinds: &[u8], name: &str) -> Vec<u8> {
    [&[head][..], &varint(parent), kinds, &[0, 0, 0], &varint(name.len()), name.as_bytes()].concat()
}

fn root() -> Vec<u8> {
    joint(1, 0, &[X_ROTATION])
}

fn scalar(name: &str) -> Vec<u8> {
    [&[0][..], &varint(name.len()), name.as_bytes()].concat()
}

fn opens(bytes: &[u8]) -> Result<(), OpenError> {
    Rig::new_checked(bytes).map(drop)
}

#[test]
fn a_rig_states_its_unit_exponent_and_up() {
    for (exponent, up) in [(-31, Up::Y), (31, Up::new(2, true).unwrap())] {
        let front = [&varint(2_540_000)[..], &[exponent as u8, up.byte()]].concat();
        let bytes = stating(&front, 1, 0, &root());
        let rig = Rig::new_checked(&bytes).unwrap();
        assert_eq!((rig.unit_micro_cm(), rig.length_exponent(), rig.up()), (2_540_000, exponent, up));
    }
    for bad in [&[0, 0, 1][..], &[1, 32, 1], &[1, -32_i8 as u8, 1], &[1, 0, 3], &[1, 0, 7], &[1, 0, 0x81]] {
        assert_eq!(opens(&stating(bad, 1, 0, &root())), Err(OpenError::Malformed), "{bad:?}");
    }
}

#[test]
fn the_head_of_a_joint_states_its_channels_an_end_site_and_a_helper() {
    let end_site = |head: u8| vec![head, 1, 0, 0, 0];
    let bytes = rig(
        &[root(), joint(HELPER | 1, 1, &[X_ROTATION]), joint(0, 2, &[]), end_site(END_SITE), end_site(END_SITE | HELPER)],
        &[],
    );
    let rig = Rig::new_checked(&bytes).unwrap();
    let read: Vec<_> = rig.joints().map(|joint| (joint.kinds.count(), joint.end_site, joint.helper)).collect();
    assert_eq!(read, [(1, false, false), (1, false, true), (0, false, false), (0, true, false), (0, true, true)]);
    assert_eq!(rig.joints().next().and_then(|mut joint| joint.kinds.next()), Some(Kind::Xrotation));
}

#[test]
fn each_rule_of_a_joint_is_checked() {
    let second = |bytes: Vec<u8>| opens(&rig(&[root(), bytes], &[]));
    assert_eq!(second(joint(1, 1, &[X_ROTATION])), Ok(()));
    for (bad, why) in [
        (joint(0x41, 1, &[X_ROTATION]), "an unknown bit"),
        (joint(0x81, 1, &[X_ROTATION]), "an unknown bit"),
        (vec![END_SITE | 1, 1, X_ROTATION, 0, 0, 0], "an End Site with a channel"),
        (joint(1, 0, &[X_ROTATION]), "no parent"),
        (joint(1, 2, &[X_ROTATION]), "its own parent"),
        (joint(1, 3, &[X_ROTATION]), "a parent that is not there"),
        (joint(1, (1 << 16) + 1, &[X_ROTATION]), "a parent past 16 bits"),
        (joint(1, 1, &[SCALAR]), "a scalar"),
        (joint(1, 1, &[UNKNOWN]), "an unknown kind"),
        (joint(2, 1, &[X_ROTATION | UNKNOWN << 4]), "an unknown kind at the end"),
    ] {
        assert_eq!(second(bad), Err(OpenError::Malformed), "{why}");
    }
    assert_eq!(opens(&rig(&[joint(1, 1, &[X_ROTATION])], &[])), Err(OpenError::Malformed), "a root with a parent");
}

#[test]
fn the_numbers_of_joints_scalars_and_channels_are_limited() {
    let joints = |count: usize| -> Vec<u8> { (0..count).flat_map(|index| joint(0, index.min(1), &[])).collect() };
    let scalars = |count: usize| scalar("s").repeat(count);
    assert_eq!(opens(&stating(&FRONT, MAX_JOINTS, 0, &joints(MAX_JOINTS))), Ok(()));
    assert_eq!(opens(&stating(&FRONT, MAX_JOINTS + 1, 0, &joints(MAX_JOINTS + 1))), Err(OpenError::Malformed));
    assert_eq!(opens(&stating(&FRONT, 0, MAX_CHANNELS, &scalars(MAX_CHANNELS))), Ok(()));
    // Numbers past 16 bits are not cut off.
    assert_eq!(opens(&stating(&FRONT, (1 << 16) + 1, 0, &joints(1))), Err(OpenError::Malformed));
    assert_eq!(opens(&stating(&FRONT, 0, (1 << 16) + 1, &scalars(1))), Err(OpenError::Malformed));
    // 68 joints of 15 channels are 1020.
    let wide: Vec<Vec<u8>> = (0..68).map(|index| joint(15, usize::from(index > 0), &[X_ROTATION | X_ROTATION << 4; 8])).collect();
    let with = |count: usize| rig(&wide, &vec![scalar("s"); count]);
    assert_eq!((opens(&with(3)), opens(&with(4))), (Ok(()), Err(OpenError::Malformed)));
}

#[test]
fn a_rig_ends_with_its_last_scalar() {
    let body = [root(), scalar("s")].concat();
    assert_eq!(opens(&stating(&FRONT, 1, 1, &body)), Ok(()));
    assert_eq!(opens(&stating(&FRONT, 1, 1, &[&body[..], &[0]].concat())), Err(OpenError::Malformed));
    assert_eq!(opens(&stating(&FRONT, 1, 1, &body[..body.len() - 1])), Err(OpenError::Truncated));
}

#[test]
fn scalars_are_found_by_their_names_not_by_hashes() {
    // Both names have the same hash.
    let (name, other) = ("liquid", "costarring");
    assert_eq!(pantin::names::hash(name.as_bytes()), pantin::names::hash(other.as_bytes()));
    let small = [&[-7_i8 as u8][..], &scalar(name)[1..]].concat();
    let bytes = rig(&[root()], &[scalar("first"), small]);
    let rig = Rig::new_checked(&bytes).unwrap();
    let found = |name: &str| rig.find_scalar(name).map(|found| (found.channel(), found.exponent()));
    assert_eq!((found("first"), found(name)), (Some((1, 0)), Some((2, -7))));
    assert!(rig.find_scalar(other).is_none());
}

#[test]
fn a_joint_that_is_found_states_where_it_stands() {
    let joints = [
        named(1, 0, &[X_ROTATION], "hip"),
        named(0, 1, &[], "spine"),
        named(1, 2, &[X_ROTATION], "head"),
        named(1, 3, &[3], "hat"),
    ];
    let bytes = rig(&joints, &[]);
    let rig = Rig::new_checked(&bytes).unwrap();
    for (name, index, first_channel) in [("hip", 0, 0), ("spine", 1, 1), ("head", 2, 1), ("hat", 3, 2)] {
        let found = rig.find(name).unwrap();
        assert_eq!((found.index(), found.first_channel()), (index, first_channel), "{name}");
    }
}
