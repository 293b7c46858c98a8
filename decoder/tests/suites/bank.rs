//! Banks: what is in one, and that each rule of FORMAT.md 16 is checked.

use super::common::varint;
use pantin::codec::{crc, layout::VERSION};
use pantin::{Bank, Clip, OpenError};
use std::path::Path;

/// Sections that a decoder knows.
const RIG: u8 = 1;
const CONTENTS: u8 = 2;
const CLIPS: u8 = 3;

/// A clip without its rig, the rig, and a clip that holds its rig; `None` where the package has no vectors.
fn vectors() -> Option<[Vec<u8>; 3]> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/vectors");
    let read = |name: &str| std::fs::read(folder.join(name)).ok();
    Some([read("rig-apart.ptn")?, read("rig-apart.rig")?, read("frames-1.ptn")?])
}

fn name(name: &[u8]) -> Vec<u8> {
    [&varint(name.len()), name].concat()
}

/// Names and lengths, with their CRC.
fn contents(clips: &[(&[u8], usize)]) -> Vec<u8> {
    let mut bytes: Vec<u8> = clips.iter().flat_map(|(own, len)| [name(own), varint(*len)].concat()).collect();
    bytes.extend(crc::update(crc::INITIAL, &bytes).to_le_bytes());
    bytes
}

fn bank(sections: &[(u8, &[u8])]) -> Vec<u8> {
    let mut bytes = vec![b'P', b'b', VERSION];
    sections.iter().for_each(|(kind, body)| bytes.extend([&[*kind][..], &name(body)].concat()));
    bytes
}

fn refused(bytes: &[u8]) -> OpenError {
    Bank::new_checked(bytes).expect_err("a rule is broken")
}

#[test]
fn clips_are_found_by_name_and_play_with_the_banks_rig() {
    let Some([clip, rig, _]) = vectors() else { return };
    let list = contents(&[(b"walk", clip.len()), (b"run", clip.len()), (b"walk", 1), (b"\xff", 2)]);
    let clips = [&clip[..], &clip, b"abc"].concat();
    // Other sections are skipped, and the order is free.
    let bytes = bank(&[(0, b"a"), (CLIPS, &clips), (200, b""), (RIG, &rig), (CONTENTS, &list)]);
    let bank = Bank::new_checked(&bytes).unwrap();
    let names: Vec<&str> = bank.entries().map(|entry| entry.name()).collect();
    assert_eq!((bank.len(), names), (4, vec!["walk", "run", "walk", ""]));
    let lengths: Vec<usize> = bank.entries().map(|entry| entry.bytes().len()).collect();
    assert_eq!(lengths, [clip.len(), clip.len(), 1, 2]);
    assert_eq!(bank.find("walk").unwrap().bytes().as_ptr(), bank.entries().next().unwrap().bytes().as_ptr());
    assert_eq!(bank.find("run").unwrap().bytes(), clip);
    assert!(bank.find("jump").is_none());
    let alone = Clip::with_rig(&clip, &rig).unwrap();
    assert_eq!(bank.clip("run").unwrap().frames(), alone.frames());
    assert_eq!(bank.rig().channels(), alone.rig().channels());
    assert_eq!(bank.clip("jump").err(), Some(OpenError::NoSuchClip));
    let damaged = bank.entries().nth(2).unwrap();
    assert!(bank.open(&damaged).is_err());
}

#[test]
fn a_section_of_an_application_is_found_and_a_second_one_of_its_type_is_refused() {
    let Some([clip, rig, _]) = vectors() else { return };
    let list = contents(&[(b"walk", clip.len())]);
    let bytes = bank(&[(4, b"one"), (RIG, &rig), (CONTENTS, &list), (CLIPS, &clip), (200, b""), (5, b"x"), (5, b"y")]);
    let bank = Bank::new_checked(&bytes).unwrap();
    assert_eq!(bank.section(4), Ok(Some(&b"one"[..])));
    assert_eq!(bank.section(200), Ok(Some(&b""[..])));
    assert_eq!(bank.section(6), Ok(None));
    assert_eq!(bank.section(5), Err(OpenError::Malformed));
    assert_eq!((bank.section(RIG), bank.rig_bytes()), (Ok(Some(&rig[..])), &rig[..]));
    assert!(bank.sections().map(|(kind, _)| kind).eq([4, RIG, CONTENTS, CLIPS, 200, 5, 5]));
}

