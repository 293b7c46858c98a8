//! The golden vectors: what stands in the repository is what the decoder makes of it, and leaves no part of the format out.

use std::collections::BTreeSet;
use std::fs;

use harness::vectors::{
    self, bank, c_face, c_figure, c_header, constants, coverage, faces, keyed, record, sums, synthetic, turns,
};
use pantin::Bank;

/// Bytes that the folder may have.
const MOST: u64 = 200_000;

#[test]
fn every_vector_decodes_to_its_record() {
    let vectors = vectors::load(&vectors::folder()).unwrap();
    for vector in &vectors {
        let clip = vector.open().unwrap();
        let recorded = fs::read_to_string(vectors::folder().join(&vector.name).with_extension("json")).unwrap();
        assert_eq!(record::of(&clip).unwrap(), recorded, "{}", vector.name);
    }
    let synthetic = synthetic::all();
    let named: BTreeSet<&str> = vectors.iter().map(|vector| vector.name.as_str()).collect();
    assert!(synthetic.iter().all(|made| named.contains(made.name)), "`cargo xtask vectors` makes what is missing");
}

#[test]
fn seeking_finds_the_poses_that_stepping_makes() {
    for vector in vectors::load(&vectors::folder()).unwrap() {
        let clip = vector.open().unwrap();
        let crcs = record::crcs(&clip).unwrap();
        assert_eq!(crcs.stepped.len(), clip.frames() as usize);
        for (frame, crc) in conformance::sought(clip.frames()).zip(&crcs.sought) {
            assert_eq!(crcs.stepped[frame as usize], *crc, "{}, frame {frame}", vector.name);
        }
    }
}

#[test]
fn the_tables_as_json_are_those_of_the_decoder() {
    let committed = fs::read_to_string(vectors::folder().join(constants::NAME)).unwrap();
    assert_eq!(committed, constants::text(), "`cargo xtask vectors` regenerates them");
}

#[test]
fn the_rotations_are_those_of_the_decoder() {
    let committed = fs::read_to_string(vectors::folder().join(turns::NAME)).unwrap();
    assert_eq!(committed, turns::text(&vectors::folder()).unwrap(), "`cargo xtask vectors` writes them");
    let committed = fs::read_to_string(vectors::folder().join(turns::SUMS)).unwrap();
    assert_eq!(committed, turns::sums_text(&vectors::folder()).unwrap(), "`cargo xtask vectors` writes them");
}

#[test]
fn the_pictures_of_faces_are_those_of_the_crate() {
    let committed = fs::read_to_string(vectors::folder().join(faces::NAME)).unwrap();
    assert_eq!(committed, faces::text().unwrap(), "`cargo xtask vectors` writes them");
}

#[test]
fn no_vector_has_changed() {
    let committed = fs::read_to_string(vectors::folder().join(sums::NAME)).unwrap();
    assert_eq!(committed, sums::text(&vectors::folder()).unwrap(), "a vector never changes; `cargo xtask vectors` adds new ones");
}

#[test]
fn the_tables_in_c_are_those_of_the_crates() {
    for (path, text) in [
        (c_header::path(), c_header::text()),
        (c_figure::path(), c_figure::text()),
        (c_face::path(), c_face::text()),
        (c_face::themes_path(), c_face::themes_text()),
    ] {
        if std::env::var_os("PANTIN_UPDATE").is_some() {
            fs::write(&path, &text).unwrap();
        }
        let committed = fs::read_to_string(&path).unwrap();
        assert_eq!(committed, text, "`cargo xtask vectors`, or this test with PANTIN_UPDATE=1, regenerates them");
    }
}

#[test]
fn no_part_of_the_format_is_left_out() {
    assert_eq!(coverage::left_out(&synthetic::all()).unwrap(), Vec::<String>::new());
}

#[test]
fn synthetic_vectors_come_out_byte_for_byte() {
    for made in synthetic::all() {
        let made = made.vector().unwrap();
        let committed = fs::read(vectors::folder().join(&made.name).with_extension("ptn")).unwrap();
        assert!(made.clip == committed, "{}: the encoder makes other bytes than those committed", made.name);
    }
}

#[test]
fn banks_are_what_the_encoder_makes_and_decode_to_their_records() {
    for (folder, made) in [(vectors::folder(), bank::bytes().unwrap()), (keyed::folder(), keyed::bank().unwrap())] {
        let file = |ending: &str| folder.join(bank::NAME).with_extension(ending);
        assert!(made == fs::read(file("ptb")).unwrap(), "the encoder makes other bytes than {}", file("ptb").display());
        assert_eq!(bank::record(&made).unwrap(), fs::read_to_string(file("json")).unwrap());
    }
}

#[test]
fn every_damage_to_a_bank_is_found() {
    let whole = bank::bytes().unwrap();
    let opens = |bytes: &[u8]| Bank::new_checked(bytes).is_ok_and(|bank| bank.entries().all(|entry| bank.open(&entry).is_ok()));
    assert!(opens(&whole));
    // The section of an unknown type at the end may be missing: its last two bytes.
    for len in 0..whole.len() - 2 {
        assert!(!opens(&whole[..len]), "cut to {len}");
    }
    // What stands in sections of an unknown type may be anything; their heads may not.
    for bit in (3 * 8..(whole.len() - 2) * 8).filter(|bit| !(3..7).contains(&(bit / 8))) {
        let mut damaged = whole.clone();
        damaged[bit / 8] ^= 1 << (bit % 8);
        assert!(!opens(&damaged), "bit {bit} flipped");
    }
}

#[test]
fn the_files_are_few_and_small() {
    let entries = fs::read_dir(vectors::folder()).unwrap();
    let total: u64 = entries.map(|entry| entry.unwrap().metadata().unwrap().len()).sum();
    assert!(total < MOST, "{total} bytes");
}

#[test]
fn key_clips_come_out_byte_for_byte_and_decode_to_their_records() {
    let folder = keyed::folder();
    let mut committed: Vec<_> = keyed::load().unwrap().into_iter().map(|vector| (vector.name.clone(), vector)).collect();
    let mut made = keyed::all().unwrap();
    committed.sort_by(|(a, _), (b, _)| a.cmp(b));
    made.sort_by(|a, b| a.name.cmp(&b.name));
    assert!(
        made.iter().map(|vector| &vector.name).eq(committed.iter().map(|(name, _)| name)),
        "`cargo xtask vectors` adds vectors"
    );
    for (made, (name, committed)) in made.iter().zip(&committed) {
        assert!(made.clip == committed.clip, "{name}: the encoder makes other bytes than those committed");
        let recorded = fs::read_to_string(folder.join(name).with_extension("json")).unwrap();
        assert_eq!(record::of(&committed.open().unwrap()).unwrap(), recorded, "{name}");
    }
    assert_eq!(fs::read_to_string(keyed::tables_path(&folder)).unwrap(), keyed::tables(), "`cargo xtask vectors` writes them");
    let sums = fs::read_to_string(folder.join(sums::NAME)).unwrap();
    assert_eq!(sums, sums::text(&folder).unwrap(), "a vector never changes; `cargo xtask vectors` adds new ones");
}