#[test]
fn each_rule_of_a_bank_is_checked() {
    let Some([clip, rig, with_rig]) = vectors() else { return };
    let list = contents(&[(b"walk", clip.len())]);
    let good = bank(&[(RIG, &rig), (CONTENTS, &list), (CLIPS, &clip)]);
    assert!(Bank::new_checked(&good).is_ok_and(|bank| bank.clip("walk").is_ok()));
    assert_eq!(Clip::new_checked(&good).err(), Some(OpenError::IsBank));
    for (at, error) in [(0, OpenError::BadMagic), (1, OpenError::BadMagic), (2, OpenError::UnsupportedVersion(VERSION ^ 1))] {
        let mut bytes = good.clone();
        bytes[at] ^= 1;
        assert_eq!(refused(&bytes), error, "byte {at}");
    }
    (0..good.len()).for_each(|len| assert_eq!(refused(&good[..len]), OpenError::Truncated, "{len} bytes"));
    // Each section once.
    let sections = [(RIG, &rig[..]), (CONTENTS, &list), (CLIPS, &clip)];
    for index in 0..3 {
        let mut some = sections.to_vec();
        some.push(sections[index]);
        assert_eq!(refused(&bank(&some)), OpenError::Malformed, "section {index} twice");
        some.swap_remove(index);
        some.pop();
        assert_eq!(refused(&bank(&some)), OpenError::Truncated, "no section {index}");
    }
    let with = |list: &[u8], clips: &[u8]| bank(&[(RIG, &rig), (CONTENTS, list), (CLIPS, clips)]);
    let mut wrong = list.clone();
    wrong[1] ^= 1;
    assert_eq!(refused(&with(&wrong, &clip)), OpenError::BadCrc);
    assert_eq!(refused(&with(&[], &clip)), OpenError::BadCrc);
    // At least one clip, each with a name.
    assert_eq!(refused(&with(&contents(&[]), &[])), OpenError::Malformed);
    assert_eq!(refused(&with(&contents(&[(b"", clip.len())]), &clip)), OpenError::Malformed);
    let second = contents(&[(b"walk", clip.len()), (b"", 0)]);
    assert_eq!(refused(&with(&second, &clip)), OpenError::Malformed);
    let first = contents(&[(b"", 0), (b"walk", clip.len())]);
    assert_eq!(refused(&with(&first, &clip)), OpenError::Malformed);
    // The lengths of all clips are that of their section.
    for len in [clip.len() - 1, clip.len() + 1] {
        assert!(Bank::new_checked(&with(&contents(&[(b"walk", len)]), &clip)).is_err(), "{len}");
    }
    // Contents that end in a name, and in a length.
    for cut in [vec![5, b'w'], vec![1, b'w', 0x80]] {
        let cut = [&cut[..], &crc::update(crc::INITIAL, &cut).to_le_bytes()].concat();
        assert!(Bank::new_checked(&with(&cut, &clip)).is_err());
    }
    let mut bad_rig = rig.clone();
    bad_rig[0] ^= 1;
    assert!(Bank::new_checked(&bank(&[(RIG, &bad_rig), (CONTENTS, &list), (CLIPS, &clip)])).is_err());
    // A clip of a bank has no rig of its own.
    let bytes = with(&contents(&[(b"own", with_rig.len())]), &with_rig);
    assert_eq!(Bank::new_checked(&bytes).unwrap().clip("own").err(), Some(OpenError::Malformed));
}
